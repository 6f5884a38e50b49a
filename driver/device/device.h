// Device: the receiving half of a display. It runs in firmware, in the simulator and on a Raspberry Pi alike.
//
// It takes packets from a Link, decodes frames into pages, presents a page at a boundary of the display's cycle, and
// blanks when the host falls silent. It owns no memory and no clock: the caller gives the buffers once and the time in
// every call. No heap, no exceptions, no RTTI, no floating point.
//
//   receive ─► decode into the target page ─► check ─► pending ─► (boundary) ─► shown
//
// One thread (or the main loop) calls everything; `boundary()`, `shown()`, `raise_fault()` and `faults()`, and so
// ScanControl::poll(), may instead be called by one interrupt handler as long as it does not interrupt `poll()` — the
// platform masks it there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/device/pages.h"
#include "driver/device/receiver.h"
#include "driver/display/description.h"
#include "driver/wire/messages.h"
#include "driver/wire/packet.h"
#include "transport/link.h"
#include "voxelizer/status.h"

namespace xorvox::device {

/// What the caller lends a Device for its whole life.
struct DeviceConfig {
    const DisplayDescription* display = nullptr;
    DisplayName serial;
    std::uint32_t boot_nonce = 0;  ///< Another value after every reset: a random number, or a counter in flash.
    Link link;                     ///< Empty: nobody is there until set_link().
    std::span<std::byte> pages;    ///< page_count × frame_bytes(*display).
    std::uint32_t page_count = 2;  ///< 2 … kMaxPages.
    std::span<std::byte> packet;   ///< 256 B … 64 KiB; the shorter of this and the link's is declared as max_packet.
};

/// What the panel shows now.
struct Shown {
    std::span<const std::byte> page;  ///< frame_bytes() in scan-out order; empty: dark.
    std::uint32_t frame = 0;
    std::uint8_t brightness = 255;
};

class Device {
public:
    /// Ok; InvalidArgument (a null, a size out of its range); OutOfMemory (`pages` too small). Call once, first.
    Status init(const DeviceConfig& config, std::uint64_t now_ns);

    /// Receives and answers what the link has, at most a bounded number of packets, and runs the watchdog. Call it
    /// often: at least every millisecond where the watchdog matters; time never goes back. While the link takes no
    /// answers nothing is received either, so none is lost. Ok; WouldBlock when nothing could be done; Closed when the
    /// link is gone or its peer sent a packet beyond max_packet (the watchdog still runs: keep calling, or give another
    /// link).
    Status poll(std::uint64_t now_ns);

    /// What to wait for at the link, as LinkOperations::wait takes it, after poll() answered WouldBlock: kLinkWritable
    /// while answers wait for room, else kLinkReadable.
    std::uint32_t events() const;

    /// The display's cycle begins anew (a turn, a sweep, a refresh): of the accepted frames that are due, shows the one
    /// that was due last, of equals the one accepted last. Nothing else ever changes what is shown, but blanking.
    void boundary(std::uint64_t now_ns);

    /// What to scan out until the next boundary; dark while blanked, by command, by policy or by a fault.
    Shown shown() const;

    /// Latches a fault: the display is dark until a host's command has cleared it and every other one. The host is told
    /// of each when it rises. None and unknown numbers do nothing. ScanControl raises all but the silent host's.
    void raise_fault(wire::Fault fault);

    /// fault_bit() of every fault that is latched.
    std::uint32_t faults() const { return faults_; }
    /// The one of them with the highest number, or None.
    wire::Fault fault() const;

    /// The link changed (the caller accepted another client): the session ends, the picture stays as the silence policy
    /// says.
    void set_link(Link link);

    wire::DeviceStatus status(std::uint64_t now_ns) const;

private:
    /// What has to be said and was not yet taken by the link. A later answer of a kind replaces the one before; no
    /// packet is received while any waits, so a frame's acceptance and refusal are never replaced.
    struct Answers {
        struct Refusal {
            std::uint16_t session = 0;
            wire::Nack nack;
        };
        bool hello = false;
        bool pong = false;
        bool status = false;
        bool accepted = false;
        bool presented = false;
        std::uint32_t refusal_count = 0;
        std::array<Refusal, 2> refusals{};  ///< A packet can end one frame and begin another that is refused.
        std::uint64_t hello_host_time_ns = 0;
        std::uint64_t pong_host_time_ns = 0;
        wire::Acknowledge accepted_frame;
        wire::Acknowledge presented_frame;
    };

    void take(std::span<const std::byte> packet, std::uint64_t now_ns);
    bool begins_session(const wire::Header& header, const wire::HelloRequest& request) const;
    void end_session();
    void on(const wire::Header& header, const wire::HelloRequest& request, std::uint64_t now_ns);
    void on(const wire::FrameBegin& begin, std::uint64_t now_ns);
    void on(const wire::Chunk& chunk, std::uint64_t now_ns);
    void on(const wire::FrameEnd& end, std::uint64_t now_ns);
    void on(const wire::Control& control, std::uint64_t now_ns);
    bool apply(const wire::Control& control);
    void interrupt_frame(std::uint32_t next, std::uint64_t now_ns);
    void drop_frame(std::uint32_t frame, wire::NackReason reason, std::uint64_t now_ns);
    void watch(std::uint64_t now_ns);

    bool waiting() const;
    bool send_answers(std::uint64_t now_ns);
    template <class Message>
    bool send(std::uint16_t session, const Message& message);
    void refuse(std::uint16_t session, wire::NackReason reason, std::uint32_t frame, std::uint64_t now_ns);
    wire::Hello hello(std::uint64_t now_ns) const;

    const DisplayDescription* display_ = nullptr;
    DisplayName serial_;
    std::uint32_t boot_nonce_ = 0;
    std::uint64_t geometry_digest_ = 0;
    Link link_;
    std::span<std::byte> packet_;

    std::uint16_t session_ = 0;  ///< 0: none.
    bool had_session_ = false;   ///< Since init().
    std::uint32_t received_sequence_ = 0;
    std::uint32_t sent_sequence_ = 0;
    std::uint64_t hello_host_time_ns_ = 0;
    std::uint64_t heard_ns_ = 0;  ///< When the last valid packet came.

    Pages pages_;
    Receiver receiver_;
    Answers answers_;

    std::uint8_t brightness_ = 255;
    bool blank_ = false;
    wire::SilenceAction silence_action_ = wire::SilenceAction::Blank;
    std::uint32_t watchdog_ms_ = 2000;
    std::uint32_t faults_ = 0;
    std::uint32_t frames_accepted_ = 0;
    std::uint32_t frames_dropped_ = 0;
    std::uint32_t packets_bad_ = 0;
};

}  // namespace xorvox::device
