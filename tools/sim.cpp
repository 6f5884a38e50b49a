// sim: a display in a program of its own, for clients over tcp. One at a time; the picture outlives its client.
#include <cstdio>
#include <optional>
#include <random>
#include <utility>

#include <fmt/format.h>

#include "driver/display/toml.h"
#include "driver/host/faults.h"
#include "sim/optics.h"
#include "sim/recording/record_link.h"
#include "sim/simulator.h"
#include "sim/statistics.h"
#include "tools/clock.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/placement.h"
#include "tools/shutter.h"
#include "tools/simulation.h"
#include "tools/stop.h"
#include "transport/address.h"
#include "transport/tcp.h"

namespace xorvox::tools {
namespace {

/// A client that says nothing for so long makes room for the next one. A host that is there sends twice a second.
constexpr std::uint64_t kPatience_ns = 5'000'000'000;

const char* why_dark(const wire::DeviceStatus& status) {
    if (status.fault == wire::Fault::SilentHost) return "the host fell silent";
    return status.fault == wire::Fault::None ? "blanked" : host::describe(status.fault);
}

/// Lines for people, or objects for programs, at once: a reader at a pipe sees them when they happen.
class Events {
public:
    Events(const DisplayDescription& display, bool json) : display_(display), json_(json) {}

    void listening(const std::string& address) {
        json_ ? fmt::print("{{\"event\": \"listening\", \"address\": {}, \"display\": {}}}\n", json_string(address),
                           json_string(display_.name.view()))
              : fmt::print("{}: listening on {}\n", display_.name.view(), address);
        std::fflush(stdout);
    }
    void client(bool arrived) {
        const char* what = arrived ? "connected" : "disconnected";
        json_ ? fmt::print("{{\"event\": \"{}\"}}\n", what) : fmt::print("client {}\n", what);
        std::fflush(stdout);
    }
    void seen(const SimulationOptions& options, const SeenInTime& seen) {
        json_ ? fmt::print("{{\"event\": \"seen\", \"in_time\": {}}}\n", in_time_json(options, seen))
              : print_in_time(options, seen);
        std::fflush(stdout);
    }
    void ended(const sim::Timing& timing) {
        std::string object = sim::to_json(timing);
        while (object.ends_with('\n')) object.pop_back();
        json_ ? fmt::print("{{\"event\": \"ended\", \"timing\": {}}}\n", object) : print_timing(timing);
    }
    /// Says what is shown when that has changed since the last call.
    void shown(const sim::Simulator& simulator, std::uint64_t now_ns) {
        const wire::DeviceStatus status = simulator.device().status(now_ns);
        const device::Shown shown = simulator.device().shown();
        // A new frame never comes into the page of the one before.
        if (shown.page.data() == last_page_ && shown.brightness == last_brightness_) return;
        last_page_ = shown.page.data();
        last_brightness_ = shown.brightness;
        if (json_) {
            std::string object = sim::to_json(sim::measure(display_, simulator.light(), status));
            while (object.ends_with('\n')) object.pop_back();
            fmt::print("{{\"event\": \"shown\", \"light\": {}}}\n", object);
        } else if (status.blank != 0) {
            fmt::print("dark: {}\n", why_dark(status));
        } else {
            fmt::print("frame {}: {} pixels lit\n", status.shown_frame,
                       thousands(sim::count_lit(display_, shown.page, simulator.faults())));
        }
        std::fflush(stdout);
    }

private:
    const DisplayDescription& display_;
    bool json_;
    const std::byte* last_page_ = nullptr;  ///< Null while dark.
    std::uint8_t last_brightness_ = 255;
};

std::int64_t until_ns(std::uint64_t deadline_ns, std::uint64_t now_ns) {
    return deadline_ns > now_ns ? static_cast<std::int64_t>(deadline_ns - now_ns) : 0;
}

}  // namespace

Expected<void> sim(const SimOptions& options) {
    const Expected<transport::Address> address = transport::parse_address(options.listen);
    if (!address) return fail("--listen: " + address.error().message);
    if (address->kind != transport::AddressKind::Tcp) {
        return fail(fmt::format("--listen {}: a simulated display is reached by tcp; use tcp:PORT", options.listen));
    }
    const Expected<DisplayFile> display = load_display(options.display);
    if (!display) return tl::unexpected(display.error());
    if (const auto fits = check_display_fits(*display); !fits) return fits;
    // As a device draws one at each start: hosts that come again see that this is another run.
    sim::SimulatorOptions simulated{.boot_nonce = std::random_device{}()};
    Expected<sim::Conditions> conditions = read_conditions(options.simulation);
    if (!conditions) return tl::unexpected(conditions.error());
    if (const auto possible = check_rotor(*conditions, *display); !possible) return possible;
    simulated.faults = std::move(conditions->faults);
    simulated.rotor = conditions->rotor;
    simulated.keeps_time = true;
    if (const auto possible = Shutter::check(options.simulation); !possible) return possible;
    DeliveryOptions looks;
    looks.simulation = options.simulation;
    looks.json = options.json;
    std::optional<Shutter> shutter;
    if (Shutter::is_wanted(options.simulation, {})) {
        Expected<Shutter> made = Shutter::make(options.simulation);
        if (!made) return tl::unexpected(made.error());
        shutter.emplace(std::move(*made));
        simulated.fidelity = Shutter::fidelity(options.simulation);
    }
    Expected<sim::Simulator> simulator = sim::Simulator::make(*display, Link{}, simulated);
    if (!simulator) return tl::unexpected(simulator.error());
    Expected<transport::TcpListener> listener = transport::TcpListener::listen(address->port, address->host);
    if (!listener) return tl::unexpected(listener.error());

    std::optional<sim::RecordingWriter> recording;
    if (!options.record.empty()) {
        Expected<sim::RecordingWriter> writer = sim::RecordingWriter::create(options.record, *display);
        if (!writer) return tl::unexpected(writer.error());
        recording = std::move(*writer);
    }

    stop_on_signals();
    Events events(*display, options.json);
    transport::Address actual = *address;
    actual.port = listener->port();
    events.listening(transport::to_string(actual));

    if (shutter) shutter->open(*simulator, options.simulation);
    UniqueLink client;
    // The display is switched on now.
    const auto time_ns = [begin_ns = clock_ns()] { return clock_ns() - begin_ns; };
    std::uint64_t heard_ns = 0;
    while (!asked_to_stop()) {
        const std::uint64_t now_ns = time_ns();
        if (!client && listener->accept(client) == Status::Ok) {
            events.client(true);
            if (recording) {
                client = sim::record_link(std::move(client), sim::LinkEnd::Device, *recording, time_ns);
            }
            simulator->set_link(client.get());
            heard_ns = now_ns;
        }
        const Status moved = simulator->poll(now_ns);
        events.shown(*simulator, now_ns);
        if (shutter && shutter->is_over(now_ns)) {
            const Expected<SeenInTime> seen = shutter->close(*simulator, now_ns, looks, {});
            if (!seen) return tl::unexpected(seen.error());
            events.seen(options.simulation, *seen);
            shutter.reset();
        }
        if (moved == Status::Ok) heard_ns = now_ns;
        if (client && (moved == Status::Closed || now_ns - heard_ns > kPatience_ns)) {
            simulator->set_link(Link{});
            client.reset();
            events.client(false);
            continue;
        }
        if (moved == Status::Ok) continue;
        const std::int64_t idle_ns = until_ns(simulator->next_boundary_ns(), time_ns());
        // Ok, Timeout or a signal: the loop looks at everything again.
        if (client) {
            (void)client->wait(simulator->device().events(), idle_ns);
        } else {
            (void)listener->wait(idle_ns);
        }
    }
    simulator->set_link(Link{});
    client.reset();
    events.ended(simulator->timing().timing());
    return recording ? recording->commit() : Expected<void>();
}

}  // namespace xorvox::tools
