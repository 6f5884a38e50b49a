// The device half's own scanners over lines without wires; models of the chips behind the lines say what is lit.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "driver/device/scan/hub75_scan.h"
#include "driver/device/scan/matrix_scan.h"
#include "driver/device/scan/modulation.h"
#include "driver/device/scan/pins.h"
#include "driver/device/scan/shift_register_scan.h"
#include "driver/display/names.h"
#include "sim/cube_595.h"
#include "sim/hub75_panels.h"
#include "sim/led_matrix.h"
#include "sim/scan_out.h"
#include "transport/virtual_lines.h"

namespace xorvox::sim {
namespace {

/// The scanner, pins and model of each driver that has pins.
struct Hub75 {
    using Scanner = device::Hub75Scan;
    using Model = Hub75Panels;
    device::Hub75Pins pins;

    auto config(const DisplayDescription& display) const { return device::hub75_config(display, pins); }
    auto name(const DisplayDescription&, std::uint32_t number) const { return device::pin_name(pins, number); }
};
struct ShiftRegister595 {
    using Scanner = device::ShiftRegisterScan;
    using Model = Cube595;
    device::ShiftRegisterPins pins;

    auto config(const DisplayDescription& display) const { return device::shift_register_config(display, pins); }
    auto name(const DisplayDescription&, std::uint32_t number) const { return device::pin_name(pins, number); }
};
struct Matrix {
    using Scanner = device::MatrixScan;
    using Model = LedMatrix;
    device::MatrixPins pins;

    auto config(const DisplayDescription& display) const { return device::matrix_config(display, pins); }
    auto name(const DisplayDescription& display, std::uint32_t number) const {
        return device::pin_name(pins, display.scan.row_groups, number);
    }
};

/// Slots tell which plane is lit: pins do not.
class Slots {
public:
    explicit Slots(const DisplayDescription& display) : config_(device::modulation_config(display)) {}

    void begin(std::uint64_t now_ns, std::uint64_t available_ns) {
        modulation_ = device::modulate(config_, available_ns);
        first_ns_ = now_ns + modulation_.first_ns();
        group_ns_ = 0;
        for (std::uint32_t plane = 0; plane < modulation_.planes; ++plane) group_ns_ += modulation_.slot_ns(plane);
    }
    std::uint32_t plane_at(std::uint64_t time_ns) const {
        if (time_ns < first_ns_ || group_ns_ == 0) return 0;
        std::uint64_t into_ns = (time_ns - first_ns_) % group_ns_;
        std::uint32_t plane = 0;
        for (; plane + 1 < modulation_.planes && into_ns >= modulation_.slot_ns(plane); ++plane) {
            into_ns -= modulation_.slot_ns(plane);
        }
        return plane;
    }

private:
    device::ModulationConfig config_;
    device::Modulation modulation_;
    std::uint64_t first_ns_ = 0;
    std::uint64_t group_ns_ = 0;
};

template <class Driver>
class EdgeScan final : public ScanOut {
public:
    EdgeScan(const DisplayDescription& display, StrobeSink sink, PinSink pins)
        : slots_(display),
          layers_on_pins_(display.kind == DisplayKind::StackedPlanes),
          sink_(std::move(sink)),
          pins_(std::move(pins)),
          model_(display, driver_.pins, [this](const Strobe& strobe) { give(strobe); }),
          config_(driver_.config(display)),
          buffer_(device::scan_buffer_words(config_)),
          lines_({.outputs = config_.scan.used,
                  .set_hz = 2 * display.scan.pixel_clock_hz,
                  .safe_levels = device::safe_levels(driver_.pins),
                  .observer = [this](std::uint64_t time_ns, LineMask levels, LineMask changed) {
                      see(time_ns, levels, changed);
                  }}) {
        lines_.limit(0);
    }
    EdgeScan(const EdgeScan&) = delete;
    EdgeScan& operator=(const EdgeScan&) = delete;
    ~EdgeScan() override { sees_ = false; }  // Lines that are closed are no light of an order.

    /// Ok, or what the scanner cannot do.
    Status init() { return scanner_.init(config_, lines_.lines(), buffer_); }

    void run_until(std::uint64_t now_ns) override {
        lines_.limit(now_ns);
        while (lines_.time_ns() <= now_ns && !scanner_.finished()) (void)scanner_.step();
        lines_.advance_to(now_ns);
    }

    void begin(const device::ScanOrder& order, std::uint32_t frame, std::uint64_t now_ns) override {
        run_until(now_ns);
        lines_.cut();
        const std::uint64_t available_ns = order.end_ns > now_ns ? order.end_ns - now_ns : 0;
        (void)scanner_.begin(order, available_ns);
        // What was lit has ended, and was given as the order's before.
        slice_ = order.slice;
        frame_ = frame;
        slots_.begin(now_ns, available_ns);
    }

private:
    void see(std::uint64_t time_ns, LineMask levels, LineMask changed) {
        if (!sees_) return;
        if (pins_) pins_(time_ns, levels, changed);
        model_.on_pins(time_ns, levels, changed);
    }
    void give(Strobe strobe) const {
        if (!layers_on_pins_) strobe.slice = slice_;
        strobe.frame = frame_;
        strobe.plane = slots_.plane_at(strobe.on_ns);
        if (sink_) sink_(strobe);
    }

    Driver driver_;
    Slots slots_;
    std::uint32_t slice_ = 0;
    std::uint32_t frame_ = 0;
    bool layers_on_pins_;
    bool sees_ = true;
    StrobeSink sink_;
    PinSink pins_;
    typename Driver::Model model_;
    typename Driver::Scanner::Config config_;
    std::vector<std::uint64_t> buffer_;
    transport::VirtualLines lines_;
    typename Driver::Scanner scanner_;
};

constexpr std::uint32_t kFastestClockHz = 500'000'000;

/// Why there are no pins of `display`; empty: there are.
std::string why_no_pins(const DisplayDescription& display) {
    const std::string_view driver = display::name_of(display::kDriverNames, display.scan.driver);
    const bool stands = display.kind == DisplayKind::StackedPlanes || display.kind == DisplayKind::FreePoints;
    if (display.light.response != Response::Linear) {
        return fmt::format("its response is \"{}\", which a controller of its own makes, and pins give linear light",
                           display::name_of(display::kResponseNames, display.light.response));
    }
    if (display.scan.pixel_clock_hz > kFastestClockHz) {
        return fmt::format("its pixel clock is {} Hz, and edges of more than {} Hz fall into one nanosecond",
                           display.scan.pixel_clock_hz, kFastestClockHz);
    }
    switch (display.scan.driver) {
        case DriverChip::Ws2812:
        case DriverChip::Apa102: return fmt::format("its LEDs are strings of {}, which keep their light", driver);
        case DriverChip::Dlp: return "its light is made by a projector";
        case DriverChip::Hub75:
            if (display.kind == DisplayKind::StackedPlanes && display.slices > 1) {
                return "it is a stack of hub75 panels, on which no pin selects the panel";
            }
            if (display.scan.row_groups > 32) {
                return fmt::format("it has {} row groups, and hub75 has address lines for 32", display.scan.row_groups);
            }
            return {};
        case DriverChip::ShiftRegister595:
            if (!stands) return "its 74hc595 are on a display that moves, and only those of cubes are known";
            if (display.scan.row_groups > 1) {
                return fmt::format("it has {} row groups, and a cube's 74hc595 light a whole layer",
                                   display.scan.row_groups);
            }
            return {};
        case DriverChip::Direct: break;
    }
    if (display.scan.row_groups == 1) return "every LED has its own wire, or how it is driven is not known";
    if (display.kind == DisplayKind::StackedPlanes && display.slices > 1) {
        return "it is a stack of LED matrices, on which no line selects the plane";
    }
    const std::uint64_t lines = display.scan.row_groups + device::matrix_columns(display);
    if (lines <= kMaxLines) return {};
    return fmt::format("its matrix has {} lines, and there are models of at most {}", lines, kMaxLines);
}

template <class Driver>
Expected<std::unique_ptr<ScanOut>> make(const DisplayDescription& display, StrobeSink sink, PinSink pins) {
    auto scan = std::make_unique<EdgeScan<Driver>>(display, std::move(sink), std::move(pins));
    if (const Status status = scan->init(); status != Status::Ok) {
        return fail(fmt::format("{}: its scanner cannot be started: {}", display.name.view(), to_string(status)));
    }
    return scan;
}

template <class Driver>
std::vector<std::string> names(const DisplayDescription& display) {
    const Driver driver;
    const LineMask used = driver.config(display).scan.used;
    std::vector<std::string> names(static_cast<std::size_t>(std::bit_width(used)));
    for (std::uint32_t i = 0; i < names.size(); ++i) {
        if ((used & line(i)) != 0) names[i] = driver.name(display, i).view();
    }
    return names;
}

}  // namespace

Expected<std::unique_ptr<ScanOut>> make_edge_scan(const DisplayDescription& display, StrobeSink sink, PinSink pins) {
    if (const std::string why = why_no_pins(display); !why.empty()) {
        return fail(fmt::format("{} has no pins that can be simulated: {}; use the fidelity \"strobes\"",
                                display.name.view(), why));
    }
    switch (display.scan.driver) {
        case DriverChip::Hub75: return make<Hub75>(display, std::move(sink), std::move(pins));
        case DriverChip::ShiftRegister595: return make<ShiftRegister595>(display, std::move(sink), std::move(pins));
        default: return make<Matrix>(display, std::move(sink), std::move(pins));
    }
}

std::vector<std::string> pin_names(const DisplayDescription& display) {
    if (!why_no_pins(display).empty()) return {};
    switch (display.scan.driver) {
        case DriverChip::Hub75: return names<Hub75>(display);
        case DriverChip::ShiftRegister595: return names<ShiftRegister595>(display);
        default: return names<Matrix>(display);
    }
}

}  // namespace xorvox::sim
