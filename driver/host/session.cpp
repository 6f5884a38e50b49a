#include "driver/host/session.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/host/capabilities.h"
#include "driver/host/control_queue.h"
#include "driver/host/transfer.h"
#include "driver/wire/packet.h"

namespace xorvox::host {

using namespace wire;

namespace {

constexpr int kPacketsPerPoll = 256;                 ///< So that poll() returns, however fast the peer sends.
constexpr std::uint64_t kPingEveryNs = 500'000'000;  ///< A quarter of the device's watchdog.
constexpr std::uint64_t kSilences = 3;  ///< Answer timeouts without a word, while idle, until the device is asked anew.

bool newer(std::uint32_t number, std::uint32_t than) {
    return static_cast<std::int32_t>(number - than) > 0;
}

}  // namespace

struct Session::Impl {
    using Phase = Transfer::Phase;

    Impl(Link the_link, const DisplayDescription& the_display, const SessionOptions& the_options)
        : link(the_link), info(the_link.info()), display(the_display), options(the_options) {
        options.session = std::max<std::uint16_t>(options.session, 1);
        options.attempts = std::max(options.attempts, 1u);
        timeout_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(options.answer_timeout_ns, 1));
        in.resize(info.max_packet_bytes);
        out.resize(kMaxPacketBytes);
        if (info.max_packet_bytes < kMinPacketBytes) {
            fail_with(Status::Refused, fmt::format("the link {} takes packets of {} bytes at most, but {} are needed",
                                                   info.name, info.max_packet_bytes, kMinPacketBytes));
        } else if (!info.two_way) {
            adopt(assumed_capabilities(display, info));
        }
    }

    Status poll(std::uint64_t now) {
        now_ns = now;
        if (!started) {
            started = true;
            connecting_since_ns = moved_ns = now;
        }
        bool moved = false;
        if (info.two_way && state != SessionState::Failed) moved = receive_all();
        if (info.two_way && state != SessionState::Failed) watch_clock();
        if (state != SessionState::Failed) moved |= send_all();
        if (state == SessionState::Failed) return failure;
        return moved ? Status::Ok : Status::WouldBlock;
    }

    Status submit(std::span<const std::byte> frame, std::uint64_t present_at) {
        if (state == SessionState::Failed) return Status::Closed;
        if (frame.size() != frame_bytes(display)) return Status::InvalidArgument;
        if (transfer.phase() != Phase::None) return Status::WouldBlock;
        if (info.two_way && state == SessionState::Ready && free_pages == 0) return Status::WouldBlock;
        transfer.submit(frame, present_at);
        phase_since_ns = now_ns;
        return Status::Ok;
    }

    // Ends and beginnings ------------------------------------------------------------------------------------

    void fail_with(Status status, std::string message) {
        state = SessionState::Failed;
        failure = status;
        error.message = std::move(message);
    }

    void fail_closed() {
        if (info.two_way) {
            fail_with(Status::Closed,
                      fmt::format("the peer closed the connection on the link {}; start it again", info.name));
        } else {
            fail_with(Status::Closed, fmt::format("the link {} takes no more data; is the disk full?", info.name));
        }
    }

    void fail_no_answer() {
        std::string message = fmt::format("no answer from a display on the link {}", info.name);
        if (statistics.packets_ignored > 0) {
            message += fmt::format(" ({} packets came that are not of this session)", statistics.packets_ignored);
        }
        fail_with(Status::Closed, message + "; check that a display or xorvox sim is at the other end");
    }

    /// Begins with a device of these capabilities.
    void adopt(const Hello& hello) {
        device = hello;
        state = SessionState::Ready;
        set_free_pages(hello.free_pages);
        credits_ns = phase_since_ns = now_ns;
        const bool lz4 = options.compress && (hello.codecs & 1u << static_cast<unsigned>(Codec::Lz4)) != 0;
        transfer.begin_with({std::min(hello.max_packet_bytes, info.max_packet_bytes), lz4});
        ++statistics.hellos;
        silent_timeouts = 0;
        asked = false;
        controls.begin_again();
        if (hello.fault != Fault::None) controls.push_clear_fault();
    }

    /// The device fell silent: asks who is there.
    void connect_again() {
        state = SessionState::Connecting;
        connecting_since_ns = now_ns;
        hello_attempts = 0;
        out_bytes = 0;
        if (transfer.began()) send_again({});
        // A device that answers nothing but hellos is no display.
        if (++lonely_hellos > options.attempts) fail_no_answer();
    }

    // The frame ----------------------------------------------------------------------------------------------

    void send_again(NackReason reason) {
        transfer.again(reason);
        phase_since_ns = now_ns;
        out_bytes = 0;
        if (transfer.failed_attempts() < options.attempts) return;
        fail_with(Status::Closed, fmt::format("the display on the link {} did not accept a frame in {} attempts: {}",
                                              info.name, transfer.failed_attempts(), transfer.refusal_text()));
    }

    // Receiving ----------------------------------------------------------------------------------------------

    bool receive_all() {
        for (int i = 0; i < kPacketsPerPoll; ++i) {
            std::size_t size = 0;
            switch (link.receive(in, size)) {
                case Status::Ok: take(std::span(in).first(size)); break;
                case Status::Corrupt: ++statistics.packets_ignored; break;
                case Status::WouldBlock: return i > 0;
                default: fail_closed(); break;
            }
            if (state == SessionState::Failed) break;
        }
        return true;
    }

    void take(std::span<const std::byte> packet) {
        Header header;
        std::span<const std::byte> payload;
        const Status decoded = decode_packet(packet, header, payload);
        if (decoded == Status::Unsupported && state == SessionState::Connecting) {
            fail_version("speaks another major version of the protocol than");
        } else if (decoded != Status::Ok || header.session != options.session || !understood(header, payload)) {
            ++statistics.packets_ignored;
        }
    }

    void fail_version(const char* what) {
        fail_with(Status::Refused, fmt::format("the device on the link {} {} {}.{}; update the older one", info.name,
                                               what, kMajor, kMinor));
    }

    /// Acts on a packet of this session; false when it is damaged, late or repeated.
    bool understood(const Header& header, std::span<const std::byte> payload) {
        if (header.type == PacketType::Hello) {
            Hello hello;
            if (decode(payload, hello) != Status::Ok) return false;
            return on_hello(hello, header.sequence);
        }
        if (state == SessionState::Connecting) {
            return header.type == PacketType::Nack && act_on<Nack>(payload);
        }
        if (!newer(header.sequence, received_sequence)) return false;
        received_sequence = header.sequence;
        silent_timeouts = 0;
        lonely_hellos = 0;
        asked = false;
        switch (header.type) {
            case PacketType::Acknowledge: return act_on<Acknowledge>(payload);
            case PacketType::Nack: return act_on<Nack>(payload);
            case PacketType::DeviceStatus: return act_on<DeviceStatus>(payload);
            default: return true;  // A pong, or a later minor version's.
        }
    }

    template <class Message>
    bool act_on(std::span<const std::byte> payload) {
        Message message;
        if (decode(payload, message) != Status::Ok) return false;
        on(message);
        return true;
    }

    bool on_hello(const Hello& hello, std::uint32_t its_sequence) {
        // The answer to a request of before the last silence says nothing about now.
        if (hello.host_time_ns < connecting_since_ns) return false;
        if (state == SessionState::Ready && hello.boot_nonce == device.boot_nonce) return false;
        if (const auto checked = check_capabilities(hello, display); !checked) {
            fail_with(Status::Refused, checked.error().message);
            return true;
        }
        received_sequence = its_sequence;
        adopt(hello);
        if (transfer.began()) send_again({});
        return true;
    }

    void on(const Acknowledge& message) {
        set_free_pages(message.free_pages);
        if (message.stage != AckStage::Accepted && message.stage != AckStage::Presented) return;
        // A Presented whose Accepted was lost says both. A later attempt of the same frame is not needed any more.
        if (transfer.accept(message)) out_bytes = 0;
        if (message.stage == AckStage::Presented) transfer.presented(message.frame);
    }

    void on(const Nack& message) {
        if (state == SessionState::Connecting) {
            if (message.reason == NackReason::BadVersion) fail_version("refuses version");
            return;
        }
        set_free_pages(message.free_pages);
        if (message.reason == NackReason::BadControl) {
            if (controls.refused()) ++statistics.controls_lost;
        } else if (transfer.is_refused_by(message)) {
            send_again(message.reason);
        }
    }

    void on(const DeviceStatus& message) {
        set_free_pages(message.free_pages);
        device_status = message;
        if (message.has_frame != 0) transfer.presented(message.shown_frame);
        controls.confirmed_by(message);
        // The host is not silent any more. Other faults are for a person to clear, or for the next hello.
        if (message.fault == Fault::SilentHost) controls.push_clear_fault();
    }

    void set_free_pages(std::uint8_t count) {
        if (count == 0 && free_pages > 0) credits_ns = now_ns;
        free_pages = std::min(count, device.pages);
    }

    // The clock ----------------------------------------------------------------------------------------------

    bool passed(std::uint64_t since_ns, std::uint64_t timeouts) const {
        return now_ns - since_ns >= timeouts * timeout_ns;
    }

    void watch_clock() {
        if (state == SessionState::Connecting) {
            if (passed(connecting_since_ns, options.attempts)) fail_no_answer();
            return;
        }
        if (controls.watch(now_ns, timeout_ns, options.attempts)) ++statistics.controls_lost;
        switch (transfer.phase()) {
            case Phase::None: break;
            case Phase::Queued:
                if (free_pages == 0 && passed(phase_since_ns, options.attempts)) {
                    fail_with(Status::Closed,
                              fmt::format("the display on the link {} has no free page for a frame; does it "
                                          "turn or refresh?",
                                          info.name));
                }
                break;
            case Phase::Sending:
                if (passed(moved_ns, options.attempts)) {
                    fail_with(
                        Status::Closed,
                        fmt::format("the peer on the link {} takes no more data; is it still running?", info.name));
                }
                return;
            case Phase::Waiting:
                // Longer every time: a slow link may still be busy with the attempt before.
                if (!passed(phase_since_ns, 1 + transfer.failed_attempts())) return;
                // Twice without a word: the device may have been reset, and know of no session.
                if (++silent_timeouts >= 2) {
                    connect_again();
                } else {
                    send_again({});
                }
                return;
        }
        if (asked && passed(asked_ns, kSilences)) connect_again();
    }

    // Sending ------------------------------------------------------------------------------------------------

    bool send_all() {
        bool moved = false;
        while (out_bytes > 0 || compose()) {
            const Status status = link.send(std::span(out).first(out_bytes));
            if (status == Status::WouldBlock) return moved;
            if (status != Status::Ok) {
                fail_closed();
                return true;
            }
            statistics.bytes_sent += out_bytes;
            out_bytes = 0;
            moved = true;
            moved_ns = now_ns;
            if (!asked) {
                asked = true;
                asked_ns = now_ns;
            }
            if (transfer.all_given()) {
                transfer.sent(info.two_way);
                phase_since_ns = now_ns;
            }
        }
        return moved;
    }

    /// Puts the next packet into `out`. False when there is nothing to say.
    bool compose() {
        // Without a way back it is said once, for the device that will play the recording.
        const bool greets = info.two_way ? state == SessionState::Connecting : hello_attempts == 0;
        if (greets) return compose_hello();
        if (controls.has_next()) return compose_message(info.two_way ? controls.send(now_ns) : controls.take());
        if (transfer.phase() == Phase::Queued && (free_pages > 0 || !info.two_way)) {
            transfer.encode(info.two_way && options.deltas && (device.features & kFeatureDelta) != 0);
        }
        if (transfer.phase() == Phase::Sending) {
            const Payload payload = transfer.next_payload();
            const Header header{.type = payload.type, .session = options.session, .sequence = sequence++};
            return encode_packet(header, payload.bytes, out, out_bytes) == Status::Ok;
        }
        if (!info.two_way) return false;
        if (free_pages == 0 && transfer.phase() != Phase::Waiting && passed(credits_ns, 1)) {
            credits_ns = now_ns;
            return compose_message(Control{.operation = ControlOperation::Status});
        }
        if (now_ns - moved_ns < kPingEveryNs) return false;
        // Its answer names the frame being shown: a lost Presented is made up for.
        if (transfer.awaits_presentation()) return compose_message(Control{.operation = ControlOperation::Status});
        return compose_message(Ping{.host_time_ns = now_ns});
    }

    bool compose_hello() {
        if (hello_attempts > 0 && !passed(hello_ns, 1)) return false;
        ++hello_attempts;
        hello_ns = now_ns;
        return compose_message(HelloRequest{.major = kMajor, .minor = kMinor, .host_time_ns = now_ns});
    }

    template <class Message>
    bool compose_message(const Message& message) {
        return encode_packet(options.session, sequence++, message, out, out_bytes) == Status::Ok;
    }

    Link link;
    LinkInfo info;
    DisplayDescription display;
    SessionOptions options;
    std::uint64_t timeout_ns = 0;

    SessionState state = SessionState::Connecting;
    Status failure = Status::Ok;
    Error error;
    SessionStatistics statistics;

    std::uint64_t now_ns = 0;
    bool started = false;
    std::uint64_t connecting_since_ns = 0;
    std::uint64_t hello_ns = 0;  ///< Of the last request.
    std::uint32_t hello_attempts = 0;
    std::uint32_t lonely_hellos = 0;    ///< Times connected since anything else was heard.
    std::uint32_t silent_timeouts = 0;  ///< Of frames, since anything was heard.
    bool asked = false;                 ///< Something was sent since the device was heard, first at asked_ns.
    std::uint64_t asked_ns = 0;
    std::uint64_t moved_ns = 0;  ///< When the link last took a packet.

    std::vector<std::byte> in;
    std::uint32_t received_sequence = 0;
    std::vector<std::byte> out;  ///< One packet that the link has not taken yet.
    std::size_t out_bytes = 0;
    std::uint32_t sequence = 0;

    Hello device;
    DeviceStatus device_status;
    std::uint8_t free_pages = 0;
    std::uint64_t credits_ns = 0;  ///< When free_pages became 0, or was asked for.

    Transfer transfer{statistics};
    std::uint64_t phase_since_ns = 0;  ///< When the frame was queued or sent.

    ControlQueue controls;
};

Session::Session(Link link, const DisplayDescription& display, const SessionOptions& options)
    : impl_(std::make_unique<Impl>(link, display, options)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

Status Session::poll(std::uint64_t now_ns) {
    return impl_->poll(now_ns);
}

Status Session::submit(std::span<const std::byte> frame, std::uint64_t present_at_ns) {
    return impl_->submit(frame, present_at_ns);
}

Status Session::control(ControlOperation operation, std::uint32_t value) {
    if (impl_->state == SessionState::Failed) return Status::Closed;
    if (impl_->controls.full()) return Status::WouldBlock;
    impl_->controls.push({.operation = operation, .value = value});
    return Status::Ok;
}

SessionState Session::state() const {
    return impl_->state;
}
bool Session::idle() const {
    return impl_->transfer.phase() == Impl::Phase::None && impl_->controls.empty() && impl_->out_bytes == 0;
}
std::uint32_t Session::events() const {
    return (impl_->info.two_way ? kLinkReadable : 0u) | (impl_->out_bytes > 0 ? kLinkWritable : 0u);
}
const Error& Session::error() const {
    return impl_->error;
}
const Hello& Session::device() const {
    return impl_->device;
}
const DeviceStatus& Session::device_status() const {
    return impl_->device_status;
}
std::uint32_t Session::last_accepted() const {
    return impl_->transfer.last_accepted();
}
std::uint32_t Session::last_presented() const {
    return impl_->transfer.last_presented();
}
const SessionStatistics& Session::statistics() const {
    return impl_->statistics;
}

}  // namespace xorvox::host
