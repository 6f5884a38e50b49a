#include "driver/host/session.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "driver/host/capabilities.h"
#include "driver/host/session_impl.h"

namespace xorvox::host {

using namespace wire;

namespace {

constexpr int kPacketsPerPoll = 256;  ///< So that poll() returns, however fast the peer sends.

}  // namespace

Session::Impl::Impl(Link the_link, const DisplayDescription& the_display, const SessionOptions& the_options)
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

Status Session::Impl::poll(std::uint64_t now) {
    if (!started) {
        started = true;
        connecting_since_ns = moved_ns = willing_ns = now;
    } else if (now - now_ns > timeout_ns) {
        // The program slept or was stopped: the peer cannot be blamed for a time in which nobody tried.
        connecting_since_ns += now - now_ns;
        willing_ns += now - now_ns;
    }
    now_ns = now;
    bool moved = false;
    if (info.two_way && state != SessionState::Failed) moved = receive_all();
    if (info.two_way && state != SessionState::Failed) watch_clock();
    if (state != SessionState::Failed) moved |= send_all();
    if (state == SessionState::Failed) return failure;
    return moved ? Status::Ok : Status::WouldBlock;
}

Status Session::Impl::submit(std::span<const std::byte> frame, std::uint64_t present_at) {
    if (state == SessionState::Failed) return Status::Closed;
    if (frame.size() != frame_bytes(display)) return Status::InvalidArgument;
    if (transfer.phase() != Phase::None) return Status::WouldBlock;
    if (info.two_way && state == SessionState::Ready && free_pages == 0) return Status::WouldBlock;
    transfer.submit(frame, present_at);
    phase_since_ns = now_ns;
    return Status::Ok;
}

Status Session::Impl::control(const Control& control) {
    if (state == SessionState::Failed) return Status::Closed;
    if (!is_valid(control)) return Status::InvalidArgument;
    if (controls.full()) return Status::WouldBlock;
    controls.push(control);
    return Status::Ok;
}

// Ends and beginnings ------------------------------------------------------------------------------------

void Session::Impl::fail_with(Status status, std::string message) {
    state = SessionState::Failed;
    failure = status;
    error.message = std::move(message);
}

void Session::Impl::fail_closed() {
    if (info.two_way) {
        fail_with(Status::Closed,
                  fmt::format("the peer closed the connection on the link {}; start it again", info.name));
    } else {
        fail_with(Status::Closed, fmt::format("the link {} takes no more data; is the disk full?", info.name));
    }
}

void Session::Impl::fail_no_answer() {
    std::string message = fmt::format("no answer from a display on the link {}", info.name);
    if (statistics.packets_ignored > 0) {
        message += fmt::format(" ({} packets came that are not of this session)", statistics.packets_ignored);
    }
    fail_with(Status::Closed,
              message + "; check that a display or xorvox sim is at the other end, and not busy with another host");
}

/// Begins with a device of these capabilities.
void Session::Impl::adopt(const Hello& hello) {
    const bool other_clock = statistics.hellos > 0 && hello.boot_nonce != device.boot_nonce;
    device = hello;
    state = SessionState::Ready;
    device_time_ns = 0;
    set_device(hello.free_pages, hello.device_time_ns);
    clock.forget();
    if (info.two_way) clock.observe(hello.host_time_ns, now_ns, hello.device_time_ns);
    device_status.fault = hello.fault;
    // A later minor version may have faults that are not in the mask.
    device_status.faults = static_cast<unsigned>(hello.fault) < 32 ? fault_bit(hello.fault) : 0;
    has_status = false;
    ask_status_ns = ask_clock_ns = phase_since_ns = nothing_overdue_ns = now_ns;
    const bool lz4 = options.compress && (hello.codecs & 1u << static_cast<unsigned>(Codec::Lz4)) != 0;
    transfer.begin_with({std::min(hello.max_packet_bytes, info.max_packet_bytes), lz4}, other_clock);
    ++statistics.hellos;
    silent_timeouts = 0;
    asked = false;
    controls.begin_again();
    if (options.clears_silence) controls.heed(device_status.faults);
}

/// The device fell silent: asks who is there.
void Session::Impl::connect_again() {
    state = SessionState::Connecting;
    connecting_since_ns = now_ns;
    hello_attempts = 0;
    out_bytes = 0;
    if (transfer.began()) send_again({});
    // A device that answers nothing but hellos is no display.
    if (++lonely_hellos > options.attempts) fail_no_answer();
}

// The frame ----------------------------------------------------------------------------------------------

void Session::Impl::send_again(NackReason reason) {
    transfer.again(reason);
    phase_since_ns = now_ns;
    out_bytes = 0;
    if (transfer.failed_attempts() < options.attempts) return;
    fail_with(Status::Closed, fmt::format("the display on the link {} did not accept a frame in {} attempts: {}",
                                          info.name, transfer.failed_attempts(), transfer.refusal_text()));
}

// Receiving ----------------------------------------------------------------------------------------------

bool Session::Impl::receive_all() {
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

void Session::Impl::take(std::span<const std::byte> packet) {
    Header header;
    std::span<const std::byte> payload;
    const Status decoded = decode_packet(packet, header, payload);
    const bool of_session =
        (decoded == Status::Ok || decoded == Status::Unsupported) && header.session == options.session;
    if (of_session && decoded == Status::Unsupported) {
        fail_version("speaks another major version of the protocol than");
    } else if (!of_session || !understood(header, payload)) {
        ++statistics.packets_ignored;
    }
}

void Session::Impl::fail_version(const char* what) {
    fail_with(Status::Refused,
              fmt::format("the device on the link {} {} {}.{}; update the older one", info.name, what, kMajor, kMinor));
}

/// Acts on a packet of this session; false when it is damaged, late or repeated.
bool Session::Impl::understood(const Header& header, std::span<const std::byte> payload) {
    if (header.type == PacketType::Hello) {
        Hello hello;
        if (decode(payload, hello) != Status::Ok) return false;
        return on_hello(hello, header.sequence);
    }
    if (state == SessionState::Connecting) {
        return header.type == PacketType::Nack && act_on<Nack>(payload);
    }
    if (!is_newer(header.sequence, received_sequence)) return false;
    received_sequence = header.sequence;
    silent_timeouts = 0;
    lonely_hellos = 0;
    asked = false;
    switch (header.type) {
        case PacketType::Acknowledge: return act_on<Acknowledge>(payload);
        case PacketType::Nack: return act_on<Nack>(payload);
        case PacketType::DeviceStatus: return act_on<DeviceStatus>(payload);
        case PacketType::Pong: return act_on<Pong>(payload);
        default: return true;  // A later minor version's.
    }
}

template <class Message>
bool Session::Impl::act_on(std::span<const std::byte> payload) {
    Message message;
    if (decode(payload, message) != Status::Ok) return false;
    on(message);
    return true;
}

bool Session::Impl::on_hello(const Hello& hello, std::uint32_t its_sequence) {
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

void Session::Impl::on(const Acknowledge& message) {
    set_device(message.free_pages, message.device_time_ns);
    if (message.stage != AckStage::Accepted && message.stage != AckStage::Presented) return;
    // A Presented whose Accepted was lost says both. A later attempt of the same frame is not needed any more.
    if (transfer.accept(message)) out_bytes = 0;
    if (message.stage == AckStage::Presented) {
        set_presented(message.frame, message.page_crc, message.device_time_ns);
    }
}

void Session::Impl::on(const Nack& message) {
    if (message.reason == NackReason::BadVersion) return fail_version("refuses version");
    if (state == SessionState::Connecting) return;
    set_device(message.free_pages, message.device_time_ns);
    if (message.reason == NackReason::BadControl) {
        if (message.frame == 0 && controls.refused()) ++statistics.controls_lost;
    } else if (transfer.is_refused_by(message)) {
        if (message.reason != NackReason::BadFrame) return send_again(message.reason);
        fail_with(Status::Refused, fmt::format("the display on the link {} refuses a frame as not made for it; its "
                                               "firmware does not match what it says of itself",
                                               info.name));
    }
}

void Session::Impl::on(const DeviceStatus& message) {
    set_device(message.free_pages, message.device_time_ns);
    device_status = message;
    if (!has_status) ask_status_ns = now_ns + timeout_ns;
    has_status = true;
    if (message.has_frame != 0) set_presented(message.shown_frame, message.shown_crc, 0);
    if (options.clears_silence) controls.heed(message.faults);
    controls.confirmed_by(message);
}

void Session::Impl::on(const Pong& message) {
    clock.observe(message.host_time_ns, now_ns, message.device_time_ns);
}

void Session::Impl::set_device(std::uint8_t its_free_pages, std::uint64_t its_time_ns) {
    free_pages = std::min(its_free_pages, device.pages);
    device_time_ns = std::max(device_time_ns, its_time_ns);
}

void Session::Impl::set_presented(std::uint32_t frame, std::uint32_t page_crc, std::uint64_t its_time_ns) {
    if (transfer.presented(frame, page_crc, its_time_ns)) nothing_overdue_ns = now_ns;
}

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
    return impl_->control({.operation = operation, .value = value});
}

void Session::follow_clock(std::uint64_t every_ns) {
    impl_->clock_every_ns = every_ns;
}
const ClockOffset& Session::clock() const {
    return impl_->clock;
}
bool Session::next_fate(FrameFate& fate) {
    return impl_->transfer.next_fate(fate);
}

SessionState Session::state() const {
    return impl_->state;
}
bool Session::two_way() const {
    return impl_->info.two_way;
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
