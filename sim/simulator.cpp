#include "sim/simulator.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "driver/device/config.h"
#include "driver/device/scan_control.h"
#include "driver/display/toml.h"
#include "sim/clockwork.h"
#include "sim/link_tap.h"
#include "sim/lossy_link.h"
#include "sim/scan_out.h"
#include "sim/wiring.h"

namespace xorvox::sim {
namespace {

/// How the frames of `built` differ from those of `display`; empty: not at all.
std::string other_layout(const DisplayDescription& display, const DisplayDescription& built) {
    const auto differ = [](std::string_view what, auto from, auto to) {
        return fmt::format("{} {} instead of {}", what, to, from);
    };
    if (built.kind != display.kind) return "another kind of display";
    if (built.format != display.format) return differ("format", to_string(display.format), to_string(built.format));
    if (built.slices != display.slices) return differ("slices", display.slices, built.slices);
    if (built.panel_count != display.panel_count) return differ("panels", display.panel_count, built.panel_count);
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& from = display.panels[p];
        const Panel& to = built.panels[p];
        const std::string of = fmt::format("panel {}: ", p);
        if (to.columns != from.columns) return of + differ("columns", from.columns, to.columns);
        if (to.rows != from.rows) return of + differ("rows", from.rows, to.rows);
    }
    return {};
}

Expected<void> check_built(const DisplayDescription& display, const DisplayDescription& built) {
    if (const Expected<void> valid = validate_display(built); !valid) return valid;
    const std::string difference = other_layout(display, built);
    if (difference.empty()) return {};
    return fail(
        fmt::format("{} cannot really be built like {}: {}; they must agree in kind, format, slices, and the columns "
                    "and rows of each panel, so that a frame fits both",
                    display.name.view(), built.name.view(), difference));
}

/// By how many cycles the display is further than the device takes it to be.
double phase_ahead(const DisplayDescription& display, const DisplayDescription& built) {
    return std::remainder(built.sync.index_phase - display.sync.index_phase, 1.0);
}

/// By how many slices light comes late, in whole ones, where the index mark is not at the phase that the device goes
/// by.
std::int32_t late_slices(const DisplayDescription& display, const DisplayDescription& built) {
    const double cycles = phase_ahead(display, built);
    const bool sweeps = display.kind == DisplayKind::SweptPlane;
    const double lit = sweeps ? 0.5 * (1.0 - 2.0 * display.motion.dead_zone) : 1.0;
    return static_cast<std::int32_t>(std::lround(cycles * display.slices / lit));
}

}  // namespace

struct Simulator::Impl {
    DisplayDescription display;
    DisplayDescription built;
    Faults faults;
    LossyLink wire;
    std::int32_t late_slices = 0;
    std::vector<std::byte> pages;
    std::vector<std::byte> packet;
    device::Device device;
    device::ScanControl control;
    TimingWatch timing;
    LinkTap tap{timing};
    bool keeps_time = false;
    std::optional<Clockwork> clockwork;
    Fidelity fidelity = Fidelity::Strobes;
    StrobeSink strobe_sink;
    PinSink pin_sink;

    /// What the device is given of `link`.
    Link plugged(Link link) {
        const Link what_arrives = wire.over(link, faults);
        return keeps_time ? tap.over(what_arrives) : what_arrives;
    }

    void scan_anew() {
        const bool edges = fidelity == Fidelity::Edges;
        std::unique_ptr<ScanOut> scan;
        if (strobe_sink || (edges && pin_sink)) {
            StrobeSink sink = with_wiring_faults(
                display, faults, strobe_sink ? strobe_sink : [](const Strobe&) {});
            scan = edges ? make_edge_scan(display, std::move(sink), pin_sink).value()
                         : make_strobe_scan(display, std::move(sink));
        }
        clockwork->set_scan(std::move(scan));
    }
};

Simulator::Simulator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;
Simulator::~Simulator() = default;

Expected<Simulator> Simulator::make(const DisplayDescription& display, Link link, const SimulatorOptions& options) {
    if (const Expected<void> valid = validate_display(display); !valid) return tl::unexpected(valid.error());
    const DisplayDescription& built = options.built ? *options.built : display;
    if (const Expected<void> same = check_built(display, built); !same) return tl::unexpected(same.error());
    if (const Expected<void> possible = check_faults(built, options.faults); !possible) {
        return tl::unexpected(possible.error());
    }
    if (options.fidelity == Fidelity::Edges) {
        if (const auto scan = make_edge_scan(display, [](const Strobe&) {}, {}); !scan) {
            return tl::unexpected(scan.error());
        }
    }
    auto impl = std::make_unique<Impl>();
    impl->display = display;
    impl->built = built;
    impl->built.motion.dead_zone = display.motion.dead_zone;
    impl->built.motion.both_ways = display.motion.both_ways;
    impl->faults = options.faults;
    impl->late_slices = late_slices(display, built);
    impl->keeps_time = options.keeps_time;
    impl->fidelity = options.fidelity;
    impl->pages.resize(std::size_t{options.pages} * frame_bytes(display));
    impl->packet.resize(options.max_packet_bytes);

    device::DeviceConfig config;
    config.display = &impl->display;
    config.serial = DisplayName("simulator");
    config.boot_nonce = options.boot_nonce;
    config.link = impl->plugged(link);
    config.pages = impl->pages;
    config.page_count = options.pages;
    config.packet = impl->packet;
    if (const Status status = impl->device.init(config, 0); status != Status::Ok) {
        return fail(fmt::format(
            "cannot simulate display {}: {} ({} pages, allowed 2 to {}; packets of {} bytes, allowed {} to {})",
            display.name.view(), to_string(status), options.pages, device::kMaxPages, options.max_packet_bytes,
            wire::kMinPacketBytes, wire::kMaxPacketBytes));
    }
    // Without conditions the motor keeps to the device's clock: cycle 0 begins at time 0, and the others where they
    // should.
    device::ScanControlConfig scan = device::scan_control_config(impl->display);
    if (!options.rotor) scan.rotation.source = IndexSource::None;
    if (const Status status = impl->control.init(scan, impl->device, 0); status != Status::Ok) {
        return fail(fmt::format("cannot simulate display {}: its scan-out cannot be computed in integers ({})",
                                display.name.view(), to_string(status)));
    }
    impl->clockwork.emplace(impl->display, impl->device, impl->control, options.rotor ? &*options.rotor : nullptr,
                            options.keeps_time ? &impl->timing : nullptr);
    return Simulator(std::move(impl));
}

Status Simulator::poll(std::uint64_t now_ns) {
    impl_->clockwork->run_until(now_ns);
    impl_->tap.set_time(now_ns);
    const Status status = impl_->device.poll(now_ns);
    impl_->clockwork->device_moved();
    return status;
}

void Simulator::watch(StrobeSink sink) {
    impl_->strobe_sink = std::move(sink);
    impl_->scan_anew();
}

void Simulator::watch_pins(PinSink sink) {
    impl_->pin_sink = std::move(sink);
    impl_->scan_anew();
}

double Simulator::cycles_at(std::uint64_t time_ns) const {
    return impl_->clockwork->cycles_at(time_ns) + phase_ahead(impl_->display, impl_->built);
}

std::uint64_t Simulator::cycle_begin_ns() const {
    return impl_->clockwork->cycle_begin_ns();
}

const TimingWatch& Simulator::timing() const {
    return impl_->timing;
}

void Simulator::set_link(Link link) {
    impl_->device.set_link(impl_->plugged(link));
}

std::uint64_t Simulator::next_boundary_ns() const {
    return impl_->clockwork->next_ns();
}

LightField Simulator::light() const {
    const device::Shown shown = impl_->device.shown();
    const auto expose_late = [&](std::int32_t slices) {
        Faults faults = impl_->faults;
        if (slices != 0) faults.list.push_back({.kind = FaultKind::Phase, .amount = static_cast<double>(slices)});
        return expose(impl_->built, shown.page, shown.brightness, faults);
    };
    LightField field = expose_late(impl_->late_slices);
    if (impl_->late_slices != 0 && impl_->display.motion.both_ways) {
        // A plane that is too high on its way up is as much too low on its way down.
        const LightField down = expose_late(-impl_->late_slices);
        field.flashes.insert(field.flashes.end(), down.flashes.begin(), down.flashes.end());
    }
    return field;
}

const device::Device& Simulator::device() const {
    return impl_->device;
}

const DisplayDescription& Simulator::display() const {
    return impl_->display;
}

const DisplayDescription& Simulator::built() const {
    return impl_->built;
}

const Faults& Simulator::faults() const {
    return impl_->faults;
}

}  // namespace xorvox::sim
