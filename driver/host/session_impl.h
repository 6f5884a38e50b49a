// Session::Impl: what a session knows, and its halves: session.cpp begins, receives and ends, session_send.cpp watches
// the clock and sends. Internal to driver/host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "driver/host/clock_offset.h"
#include "driver/host/control_queue.h"
#include "driver/host/session.h"
#include "driver/host/transfer.h"
#include "driver/wire/messages.h"
#include "driver/wire/packet.h"

namespace xorvox::host {

struct Session::Impl {
    using Phase = Transfer::Phase;

    Impl(Link the_link, const DisplayDescription& the_display, const SessionOptions& the_options);
    Status poll(std::uint64_t now);
    Status submit(std::span<const std::byte> frame, std::uint64_t present_at);
    Status control(const wire::Control& control);

    void fail_with(Status status, std::string message);
    void fail_closed();
    void fail_no_answer();
    void fail_version(const char* what);
    void adopt(const wire::Hello& hello);
    void connect_again();
    void send_again(wire::NackReason reason);

    bool receive_all();
    void take(std::span<const std::byte> packet);
    bool understood(const wire::Header& header, std::span<const std::byte> payload);
    template <class Message>
    bool act_on(std::span<const std::byte> payload);
    bool on_hello(const wire::Hello& hello, std::uint32_t its_sequence);
    void on(const wire::Acknowledge& message);
    void on(const wire::Nack& message);
    void on(const wire::DeviceStatus& message);
    void on(const wire::Pong& message);
    void set_device(std::uint8_t its_free_pages, std::uint64_t its_time_ns);
    void set_presented(std::uint32_t frame, std::uint32_t page_crc, std::uint64_t its_time_ns);

    bool passed(std::uint64_t since_ns, std::uint64_t timeouts) const;
    void watch_clock();
    void watch_transfer();
    void watch_presentation();
    bool wants_status() const;
    std::uint64_t ping_every_ns() const;
    bool send_all();
    bool compose();
    bool compose_hello();
    template <class Message>
    bool compose_message(const Message& message);

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
    std::uint64_t moved_ns = 0;    ///< When the link last took a packet.
    std::uint64_t willing_ns = 0;  ///< The same, without the times in which it was not asked to.

    std::vector<std::byte> in;
    std::uint32_t received_sequence = 0;
    std::vector<std::byte> out;  ///< One packet that the link has not taken yet.
    std::size_t out_bytes = 0;
    std::uint32_t sequence = 0;

    wire::Hello device;
    wire::DeviceStatus device_status;
    bool has_status = false;          ///< `device_status` came in this session with the device.
    std::uint64_t ask_status_ns = 0;  ///< When to ask for one, if it is wanted.
    std::uint8_t free_pages = 0;
    std::uint64_t device_time_ns = 0;  ///< The latest that the device told.
    ClockOffset clock;
    std::uint64_t clock_every_ns = 0;  ///< 0: nobody wants to know.
    std::uint64_t ask_clock_ns = 0;    ///< When to ask for it, if it is wanted.

    Transfer transfer{statistics};
    std::uint64_t keyframe_ns = 0;         ///< When the last keyframe was begun.
    std::uint64_t phase_since_ns = 0;      ///< When the frame was queued or sent.
    std::uint64_t nothing_overdue_ns = 0;  ///< When a frame was presented, or none was due.

    ControlQueue controls;
};

}  // namespace xorvox::host
