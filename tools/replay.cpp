// replay: a recording to a display: packet by packet to one in this program, else frame by frame.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/display/toml.h"
#include "driver/wire/messages.h"
#include "sim/recording/frames.h"
#include "sim/recording/playback.h"
#include "sim/recording/reader.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/delivery.h"
#include "tools/placement.h"
#include "tools/stop.h"
#include "tools/stream.h"
#include "transport/loopback.h"

namespace xorvox::tools {
namespace {

/// A time beyond this is a mistake in the file, and would be simulated cycle by cycle.
constexpr std::uint64_t kLongest_ns = std::uint64_t{24} * 3600 * 1'000'000'000;

/// What is wrong with the recording: an end, or, with --keep-going, a warning.
class Troubles {
public:
    explicit Troubles(bool keep_going) : keep_going_(keep_going) {}

    Expected<void> note(const std::string& trouble) {
        if (!keep_going_) return fail(trouble);
        constexpr std::size_t kMost = 5;
        if (++count_ <= kMost) warn(trouble);
        if (count_ == kMost) warn("there may be more of this, which is not told");
        return {};
    }
    std::uint64_t count() const { return count_; }

private:
    bool keep_going_;
    std::size_t count_ = 0;
};

std::uint64_t to_ns(double seconds) {
    constexpr double kMost = 9e18;
    return static_cast<std::uint64_t>(std::min(seconds * 1e9, kMost));
}

/// Reads all that will be played once, so that nothing of a damaged recording is shown to anybody unless asked for.
Expected<void> check(sim::RecordingReader& reader, const DisplayDescription& display, std::uint64_t from_ns,
                     Troubles& troubles) {
    sim::RecordedFrames frames(reader, display);
    for (Status status = frames.seek(from_ns); status != Status::Closed; status = frames.next()) {
        if (status != Status::Corrupt) continue;
        if (const auto noted = troubles.note(frames.damage()); !noted) return noted;
    }
    if (frames.latest_ns() <= kLongest_ns) return {};
    return fail(
        fmt::format("{}: a packet of it comes {:.3g} s after its beginning, which is more than a day; no such "
                    "recording is played",
                    reader.name(), static_cast<double>(frames.latest_ns()) * 1e-9));
}

/// What the display in this program said of what it got.
struct Answers {
    std::uint64_t accepted = 0;
    std::uint64_t presented = 0;
    std::uint64_t refused = 0;
    std::uint32_t last_accepted = 0;
    std::uint32_t last_presented = 0;
    bool any_presented = false;

    bool all_presented() const { return accepted == 0 || last_accepted == last_presented; }

    /// Takes what waits at `link`; of what is presented before `from_ns`, the number does not count.
    void drain(Link link, bool counts) {
        std::size_t size = 0;
        while (link.receive(buffer_, size) == Status::Ok) {
            wire::Header header;
            std::span<const std::byte> payload;
            if (wire::decode_packet(std::span(buffer_).first(size), header, payload) != Status::Ok) continue;
            wire::Acknowledge acknowledge;
            if (header.type == wire::PacketType::Nack) ++refused;
            if (header.type != wire::PacketType::Acknowledge) continue;
            if (wire::decode(payload, acknowledge) != Status::Ok) continue;
            const bool shown = acknowledge.stage == wire::AckStage::Presented;
            (shown ? presented : accepted) += counts;
            any_presented = any_presented || shown;
            (shown ? last_presented : last_accepted) = acknowledge.frame;
            if (shown) last_accepted = wire::is_newer(last_presented, last_accepted) ? last_presented : last_accepted;
        }
    }

private:
    std::vector<std::byte> buffer_ = std::vector<std::byte>(wire::kMaxPacketBytes);
};

struct Replayed {
    Answers answers;
    std::uint64_t simulated_ns = 0;
    std::optional<LightSeen> light;
};

/// Packet by packet in simulated time: the clock goes from boundary to boundary and from packet to packet.
Expected<Replayed> replay_in_process(const ReplayOptions& options, const DisplayFile& display,
                                     sim::RecordingReader& reader, io::AtomicFile* png,
                                     sim::RecordingWriter* recording) {
    std::uint64_t now_ns = 0;
    auto [near_end, device_end] = transport::make_loopback();
    const UniqueLink host_end = recorded(std::move(near_end), recording, [&now_ns] { return now_ns; });
    Expected<LocalDisplay> local = make_local_display(options.delivery, display, device_end.get());
    if (!local) return tl::unexpected(local.error());
    sim::Simulator& simulator = local->simulator;

    const std::uint64_t from_ns = to_ns(options.seek_seconds);
    sim::Playback playback(reader);
    Replayed replayed;
    Answers& answers = replayed.answers;
    bool counts = from_ns == 0;
    const auto settle = [&] {
        while (simulator.poll(now_ns) == Status::Ok) {
        }
        answers.drain(host_end.get(), counts);
    };
    const auto advance_to = [&](std::uint64_t moment_ns) {
        while (!asked_to_stop() && simulator.next_boundary_ns() < moment_ns) {
            now_ns = simulator.next_boundary_ns();
            settle();
        }
        now_ns = std::max(now_ns, moment_ns);
    };
    stop_on_signals();
    (void)playback.seek(from_ns);  // Damage was noted by check().
    for (Status status = playback.next(); status != Status::Closed && !asked_to_stop(); status = playback.next()) {
        if (status == Status::Corrupt) continue;  // Noted by check().
        counts = counts || playback.time_ns() >= from_ns;
        advance_to(playback.due_ns());
        while (host_end->send(playback.packet()) == Status::WouldBlock) settle();
        settle();
    }
    // What was accepted is shown, if that is not far off.
    const std::uint64_t cycle = cycle_ns(display);
    const std::uint64_t until_ns = std::max(now_ns, std::min(playback.last_present_at_ns(), now_ns + 100 * cycle));
    while (!asked_to_stop() && !answers.all_presented() && simulator.next_boundary_ns() <= until_ns + 2 * cycle) {
        now_ns = simulator.next_boundary_ns();
        settle();
    }
    if (!answers.any_presented && !asked_to_stop()) {
        return fail(options.file + ": nothing of it could be shown; the display presented no frame");
    }
    replayed.simulated_ns = now_ns;
    const std::size_t lit = sim::count_lit(display, simulator.device().shown().page);
    // The host that was recorded is not gone while the display is looked at.
    std::vector<std::byte> ping(wire::kMaxPacketBytes);
    std::uint64_t pinged_ns = now_ns;
    const auto meanwhile = [&](std::uint64_t time_ns) {
        constexpr std::uint64_t kPingEvery_ns = 10'000'000;
        now_ns = time_ns;
        answers.drain(host_end.get(), false);
        std::size_t size = 0;
        if (time_ns - pinged_ns < kPingEvery_ns || !playback.make_ping(time_ns, ping, size)) return;
        (void)host_end->send(std::span(ping).first(size));
        pinged_ns = time_ns;
    };
    Expected<std::optional<LightSeen>> seen = look_at(*local, now_ns, lit, options.delivery, png, meanwhile);
    if (!seen) return tl::unexpected(seen.error());
    replayed.light = std::move(*seen);
    return replayed;
}

void print_heading(const ReplayOptions& options, const DisplayFile& display, const sim::RecordingReader& reader) {
    const std::size_t frames = reader.frames().size();
    fmt::print("{}: {} frame{} in {:.3f} s, for {}\n", options.file, thousands(frames), frames == 1 ? "" : "s",
               static_cast<double>(reader.duration_ns()) * 1e-9, display.name.view());
}

void print_lit(const ReplayOptions& options, const std::optional<LightSeen>& light) {
    if (!light) return;
    const sim::Statistics& seen = light->statistics;
    fmt::print("lit: {} pixels at {} places, {} outside the display\n", thousands(seen.pixels_lit),
               thousands(seen.voxels_lit), thousands(seen.light_outside));
    print_in_time(options.delivery.simulation, light->in_time);
    if (!options.delivery.png.empty()) fmt::print("picture: {}\n", options.delivery.png);
}

void print_replayed(const ReplayOptions& options, const DisplayFile& display, const sim::RecordingReader& reader,
                    const Replayed& replayed, std::size_t troubles) {
    const Answers& answers = replayed.answers;
    if (options.delivery.json) {
        fmt::print(
            "{{\"recording\": {}, \"display\": {}, \"to\": {}, \"frames\": {}, \"frames_accepted\": {}, "
            "\"frames_presented\": {}, \"frames_refused\": {}, \"damaged_places\": {}, \"simulated_s\": {:.6f}, {}}}\n",
            json_string(options.file), json_string(display.name.view()), json_string(options.delivery.to),
            reader.frames().size(), answers.accepted, answers.presented, answers.refused, troubles,
            static_cast<double>(replayed.simulated_ns) * 1e-9, picture_json(options.delivery, replayed.light));
        return;
    }
    print_heading(options, display, reader);
    fmt::print("shown: {} frame{}, {} given up, {} refused\n", thousands(answers.presented),
               answers.presented == 1 ? "" : "s",
               thousands(answers.accepted - std::min(answers.accepted, answers.presented)), thousands(answers.refused));
    print_lit(options, replayed.light);
}

/// Gives a stream, at each moment, the frame that the recording had last.
class FrameFeed {
public:
    FrameFeed(const ReplayOptions& options, sim::RecordingReader& reader, const DisplayDescription& display)
        : frames_(reader, display),
          cycle_ns_(cycle_ns(display)),
          speed_(options.speed.value_or(1.0)),
          from_ns_(to_ns(options.seek_seconds)) {}

    Expected<void> begin() {
        (void)frames_.seek(from_ns_);  // Damage was noted by check().
        // What is shown at the moment where it begins: the last frame before it, or the first one after.
        read();
        while (more_ && next_ns_ <= from_ns_) step();
        if (current_.empty() && more_) step();
        if (current_.empty()) return fail("there is no whole frame to be played; record it anew, or --seek less");
        begin_ns_ = std::max(from_ns_, begin_of_first());
        return {};
    }

    bool operator()(const FrameMoment& moment, std::span<std::byte> frame) {
        if (ended_) return false;
        if (speed_ == 0.0) {
            if (moment.number > 0) step();
        } else {
            // The newest frame of this cycle; moments are as exact as half of one.
            const double ahead = std::max(speed_ - 1.0, 0.0) + 0.5 * std::min(speed_, 1.0);
            const std::uint64_t until_ns =
                begin_ns_ + to_ns(moment.seconds * speed_ + ahead * static_cast<double>(cycle_ns_) * 1e-9);
            while (more_ && next_ns_ <= until_ns) step();
        }
        std::ranges::copy(current_, frame.begin());
        ended_ = !more_;
        return true;
    }

private:
    /// Reads on to the next frame.
    void read() {
        Status status = frames_.next();
        while (status == Status::Corrupt) status = frames_.next();  // Noted by check().
        more_ = status == Status::Ok;
        next_ns_ = frames_.shown_ns();
        next_asked_ = frames_.frame().present_at_ns != 0;
    }
    void step() {
        current_asked_ = next_asked_;
        current_.assign(frames_.frame().bytes.begin(), frames_.frame().bytes.end());
        current_ns_ = next_ns_;
        read();
    }

    /// A frame that asked for no moment was shown at the first boundary after it was whole: whole cycles before the
    /// next one, which did.
    std::uint64_t begin_of_first() const {
        if (current_asked_ || !more_ || !next_asked_ || next_ns_ <= current_ns_) return current_ns_;
        return next_ns_ - (next_ns_ - current_ns_ - 1) / cycle_ns_ * cycle_ns_;
    }

    sim::RecordedFrames frames_;
    std::uint64_t cycle_ns_;
    double speed_;
    std::uint64_t from_ns_;
    std::uint64_t begin_ns_ = 0;
    std::vector<std::byte> current_;
    std::uint64_t current_ns_ = 0;
    bool current_asked_ = false;
    bool next_asked_ = false;
    bool more_ = false;  ///< frames_ has one after `current_`, to be shown at next_ns_.
    std::uint64_t next_ns_ = 0;
    bool ended_ = false;
};

Expected<void> replay_over(const ReplayOptions& options, const transport::Address& address, const DisplayFile& display,
                           sim::RecordingReader& reader, const Troubles& troubles, io::AtomicFile* png,
                           sim::RecordingWriter* recording) {
    FrameFeed feed(options, reader, display);
    if (const auto begun = feed.begin(); !begun) return begun;
    const FrameSource source = [&feed](const FrameMoment& moment, std::span<std::byte> frame) {
        return feed(moment, frame);
    };
    const auto delivery = deliver_stream(options.delivery, address, display, source, 0.0, png, recording);
    if (!delivery) return tl::unexpected(delivery.error());
    if (options.delivery.json) {
        fmt::print(
            "{{\"recording\": {}, \"display\": {}, \"to\": {}, \"frames\": {}, \"damaged_places\": {}, {}, {}}}\n",
            json_string(options.file), json_string(display.name.view()), json_string(options.delivery.to),
            reader.frames().size(), troubles.count(), stream_json(*delivery),
            picture_json(options.delivery, delivery->light));
    } else {
        print_heading(options, display, reader);
        print_stream(*delivery);
        print_lit(options, delivery->light);
    }
    return delivery->broken ? Expected<void>(tl::unexpected(*delivery->broken)) : Expected<void>();
}

/// Whether the packets of a recording without a description are of `display`, as far as they tell.
Expected<void> check_packets(sim::RecordingReader& reader, const DisplayDescription& display,
                             const ReplayOptions& options) {
    reader.rewind();
    sim::Block block;
    for (Status status = reader.next(block); status != Status::Closed; status = reader.next(block)) {
        wire::Header header;
        std::span<const std::byte> payload;
        if (status != Status::Ok || wire::decode_packet(block.payload, header, payload) != Status::Ok) continue;
        wire::Hello hello;
        wire::FrameBegin begin;
        const bool is_hello = header.type == wire::PacketType::Hello && wire::decode(payload, hello) == Status::Ok;
        const bool begins = header.type == wire::PacketType::FrameBegin && wire::decode(payload, begin) == Status::Ok;
        const bool another = (is_hello && hello.geometry_digest != geometry_digest(display)) ||
                             (begins && begin.frame_bytes != frame_bytes(display));
        if (another) {
            return fail(fmt::format("{}: byte {}: this packet is of another display than --display {}{}", options.file,
                                    block.offset, options.display,
                                    is_hello ? fmt::format("; the device was a {}", hello.display.view()) : ""));
        }
        if (is_hello || begins) return {};
    }
    return {};
}

/// The display to play for: the one of the recording, or another of the same geometry.
Expected<DisplayFile> choose_display(const ReplayOptions& options, const sim::RecordingReader& reader) {
    if (options.display.empty()) {
        if (reader.display() == nullptr) return fail(reader.fault() + "; give it with --display");
        return *reader.display();
    }
    Expected<DisplayFile> display = load_display(options.display);
    if (!display || reader.display() == nullptr) return display;
    if (geometry_digest(*display) == geometry_digest(*reader.display())) return display;
    return fail(
        fmt::format("{} was recorded for {}, and --display {} has another geometry: its frames mean something "
                    "else there; leave --display out, or record the model for that display",
                    options.file, reader.display()->name.view(), options.display));
}

}  // namespace

Expected<void> replay(const ReplayOptions& options) {
    const DeliveryOptions& to = options.delivery;
    const Expected<transport::Address> address = transport::parse_address(to.to);
    if (!address) return fail("--to: " + address.error().message);
    if (const auto possible = check_delivery(to, *address, options.file); !possible) return possible;
    Expected<sim::RecordingReader> reader =
        sim::open_recording(options.file, options.keep_going ? sim::Damage::Tolerated : sim::Damage::Refused);
    if (!reader) return tl::unexpected(reader.error());
    Troubles troubles(options.keep_going);
    const Expected<DisplayFile> display = choose_display(options, *reader);
    if (!display) return tl::unexpected(display.error());
    if (reader->display() == nullptr) {
        (void)troubles.note(reader->fault());
        if (const auto meant = check_packets(*reader, *display, options); !meant) return meant;
    }
    if (const auto fits = check_display_fits(*display); !fits) return fits;
    const std::uint64_t from_ns = to_ns(options.seek_seconds);
    if (from_ns > reader->duration_ns()) {
        return fail(fmt::format("--seek {:g}: {} is {:.3f} s long", options.seek_seconds, options.file,
                                static_cast<double>(reader->duration_ns()) * 1e-9));
    }
    if (const auto whole = check(*reader, *display, from_ns, troubles); !whole) return whole;
    // Of what is damaged within, the end knows nothing better.
    if (troubles.count() == 0 && !reader->fault().empty()) (void)troubles.note(reader->fault());
    if (reader->frames().empty()) {
        return fail(options.file + ": there is no whole frame in it; record it anew");
    }
    std::optional<io::AtomicFile> png;
    if (!to.png.empty()) {
        Expected<io::AtomicFile> file = io::AtomicFile::create(to.png);
        if (!file) return tl::unexpected(file.error());
        png = std::move(*file);
    }
    auto recording = make_recording(to, *display);
    if (!recording) return tl::unexpected(recording.error());
    sim::RecordingWriter* const recorder = *recording ? &**recording : nullptr;
    io::AtomicFile* const picture = png ? &*png : nullptr;
    // At another speed the recorded host would not heed what this display has room for.
    const bool as_recorded = !options.speed || *options.speed == 1.0 || *options.speed == 0.0;
    if (address->kind == transport::AddressKind::Loopback && as_recorded) {
        const auto replayed = replay_in_process(options, *display, *reader, picture, recorder);
        if (!replayed) return tl::unexpected(replayed.error());
        print_replayed(options, *display, *reader, *replayed, troubles.count());
    } else if (const auto played = replay_over(options, *address, *display, *reader, troubles, picture, recorder);
               !played) {
        keep_recording(to, recorder);
        return played;
    }
    return finish_recording(to, recorder);
}

}  // namespace xorvox::tools
