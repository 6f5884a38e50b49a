#include "tools/stream.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/host/faults.h"
#include "sim/simulator.h"
#include "tools/clock.h"
#include "tools/console.h"
#include "tools/stop.h"
#include "transport/file.h"
#include "transport/loopback.h"
#include "transport/tcp.h"

namespace xorvox::tools {
namespace {

/// Takes frames from a source and offers them to a stream.
class Feeder {
public:
    /// `two_way`: the far end says when it shows what.
    Feeder(const FrameSource& source, const DisplayDescription& display, double seconds, bool two_way)
        : source_(source),
          two_way_(two_way),
          seconds_(seconds > 0.0 ? seconds : std::numeric_limits<double>::infinity()),
          frame_(frame_bytes(display)) {}

    /// The first frame, which a session's name may depend on.
    std::span<const std::byte> first() {
        make({});
        return frame_;
    }
    bool done() const { return ended_ && !made_; }

    /// Offers as many frames as there is room for.
    void feed(host::FrameStream& stream) {
        while (!done() && stream.has_room()) {
            if (!made_) {
                const auto period_s = static_cast<double>(stream.period_ns()) * 1e-9;
                const std::uint64_t slot = two_way_ ? stream.next_slot() : number_;
                make({number_, static_cast<double>(slot) * period_s});
            }
            if (!made_ || stream.offer(frame_) != Status::Ok) return;
            made_ = false;
            ++number_;
        }
    }

private:
    void make(const FrameMoment& moment) {
        made_ = !ended_ && moment.seconds < seconds_ && source_(moment, frame_);
        ended_ = ended_ || !made_;
    }

    const FrameSource& source_;
    bool two_way_;
    double seconds_;
    std::vector<std::byte> frame_;
    std::uint64_t number_ = 0;
    bool made_ = false;  ///< frame_ is not offered yet.
    bool ended_ = false;
};

Expected<StreamDelivery> stream_in_process(const DeliveryOptions& options, const DisplayDescription& display,
                                           Feeder& feeder, io::AtomicFile* png, sim::RecordingWriter* recording) {
    std::uint64_t now_ns = 0;
    auto [near_end, device_end] = transport::make_loopback();
    const UniqueLink host_end = recorded(std::move(near_end), recording, [&now_ns] { return now_ns; });
    Expected<LocalDisplay> local = make_local_display(options, display, device_end.get());
    if (!local) return tl::unexpected(local.error());
    sim::Simulator& simulator = local->simulator;
    host::Session session(host_end.get(), display,
                          session_options(false, display, feeder.first(), !options.record.empty()));
    host::FrameStream stream(session, display);
    // What moves is watched from its first frame on.
    if (local->shutter && options.simulation.exposure_s) local->shutter->open(simulator, options.simulation);
    stop_on_signals();
    while (!asked_to_stop() && (!feeder.done() || !stream.idle())) {
        feeder.feed(stream);
        const Status host_moved = stream.poll(now_ns);
        const Status device_moved = simulator.poll(now_ns);
        if (session.state() == host::SessionState::Failed) return tl::unexpected(session.error());
        if (host_moved == Status::WouldBlock && device_moved == Status::WouldBlock) {
            now_ns = std::min(simulator.next_boundary_ns(), now_ns + kSimulatedStep_ns);
        }
    }
    StreamDelivery delivery{session.statistics(), stream.statistics(), true, std::nullopt, std::nullopt};
    const std::size_t lit = sim::count_lit(display, simulator.device().shown().page);
    Expected<std::optional<LightSeen>> seen =
        look_at(*local, now_ns, lit, options, png, [&](std::uint64_t time_ns) { (void)stream.poll(time_ns); });
    if (!seen) return tl::unexpected(seen.error());
    delivery.light = std::move(*seen);
    return delivery;
}

Expected<StreamDelivery> stream_over(Link link, const DeliveryOptions& options, const DisplayDescription& display,
                                     Feeder& feeder) {
    const bool two_way = link.info().two_way;
    const auto now_ns = [two_way] { return two_way ? clock_ns() : 0; };
    host::Session session(link, display, session_options(two_way, display, feeder.first(), !options.record.empty()));
    host::FrameStream stream(session, display);
    stop_on_signals();
    StreamDelivery delivery;
    const auto poll = [&](std::int64_t patience_ns) {
        const Status moved = stream.poll(now_ns());
        const bool failed = session.state() == host::SessionState::Failed;
        if (failed) delivery.broken = Error{fmt::format("{}: {}", options.to, session.error().message)};
        if (moved == Status::WouldBlock) (void)link.wait(session.events(), patience_ns);
        return !failed;
    };
    bool alive = true;
    // After a signal nothing more is sent; what the display has, it shows without us.
    while (alive && !asked_to_stop() && (!feeder.done() || !stream.idle())) {
        feeder.feed(stream);
        alive = poll(1'000'000);  // Short: slots come round while nothing arrives.
    }
    delivery.session = session.statistics();
    delivery.stream = stream.statistics();
    while (alive && options.hold && !asked_to_stop()) alive = poll(100'000'000);
    if (!alive && session.statistics().hellos == 0) return tl::unexpected(*delivery.broken);
    return delivery;
}

}  // namespace

Expected<StreamDelivery> deliver_stream(const DeliveryOptions& options, const transport::Address& address,
                                        const DisplayDescription& display, const FrameSource& source, double seconds,
                                        io::AtomicFile* png, sim::RecordingWriter* recording) {
    Feeder feeder(source, display, seconds, address.kind != transport::AddressKind::File);
    switch (address.kind) {
        case transport::AddressKind::Loopback: return stream_in_process(options, display, feeder, png, recording);
        case transport::AddressKind::Tcp: {
            Expected<UniqueLink> link = transport::connect_tcp(address.host, address.port);
            if (!link) return tl::unexpected(link.error());
            const UniqueLink seen = recorded(std::move(*link), recording, clock_ns);
            return stream_over(seen.get(), options, display, feeder);
        }
        case transport::AddressKind::File: {
            Expected<UniqueLink> link = transport::open_file_writer(address.path);
            if (!link) return tl::unexpected(link.error());
            const Link file = link->get();
            const UniqueLink seen = recorded(std::move(*link), recording, [] { return std::uint64_t{0}; });
            Expected<StreamDelivery> delivery = stream_over(seen.get(), options, display, feeder);
            if (!delivery || delivery->broken) return delivery;
            if (const auto kept = transport::commit_file(file); !kept) return tl::unexpected(kept.error());
            return delivery;
        }
    }
    return fail("unknown kind of address");
}

void print_stream(const StreamDelivery& delivery) {
    const host::StreamStatistics& s = delivery.stream;
    const auto ms = [](std::uint64_t ns) { return static_cast<double>(ns) * 1e-6; };
    fmt::print("sent: {} frame{}, {} bytes as {}\n", thousands(s.sent), s.sent == 1 ? "" : "s",
               thousands(delivery.session.bytes_raw), thousands(delivery.session.bytes_sent));
    if (s.presented == 0) return;
    fmt::print("shown: {} frames at {:.2f} a second{}; {} late, {} given up, {} slots missed, {} dropped\n",
               thousands(s.presented), s.rate_hz, delivery.simulated ? " of simulated time" : "", thousands(s.late),
               thousands(s.given_up), thousands(s.slots_missed), thousands(s.dropped));
    fmt::print("lateness: p50 {:.2f} ms, p99 {:.2f} ms, max {:.2f} ms; longest interval {:.1f} ms\n",
               ms(s.lateness_p50_ns), ms(s.lateness_p99_ns), ms(s.lateness_max_ns), ms(s.worst_interval_ns));
}

std::string stream_json(const StreamDelivery& delivery) {
    const host::StreamStatistics& s = delivery.stream;
    return fmt::format(
        "\"frames_sent\": {}, \"frames_presented\": {}, \"frames_late\": {}, \"frames_given_up\": {}, "
        "\"frames_dropped\": {}, \"slots_missed\": {}, \"rate_hz\": {:.6g}, \"lateness_ns\": {{\"p50\": {}, \"p99\": "
        "{}, "
        "\"max\": {}}}, \"worst_interval_ns\": {}, \"simulated_time\": {}, \"bytes_raw\": {}, \"bytes_sent\": {}",
        s.sent, s.presented, s.late, s.given_up, s.dropped, s.slots_missed, s.rate_hz, s.lateness_p50_ns,
        s.lateness_p99_ns, s.lateness_max_ns, s.worst_interval_ns, delivery.simulated, delivery.session.bytes_raw,
        delivery.session.bytes_sent);
}

}  // namespace xorvox::tools
