// share: lets other programs draw on a display; their latest frame goes out each cycle.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "driver/display/toml.h"
#include "driver/host/frame_share.h"
#include "driver/host/framebuffer.h"
#include "tools/clock.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/delivery.h"
#include "tools/placement.h"
#include "tools/stop.h"
#include "tools/stream.h"

namespace xorvox::tools {
namespace {

/// By xorvox_frames_status, what clients and frames are refused for.
constexpr std::array<std::string_view, XORVOX_FRAMES_STATUSES> kRefusals{
    "", "busy", "no_memory", "message", "version", "page", "format", "size", "digest", "", ""};

/// Runs the server in a thread of its own while it lives.
class Serving {
public:
    explicit Serving(host::FrameShare& share)
        : thread_([&share](const std::stop_token& end) {
              const std::stop_callback wake(end, [&share] { share.wake(); });
              while (!end.stop_requested()) {
                  share.poll(clock_ns());
                  share.wait(-1);
              }
              share.poll(clock_ns());
          }) {}

private:
    std::jthread thread_;
};

/// The latest frame for each cycle of a display: dark before the first one.
class LatestFrames {
public:
    /// `paced`: nobody else makes cycles take their time, as on a display in this program.
    LatestFrames(const ShareOptions& options, const DisplayDescription& display, host::Framebuffer& frames, bool paced)
        : options_(options), display_(display), frames_(frames), paced_(paced) {}

    bool operator()(const FrameMoment& moment, std::span<std::byte> frame) {
        announce();
        if (options_.frames != 0 && last_ >= options_.frames) return false;
        if (paced_ && !wait_until(begun_ns_ + static_cast<std::uint64_t>(moment.seconds * 1e9))) return false;
        const host::Frame latest = frames_.latest();
        if (latest.bytes.empty()) {
            std::fill(frame.begin(), frame.end(), std::byte{0});
            return true;
        }
        std::copy(latest.bytes.begin(), latest.bytes.end(), frame.begin());
        handed_on_ += latest.sequence != last_;
        last_ = latest.sequence;
        tag_ = latest.tag;
        return true;
    }

    std::uint64_t handed_on() const { return handed_on_; }
    std::uint64_t tag() const { return tag_; }

private:
    /// Once, and at once, because programs wait for it.
    void announce() {
        if (begun_ns_ != 0) return;
        begun_ns_ = clock_ns();
        options_.delivery.json ? fmt::print("{{\"event\": \"ready\", \"socket\": {}, \"display\": {}}}\n",
                                            json_string(options_.socket), json_string(display_.name.view()))
                               : fmt::print("{}: programs may draw at {}\n", display_.name.view(), options_.socket);
        std::fflush(stdout);
    }

    /// False: a signal came.
    static bool wait_until(std::uint64_t deadline_ns) {
        // A signal does not end a sleep that another thread caught it in.
        constexpr std::uint64_t kMoment_ns = 20'000'000;
        for (std::uint64_t now_ns = clock_ns(); !asked_to_stop() && now_ns < deadline_ns; now_ns = clock_ns()) {
            std::this_thread::sleep_for(std::chrono::nanoseconds(std::min(deadline_ns - now_ns, kMoment_ns)));
        }
        return !asked_to_stop();
    }

    const ShareOptions& options_;
    const DisplayDescription& display_;
    host::Framebuffer& frames_;
    bool paced_;
    std::uint64_t begun_ns_ = 0;
    std::uint32_t last_ = 0;  ///< Number of the frame that went out last; 0: dark.
    std::uint64_t handed_on_ = 0;
    std::uint64_t tag_ = 0;
};

std::string refused_json(const host::ShareStatistics& seen) {
    std::string members;
    for (std::size_t i = 0; i < kRefusals.size(); ++i) {
        if (kRefusals[i].empty()) continue;
        members += fmt::format("{}\"{}\": {}", members.empty() ? "" : ", ", kRefusals[i], seen.refused[i]);
    }
    return "{" + members + "}";
}

void report(const ShareOptions& options, const DisplayDescription& display, const host::ShareStatistics& seen,
            const LatestFrames& source, const StreamDelivery& delivery) {
    const DeliveryOptions& to = options.delivery;
    const std::optional<LightSeen>& light = delivery.light;
    if (to.json) {
        fmt::print(
            "{{\"event\": \"ended\", \"display\": {}, \"to\": {}, \"programs\": {}, \"frames_published\": {}, "
            "\"by_message\": {}, \"by_atomics\": {}, \"frames_handed_on\": {}, \"last_tag\": {}, \"refused\": {}, {}, "
            "{}}}\n",
            json_string(display.name.view()), json_string(to.to), seen.clients, seen.frames(), seen.by_message,
            seen.by_exchange, source.handed_on(), source.tag(), refused_json(seen), stream_json(delivery),
            picture_json(to, light));
        return;
    }
    fmt::print("drawn: {} frames by {} {}, {} by message and {} by atomics; {} went on to the display\n",
               thousands(seen.frames()), thousands(seen.clients), seen.clients == 1 ? "program" : "programs",
               thousands(seen.by_message), thousands(seen.by_exchange), thousands(source.handed_on()));
    for (std::size_t i = 0; i < kRefusals.size(); ++i) {
        if (seen.refused[i] == 0) continue;
        fmt::print("refused, {} of them: {}\n", thousands(seen.refused[i]), xorvox_frames_text(static_cast<int>(i)));
    }
    print_stream(delivery);
    if (light) {
        fmt::print("lit: {} pixels at {} places\n", thousands(light->statistics.pixels_lit),
                   thousands(light->statistics.voxels_lit));
        print_in_time(to.simulation, light->in_time);
    }
    if (!to.png.empty() && light) fmt::print("picture: {}\n", to.png);
}

}  // namespace

Expected<void> share(const ShareOptions& options) {
    const DeliveryOptions& to = options.delivery;
    const Expected<transport::Address> address = transport::parse_address(to.to);
    if (!address) return fail("--to: " + address.error().message);
    if (const auto possible = check_delivery(to, *address, ""); !possible) return possible;
    const Expected<DisplayFile> display = load_display(options.display);
    if (!display) return tl::unexpected(display.error());
    if (const auto fits = check_display_fits(*display); !fits) return fits;
    std::optional<io::AtomicFile> png;
    if (!to.png.empty()) {
        Expected<io::AtomicFile> file = io::AtomicFile::create(to.png);
        if (!file) return tl::unexpected(file.error());
        png = std::move(*file);
    }
    auto recording = make_recording(to, *display);
    if (!recording) return tl::unexpected(recording.error());
    sim::RecordingWriter* const recorder = *recording ? &**recording : nullptr;
    stop_on_signals();
    host::Framebuffer frames(frame_bytes(*display));
    const auto server = host::FrameShare::listen(*display, options.socket, frames);
    if (!server) return fail("--socket " + server.error().message);
    LatestFrames latest(options, *display, frames, address->kind != transport::AddressKind::Tcp);
    const FrameSource source = [&latest](const FrameMoment& moment, std::span<std::byte> frame) {
        return latest(moment, frame);
    };
    const auto delivery = [&] {
        const Serving serving(**server);
        return deliver_stream(to, *address, *display, source, options.seconds, png ? &*png : nullptr, recorder);
    }();
    if (!delivery) return tl::unexpected(delivery.error());
    report(options, *display, (*server)->statistics(), latest, *delivery);
    if (const auto kept = finish_recording(to, recorder); !kept) return kept;
    return delivery->broken ? Expected<void>(tl::unexpected(*delivery->broken)) : Expected<void>();
}

}  // namespace xorvox::tools
