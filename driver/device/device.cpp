#include "driver/device/device.h"

#include <algorithm>
#include <bit>

namespace xorvox::device {

using namespace wire;

namespace {

// So that poll() returns in bounded time, however fast the host sends.
constexpr int kPacketsPerPoll = 32;

}  // namespace

Status Device::init(const DeviceConfig& config, std::uint64_t now_ns) {
    if (config.display == nullptr || config.pages.data() == nullptr || config.packet.data() == nullptr) {
        return Status::InvalidArgument;
    }
    if (config.page_count < 2 || config.page_count > kMaxPages || config.packet.size() < kMinPacketBytes ||
        config.packet.size() > kMaxPacketBytes || config.display->panel_count < 1 ||
        config.display->panel_count > kMaxPanels) {
        return Status::InvalidArgument;
    }
    const std::size_t bytes = frame_bytes(*config.display);
    if (bytes == 0 || bytes > 0xffffffffu) return Status::InvalidArgument;
    if (config.pages.size() / config.page_count < bytes) return Status::OutOfMemory;
    *this = Device{};
    display_ = config.display;
    serial_ = config.serial;
    boot_nonce_ = config.boot_nonce;
    geometry_digest_ = geometry_digest(*config.display);
    link_ = config.link;
    packet_ = config.packet;
    heard_ns_ = now_ns;
    pages_.init(config.pages, bytes, config.page_count);
    return Status::Ok;
}

Status Device::poll(std::uint64_t now_ns) {
    Status result = link_ ? Status::WouldBlock : Status::Closed;
    for (int i = 0; link_ && i < kPacketsPerPoll; ++i) {
        if (waiting()) {
            if (!send_answers(now_ns)) break;
            result = Status::Ok;
        }
        std::size_t size = 0;
        const Status received = link_.receive(packet_, size);
        if (received == Status::Ok) {
            take(packet_.first(size), now_ns);
        } else if (received == Status::Corrupt) {
            ++packets_bad_;
        } else {
            if (received != Status::WouldBlock) result = Status::Closed;
            break;
        }
        result = Status::Ok;
    }
    watch(now_ns);
    if (link_ && waiting() && send_answers(now_ns) && result == Status::WouldBlock) result = Status::Ok;
    return result;
}

void Device::take(std::span<const std::byte> packet, std::uint64_t now_ns) {
    Header header;
    std::span<const std::byte> payload;
    const Status status = decode_packet(packet, header, payload);
    if (status == Status::Unsupported && header.type == PacketType::HelloRequest) {
        refuse(header.session, NackReason::BadVersion, 0, now_ns);
    }
    if (status != Status::Ok) {
        ++packets_bad_;
        return;
    }
    if (header.type == PacketType::HelloRequest) {
        HelloRequest request;
        if (decode(payload, request) == Status::Ok) on(header, request, now_ns);
        return;
    }
    if (session_ == 0 || header.session != session_ || !is_newer(header.sequence, received_sequence_)) return;
    received_sequence_ = header.sequence;
    heard_ns_ = now_ns;

    switch (header.type) {
        case PacketType::FrameBegin: {
            FrameBegin begin;
            if (decode(payload, begin) == Status::Ok) on(begin, now_ns);
            break;
        }
        case PacketType::Chunk: {
            Chunk chunk;
            if (decode(payload, chunk) == Status::Ok) {
                on(chunk, now_ns);
            } else if (receiver_.receiving()) {
                drop_frame(receiver_.frame(), NackReason::BadChunk, now_ns);
            }
            break;
        }
        case PacketType::FrameEnd: {
            FrameEnd end;
            if (decode(payload, end) == Status::Ok) on(end, now_ns);
            break;
        }
        case PacketType::Control: {
            Control control;
            if (decode(payload, control) == Status::Ok) on(control, now_ns);
            break;
        }
        case PacketType::Ping: {
            Ping ping;
            if (decode(payload, ping) != Status::Ok) break;
            answers_.pong = true;
            answers_.pong_host_time_ns = ping.host_time_ns;
            break;
        }
        default: break;  // A later minor version's.
    }
}

// A repeat of the request that began the session must not end it. A host that was started anew and chose the same
// session counts from 0 again, but its clock went on.
bool Device::begins_session(const Header& header, const HelloRequest& request) const {
    return header.session != session_ || is_newer(header.sequence, received_sequence_) ||
           request.host_time_ns > hello_host_time_ns_;
}

void Device::on(const Header& header, const HelloRequest& request, std::uint64_t now_ns) {
    if (header.session == 0) return;
    if (request.major != kMajor) {
        refuse(header.session, NackReason::BadVersion, 0, now_ns);
        return;
    }
    if (!begins_session(header, request)) return;
    // The host of a session that goes on takes what is not newer for a repeat.
    if (header.session != session_) sent_sequence_ = 0;
    end_session();
    session_ = header.session;
    had_session_ = true;
    received_sequence_ = header.sequence;
    hello_host_time_ns_ = request.host_time_ns;
    heard_ns_ = now_ns;
    answers_.hello = true;
}

void Device::end_session() {
    session_ = 0;
    receiver_.reset();
    pages_.end_session();
    answers_ = Answers{};
}

void Device::set_link(Link link) {
    end_session();
    link_ = link;
}

void Device::on(const FrameBegin& begin, std::uint64_t now_ns) {
    interrupt_frame(begin.frame, now_ns);
    const NackReason refusal = receiver_.begin(begin, pages_);
    if (refusal != kNoRefusal) drop_frame(begin.frame, refusal, now_ns);
}

void Device::on(const Chunk& chunk, std::uint64_t now_ns) {
    interrupt_frame(chunk.frame, now_ns);
    if (receiver_.finished(chunk.frame)) return;
    const NackReason refusal = receiver_.chunk(chunk, pages_);
    if (refusal != kNoRefusal) drop_frame(chunk.frame, refusal, now_ns);
}

void Device::on(const FrameEnd& end, std::uint64_t now_ns) {
    interrupt_frame(end.frame, now_ns);
    if (receiver_.finished(end.frame)) return;
    const NackReason refusal = receiver_.end(end, pages_, now_ns);
    if (refusal != kNoRefusal) {
        drop_frame(end.frame, refusal, now_ns);
        return;
    }
    ++frames_accepted_;
    answers_.accepted = true;
    answers_.accepted_frame = {
        .stage = AckStage::Accepted, .frame = end.frame, .page_crc = end.page_crc, .device_time_ns = now_ns};
}

// The end of the frame before was lost.
void Device::interrupt_frame(std::uint32_t next, std::uint64_t now_ns) {
    if (receiver_.receiving() && receiver_.frame() != next) {
        drop_frame(receiver_.frame(), NackReason::Gap, now_ns);
    }
}

void Device::drop_frame(std::uint32_t frame, NackReason reason, std::uint64_t now_ns) {
    receiver_.drop(frame);
    ++frames_dropped_;
    refuse(session_, reason, frame, now_ns);
}

void Device::on(const Control& control, std::uint64_t now_ns) {
    if (apply(control)) {
        answers_.status = true;
    } else {
        refuse(session_, NackReason::BadControl, 0, now_ns);
    }
}

bool Device::apply(const Control& control) {
    const std::uint32_t value = control.value;
    switch (control.operation) {
        case ControlOperation::Brightness:
            if (value > 255) return false;
            brightness_ = static_cast<std::uint8_t>(value);
            return true;
        case ControlOperation::Blank:
            if (value > 1) return false;
            blank_ = value == 1;
            return true;
        case ControlOperation::SilencePolicy:
            if (value > 1) return false;
            silence_action_ = static_cast<SilenceAction>(value);
            return true;
        case ControlOperation::Watchdog: watchdog_ms_ = value; return true;
        case ControlOperation::ClearFault:
            if (value == 0 || value > kHighestFault) return false;
            faults_ &= ~fault_bit(static_cast<Fault>(value));
            return true;
        case ControlOperation::Status: return value == 0;
    }
    return false;
}

void Device::watch(std::uint64_t now_ns) {
    constexpr std::uint64_t kNsPerMs = 1'000'000;
    // Nobody is missed before somebody came.
    if (had_session_ && watchdog_ms_ != 0 && silence_action_ == SilenceAction::Blank &&
        now_ns - heard_ns_ >= watchdog_ms_ * kNsPerMs) {
        raise_fault(Fault::SilentHost);
    }
}

void Device::raise_fault(Fault fault) {
    if (fault == Fault::None || static_cast<std::uint8_t>(fault) > kHighestFault) return;
    if ((faults_ & fault_bit(fault)) != 0) return;
    faults_ |= fault_bit(fault);
    answers_.status = session_ != 0;
}

Fault Device::fault() const {
    return faults_ == 0 ? Fault::None : static_cast<Fault>(std::bit_width(faults_) - 1);
}

void Device::boundary(std::uint64_t now_ns) {
    if (!pages_.present(now_ns)) return;
    const Pages::Page& page = pages_.page(pages_.shown());
    if (!page.of_session) {
        // The host that is here does not know this frame, but needs the pages that became free.
        answers_.status = session_ != 0;
        return;
    }
    answers_.presented = true;
    answers_.presented_frame = {
        .stage = AckStage::Presented, .frame = page.frame, .page_crc = page.crc, .device_time_ns = now_ns};
}

Shown Device::shown() const {
    if (blank_ || faults_ != 0 || pages_.shown() == Pages::kNone) return {.brightness = brightness_};
    return {pages_.bytes(pages_.shown()), pages_.page(pages_.shown()).frame, brightness_};
}

}  // namespace xorvox::device
