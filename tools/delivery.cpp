#include "tools/delivery.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/host/faults.h"
#include "driver/wire/packet.h"
#include "sim/picture.h"
#include "sim/recording/record_link.h"
#include "sim/simulator.h"
#include "tools/clock.h"
#include "tools/console.h"
#include "tools/placement.h"
#include "tools/simulation.h"
#include "tools/stop.h"
#include "transport/file.h"
#include "transport/loopback.h"
#include "transport/tcp.h"

namespace xorvox::tools {
namespace {

Expected<void> write_png(io::AtomicFile& file, const sim::Image& image) {
    const std::vector<std::byte> png = sim::encode_png(image);
    const auto written = file.write({reinterpret_cast<const char*>(png.data()), png.size()});
    return written ? file.commit() : written;
}

/// A display in this program, in simulated time: both ends move in turn, and the clock jumps when neither can.
Expected<Delivery> show_in_process(const DeliveryOptions& options, const DisplayDescription& display,
                                   std::span<const std::byte> frame, std::size_t pixels, io::AtomicFile* png,
                                   sim::RecordingWriter* recording) {
    std::uint64_t now_ns = 0;
    auto [near_end, device_end] = transport::make_loopback();
    const UniqueLink host_end = recorded(std::move(near_end), recording, [&now_ns] { return now_ns; });
    Expected<LocalDisplay> local = make_local_display(options, display, device_end.get());
    if (!local) return tl::unexpected(local.error());
    sim::Simulator& simulator = local->simulator;
    host::Session session(host_end.get(), display, session_options(false, display, frame));

    bool submitted = false;
    while (session.statistics().frames_presented == 0) {
        const Status host_moved = session.poll(now_ns);
        const Status device_moved = simulator.poll(now_ns);
        if (session.state() == host::SessionState::Failed) return tl::unexpected(session.error());
        if (!submitted) submitted = session.submit(frame) == Status::Ok;
        if (host_moved == Status::WouldBlock && device_moved == Status::WouldBlock) {
            now_ns = std::min(simulator.next_boundary_ns(), now_ns + kSimulatedStep_ns);
        }
    }
    Delivery delivery{session.statistics(), std::nullopt};
    Expected<std::optional<LightSeen>> seen =
        look_at(*local, now_ns, pixels, options, png, [&](std::uint64_t time_ns) { (void)session.poll(time_ns); });
    if (!seen) return tl::unexpected(seen.error());
    delivery.light = std::move(*seen);
    return delivery;
}

/// Sends the frame and waits until it is presented, or, where there is no way back, until the link has all of it. With
/// --hold it stays, which keeps the display's watchdog quiet, until a signal comes.
Expected<Delivery> send_over(Link link, const DeliveryOptions& options, const DisplayDescription& display,
                             std::span<const std::byte> frame) {
    const bool two_way = link.info().two_way;
    if (!two_way && !options.json) {
        fmt::print("{} has no way back: keyframes only, and the display is taken to be as {} says\n", options.to,
                   display.name.view());
    }
    std::optional<Progress> progress("sending to " + options.to);
    // Nobody answers a recording: its time is 0, so that equal frames give equal files.
    const auto now_ns = [two_way] { return two_way ? clock_ns() : 0; };
    host::Session session(link, display, session_options(two_way, display, frame));
    bool submitted = false;
    const auto done = [&] {
        return submitted && session.idle() && (!two_way || session.statistics().frames_presented > 0);
    };
    stop_on_signals();
    const auto failed = [&] { return fail(fmt::format("{}: {}", options.to, session.error().message)); };
    while (!done()) {
        const Status moved = session.poll(now_ns());
        if (session.state() == host::SessionState::Failed) return failed();
        if (asked_to_stop()) return fail(options.to + ": interrupted before the display had the frame");
        if (!submitted) submitted = session.submit(frame) == Status::Ok;
        if (moved != Status::WouldBlock) continue;
        // Whatever it says, the session's own time-outs are looked at next.
        (void)link.wait(session.events(), 20'000'000);
    }
    const wire::DeviceStatus& device = session.device_status();
    if (two_way && (device.faults & ~wire::fault_bit(wire::Fault::SilentHost)) != 0) {
        warn(fmt::format("{}: the display has the frame but stays dark: {}", options.to, host::describe(device.fault)));
    }
    progress.reset();
    if (options.hold) {
        if (!options.json) fmt::print("{} shows it; Ctrl-C ends\n", options.to);
        std::fflush(stdout);
        while (!asked_to_stop()) {
            const Status moved = session.poll(now_ns());
            if (session.state() == host::SessionState::Failed) return failed();
            if (moved == Status::WouldBlock) (void)link.wait(session.events(), 100'000'000);
        }
    }
    return Delivery{session.statistics(), std::nullopt};
}

}  // namespace

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

host::SessionOptions session_options(bool distant, const DisplayDescription& display, std::span<const std::byte> frame,
                                     bool recorded) {
    host::SessionOptions options;
    if (recorded) options.keyframe_interval_ns = 1'000'000'000;
    // A slow display shows a frame a cycle after it came.
    options.present_timeout_ns = std::max(options.present_timeout_ns, static_cast<std::int64_t>(2 * cycle_ns(display)));
    const std::uint32_t number = distant ? std::random_device()() : wire::crc32c(frame);
    options.session = static_cast<std::uint16_t>(number % 0xffff + 1);
    return options;
}

Expected<std::optional<sim::RecordingWriter>> make_recording(const DeliveryOptions& options,
                                                             const DisplayFile& display) {
    if (options.record.empty()) return std::optional<sim::RecordingWriter>();
    return sim::RecordingWriter::create(options.record, display);
}

UniqueLink recorded(UniqueLink link, sim::RecordingWriter* recording, std::function<std::uint64_t()> now_ns) {
    if (recording == nullptr) return link;
    return sim::record_link(std::move(link), sim::LinkEnd::Host, *recording, std::move(now_ns));
}

Expected<void> finish_recording(const DeliveryOptions& options, sim::RecordingWriter* recording) {
    if (recording == nullptr) return {};
    if (const auto kept = recording->commit(); !kept) return kept;
    const std::uint64_t frames = recording->frames();
    if (!options.json) {
        fmt::print("recorded: {} frame{}, {:.3f} s in {}\n", thousands(frames), frames == 1 ? "" : "s",
                   static_cast<double>(recording->duration_ns()) * 1e-9, options.record);
    }
    return {};
}

void keep_recording(const DeliveryOptions& options, sim::RecordingWriter* recording) {
    if (recording == nullptr || recording->frames() == 0) return;
    if (const auto kept = finish_recording(options, recording); !kept) warn(kept.error().message);
}

Expected<LocalDisplay> make_local_display(const DeliveryOptions& options, const DisplayDescription& display,
                                          Link link) {
    DisplayFile built;
    sim::SimulatorOptions wanted;
    if (!options.built.empty()) {
        Expected<DisplayFile> file = load_display(options.built);
        if (!file) return fail("--built: " + file.error().message);
        built = std::move(*file);
        wanted.built = built;
    }
    Expected<sim::Conditions> conditions = read_conditions(options.simulation);
    if (!conditions) return tl::unexpected(conditions.error());
    if (const auto possible = check_rotor(*conditions, display); !possible) return tl::unexpected(possible.error());
    wanted.faults = std::move(conditions->faults);
    wanted.rotor = conditions->rotor;
    std::optional<Shutter> shutter;
    if (Shutter::is_wanted(options.simulation, *conditions)) {
        Expected<Shutter> made = Shutter::make(options.simulation);
        if (!made) return tl::unexpected(made.error());
        shutter = std::move(*made);
        wanted.keeps_time = true;
        wanted.fidelity = Shutter::fidelity(options.simulation);
    }
    Expected<sim::Simulator> simulator = sim::Simulator::make(display, link, wanted);
    if (!simulator) return tl::unexpected(simulator.error());
    return LocalDisplay{std::move(built), std::move(*simulator), std::move(shutter)};
}

Expected<void> check_delivery(const DeliveryOptions& options, const transport::Address& address,
                              const std::string& input) {
    const bool here = address.kind == transport::AddressKind::Loopback;
    if (!options.png.empty()) {
        if (!here) {
            return fail(
                "--png draws the light of a display in this program and needs --to loopback; leave out one of them");
        }
        if (extension_of(options.png) != ".png")
            return fail(fmt::format("--png {}: the picture is a PNG; give it a name that ends in .png", options.png));
    }
    if (!options.view.empty() && options.png.empty())
        return fail("--view says what --png draws; give --png OUT.png too");
    const bool draws = !options.png.empty() || !options.simulation.compare.empty();
    if (!options.frame.empty() && !draws)
        return fail("--frame says what --png and --compare show; give one of them, as in --png OUT.png, too");
    if (!options.built.empty() && !here) {
        return fail("--built is how a display in this program is built and needs --to loopback; leave out one of them");
    }
    const SimulationOptions& simulation = options.simulation;
    if (const auto possible = Shutter::check(simulation); !possible) return possible;
    if (!here && !simulation.empty()) {
        const char* behaves = !simulation.faults.empty()  ? "--fault"
                              : !simulation.file.empty()  ? "--sim"
                              : !simulation.rotor.empty() ? "--rotor"
                              : simulation.seed           ? "--seed"
                                                          : nullptr;
        if (behaves != nullptr) {
            return fail(
                fmt::format("{} is for a display in this program and needs --to loopback; of a distant one, give "
                            "it to xorvox sim",
                            behaves));
        }
        const char* looks = !simulation.fidelity.empty()    ? "--fidelity"
                            : simulation.exposure_s         ? "--exposure"
                            : !simulation.trace.empty()     ? "--trace"
                            : !simulation.histogram.empty() ? "--histogram"
                                                            : "--compare";
        return fail(fmt::format("{} looks at a display in this program and needs --to loopback; leave it out", looks));
    }
    if (const auto conditions = read_conditions(simulation); !conditions) return tl::unexpected(conditions.error());
    if (options.size) {
        if (!draws) return fail("--size is that of --png and --compare; give one of them, as in --png OUT.png, too");
        const auto [width, height] = *options.size;
        if (std::min(width, height) < 48 || std::max(width, height) > 4096) {
            return fail(fmt::format("--size {}x{}: a picture has 48 to 4096 pixels a side", width, height));
        }
    }
    if (options.hold && address.kind != transport::AddressKind::Tcp) {
        return fail("--hold keeps a display at the other end of a tcp link lit; use it with --to tcp:HOST:PORT");
    }
    std::error_code missing;
    const std::array outputs{options.png,      simulation.compare, simulation.histogram,
                             simulation.trace, options.record,     address.path};
    for (auto out = outputs.begin(); out != outputs.end(); ++out) {
        if (out->empty()) continue;
        if (!input.empty() && std::filesystem::equivalent(*out, input, missing)) {
            return fail(*out + " is the input itself; choose another name for the output");
        }
        if (std::find(outputs.begin(), out, *out) != out) {
            return fail(*out + " is asked for twice; choose another name for one of the outputs");
        }
    }
    return {};
}

Expected<std::optional<LightSeen>> look_at(LocalDisplay& local, std::uint64_t now_ns, std::size_t pixels,
                                           const DeliveryOptions& options, io::AtomicFile* png,
                                           const Meanwhile& meanwhile) {
    sim::Simulator& simulator = local.simulator;
    // Flashes, and what sorts and draws them.
    constexpr std::uint64_t kBytesAPixel = 160;
    if (!simulator.faults().empty()) {
        // What is stuck lights pixels that nobody asked for.
        pixels = sim::count_lit(simulator.built(), simulator.device().shown().page, simulator.faults());
    }
    if (const auto fits = check_memory(pixels * kBytesAPixel, "the light of " + thousands(pixels) + " pixels"); !fits) {
        if (png != nullptr || options.json || local.shutter) return tl::unexpected(fits.error());
        warn("the display shows the frame, but its light is not measured: " + fits.error().message);
        return std::optional<LightSeen>();
    }
    const DisplayDescription& display = simulator.built();
    LightSeen seen;
    sim::LightField light;
    if (local.shutter) {
        Expected<SeenInTime> in_time = local.shutter->close(simulator, now_ns, options, meanwhile);
        if (!in_time) return tl::unexpected(in_time.error());
        light = std::move(in_time->light);
        seen.in_time = std::move(*in_time);
    } else {
        light = simulator.light();
    }
    {
        const Progress progress("measuring the light");
        seen.statistics = sim::measure(display, light, simulator.device().status(now_ns));
    }
    if (png == nullptr) return std::optional(std::move(seen));
    const Progress progress("drawing the picture");
    sim::Picture picture;
    const sim::Framing framing = options.frame == "display" ? sim::Framing::Display : sim::Framing::Object;
    if (options.view == "orthographic") {
        constexpr std::uint32_t kSide = 480;
        picture = sim::render_orthographic(display, light, options.size ? options.size->width / 3 : kSide, framing);
    } else {
        sim::PictureOptions wanted;
        wanted.framing = framing;
        if (options.size) {
            wanted.width = options.size->width;
            wanted.height = options.size->height;
        }
        Expected<sim::Picture> drawn = sim::render_perspective(display, light, wanted);
        if (!drawn) return fail(drawn.error().message + "; --view orthographic needs no OpenGL");
        picture = std::move(*drawn);
    }
    if (const auto written = write_png(*png, picture.image); !written) return tl::unexpected(written.error());
    seen.picture_covered = picture.covered;
    return std::optional(std::move(seen));
}

Expected<Delivery> deliver(const DeliveryOptions& options, const transport::Address& address,
                           const DisplayDescription& display, std::span<const std::byte> frame, std::size_t pixels,
                           io::AtomicFile* png, sim::RecordingWriter* recording) {
    switch (address.kind) {
        case transport::AddressKind::Loopback: return show_in_process(options, display, frame, pixels, png, recording);
        case transport::AddressKind::Tcp: {
            Expected<UniqueLink> link = transport::connect_tcp(address.host, address.port);
            if (!link) return tl::unexpected(link.error());
            const UniqueLink seen = recorded(std::move(*link), recording, clock_ns);
            return send_over(seen.get(), options, display, frame);
        }
        case transport::AddressKind::File: {
            Expected<UniqueLink> link = transport::open_file_writer(address.path);
            if (!link) return tl::unexpected(link.error());
            const Link file = link->get();
            const UniqueLink seen = recorded(std::move(*link), recording, [] { return std::uint64_t{0}; });
            Expected<Delivery> delivery = send_over(seen.get(), options, display, frame);
            if (!delivery) return delivery;
            if (const auto kept = transport::commit_file(file); !kept) return tl::unexpected(kept.error());
            return delivery;
        }
    }
    return fail("unknown kind of address");
}

std::string light_json(const DeliveryOptions& options, const std::optional<LightSeen>& light) {
    if (!light) return "null";
    std::string object = sim::to_json(light->statistics);
    while (!object.ends_with('}')) object.pop_back();
    object.pop_back();
    return fmt::format("{}, \"in_time\": {}}}", object, in_time_json(options.simulation, light->in_time));
}

std::string picture_json(const DeliveryOptions& options, const std::optional<LightSeen>& light) {
    return fmt::format("\"picture\": {}, \"light\": {}", options.png.empty() ? "null" : json_string(options.png),
                       light_json(options, light));
}

}  // namespace xorvox::tools
