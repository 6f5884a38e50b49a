// A scanner of any kind on VirtualLines, with the chips that hang on its pins and a record of what they did.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "driver/device/scan/hub75_scan.h"
#include "driver/device/scan/matrix_scan.h"
#include "driver/device/scan/shift_register_scan.h"
#include "tests/catch.h"
#include "tests/unit/device/chips.h"
#include "transport/virtual_lines.h"

namespace xorvox::test {

/// From when to when something was lit.
struct Lit {
    std::uint64_t on_ns = 0;
    std::uint64_t off_ns = 0;
    int selected = 0;
    bool operator==(const Lit&) const = default;
};

/// Displays so small that each of their pins' edges can be looked at.
inline DisplayDescription small_hub75(PixelFormat format = PixelFormat::Rgb332) {
    DisplayDescription display;
    display.name = DisplayName("small hub75");
    display.kind = DisplayKind::RotatingPanel;
    display.format = format;
    display.slices = 3;
    display.cycles_per_second = 100.0;
    display.panel_count = 3;
    display.panels[0] = {.columns = 5, .rows = 8, .offset_mm = 9.0, .connector = 0, .chain_position = 1};
    display.panels[1] = {
        .columns = 5, .rows = 8, .offset_mm = 9.0, .angle_deg = 120.0, .connector = 0, .chain_position = 0};
    display.panels[2] = {.columns = 3, .rows = 16, .offset_mm = 9.0, .angle_deg = 240.0, .connector = 2};
    display.scan.driver = DriverChip::Hub75;
    display.scan.pixel_clock_hz = 9'000'000;
    display.scan.latch_ns = 70;
    display.scan.min_on_ns = 300;
    display.scan.rise_ns = 40;
    display.scan.fall_ns = 110;
    display.scan.row_groups = 2;
    display.scan.color_order = {'g', 'b', 'r'};
    return display;
}
inline DisplayDescription small_cube(PixelFormat format = PixelFormat::Mono2) {
    DisplayDescription display;
    display.name = DisplayName("small cube");
    display.format = format;
    display.slices = 3;
    display.cycles_per_second = 100.0;
    display.panels[0] = {.columns = 5, .rows = 2, .connector = 1};
    display.scan.driver = DriverChip::ShiftRegister595;
    display.scan.pixel_clock_hz = 7'000'000;
    display.scan.latch_ns = 90;
    display.scan.min_on_ns = 1000;
    display.scan.rise_ns = 50;
    display.scan.fall_ns = 60;
    return display;
}
inline DisplayDescription small_matrix(PixelFormat format = PixelFormat::Mono2) {
    DisplayDescription display;
    display.name = DisplayName("small matrix");
    display.kind = DisplayKind::RotatingPanel;
    display.format = format;
    display.slices = 3;
    display.cycles_per_second = 100.0;
    display.panel_count = 2;
    display.panels[0] = {.columns = 4, .rows = 6, .offset_mm = 1.0};
    display.panels[1] = {.columns = 3, .rows = 3, .offset_mm = 1.0, .angle_deg = 180.0};
    display.scan.min_on_ns = 500;
    display.scan.latch_ns = 30;
    display.scan.rise_ns = 20;
    display.scan.fall_ns = 50;
    display.scan.row_groups = 3;
    return display;
}
inline std::vector<DisplayDescription> small_displays() {
    return {small_hub75(), small_cube(), small_matrix()};
}

/// The lines, the chips behind them, and what was lit when; the scanner is made by ScanRig.
class Bench {
public:
    Bench(const DisplayDescription& display, LineMask used, LineMask safe, std::unique_ptr<Chips> chips)
        : display_(display), chips_(std::move(chips)) {
        lines.emplace(transport::VirtualLinesOptions{
            .outputs = used,
            .set_hz = 2 * display.scan.pixel_clock_hz,
            .safe_levels = safe,
            .observer = [this](std::uint64_t t, LineMask levels, LineMask changed) { see(t, levels, changed); }});
    }
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;
    ~Bench() { lines.reset(); }

    const Chips& chips() const { return *chips_; }

    struct Edge {
        std::uint64_t time_ns = 0;
        LineMask levels = 0;
        LineMask changed = 0;
    };
    std::vector<Edge> edges;
    std::vector<Lit> lights;  ///< Of the output, whatever stands on the columns. The last may still be on: off_ns = 0.
    std::vector<std::uint64_t> light_ns;  ///< Of each LED, as all_leds() has them.
    bool several = false;                 ///< Two rows were selected while the output was on.
    /// Called after each edge.
    std::function<void(const Edge&)> after_edge;
    std::optional<transport::VirtualLines> lines;  ///< Closes when it goes, and is seen closing.

    static std::vector<Led> all_leds(const DisplayDescription& display) {
        std::vector<Led> leds;
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            for (std::uint32_t r = 0; r < display.panels[p].rows; ++r) {
                for (std::uint32_t c = 0; c < display.panels[p].columns; ++c) {
                    for (std::uint32_t k = 0; k < channel_count(display.format); ++k) leds.push_back({p, r, c, k});
                }
            }
        }
        return leds;
    }

private:
    void see(std::uint64_t time_ns, LineMask levels, LineMask changed) {
        if (leds_.empty()) {
            leds_ = all_leds(display_);
            light_ns.assign(leds_.size(), 0);
        }
        if (chips_->output_on() && !edges.empty()) {
            for (std::size_t i = 0; i < leds_.size(); ++i) {
                if (chips_->lit(leds_[i])) light_ns[i] += time_ns - edges.back().time_ns;
            }
        }
        const bool was_on = !edges.empty() && chips_->output_on();
        chips_->see(levels, changed);
        edges.push_back({time_ns, levels, changed});
        if (was_on && !chips_->output_on()) lights.back().off_ns = time_ns;
        if (!was_on && chips_->output_on()) lights.push_back({time_ns, 0, chips_->selected()});
        if (chips_->output_on() && chips_->selected() == -2) several = true;
        if (after_edge) after_edge(edges.back());
    }

    DisplayDescription display_;
    std::unique_ptr<Chips> chips_;
    std::vector<Led> leds_;
};

class ScanRig {
public:
    explicit ScanRig(const DisplayDescription& of) : display(of) {
        switch (display.scan.driver) {
            case DriverChip::Hub75: make<device::Hub75Scan, Hub75Chips>(device::hub75_config(display)); break;
            case DriverChip::ShiftRegister595:
                make<device::ShiftRegisterScan, ShiftRegisterChips>(device::shift_register_config(display));
                break;
            default: make<device::MatrixScan, MatrixChips>(device::matrix_config(display)); break;
        }
    }

    DisplayDescription display;
    std::unique_ptr<Bench> bench;
    device::ModulationConfig modulation;

    std::function<Status(const device::ScanOrder&, std::uint64_t)> begin;
    std::function<Status()> step;
    std::function<bool()> finished;
    std::function<Status()> blank;
    std::function<Status(Lines)> init;
    std::function<void(Lines)> replace_lines;
    std::function<void()> destroy;  ///< The scanner alone.

    transport::VirtualLines& lines() { return *bench->lines; }

    /// All of an order, step by step.
    Status scan(const device::ScanOrder& order, std::uint64_t available_ns) {
        Status status = begin(order, available_ns);
        while (status == Status::Ok && !finished()) status = step();
        return status;
    }

private:
    template <class Scanner, class Model, class Config>
    void make(const Config& made) {
        struct Holder {
            Config config;
            std::vector<std::uint64_t> buffer;
            std::optional<Scanner> scanner;
        };
        const auto holder = std::make_shared<Holder>();
        holder->config = made;
        holder->buffer.resize(scan_buffer_words(made));
        holder->scanner.emplace();
        modulation = made.scan.modulation;
        bench = std::make_unique<Bench>(display, made.scan.used, safe_levels(made.pins),
                                        std::make_unique<Model>(display, made.pins));
        init = [holder](Lines other) { return holder->scanner->init(holder->config, other, holder->buffer); };
        replace_lines = [begins = init](Lines other) { REQUIRE(begins(other) == Status::Ok); };
        replace_lines(lines().lines());
        begin = [holder](const device::ScanOrder& order, std::uint64_t ns) {
            return holder->scanner->begin(order, ns);
        };
        step = [holder] { return holder->scanner->step(); };
        finished = [holder] { return holder->scanner->finished(); };
        blank = [holder] { return holder->scanner->blank(); };
        destroy = [holder] { holder->scanner.reset(); };
    }
};

inline std::vector<std::byte> random_slice(const DisplayDescription& display, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<std::byte> bytes(slice_bytes(display));
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    return bytes;
}

inline device::ScanOrder lit_order(std::span<const std::byte> bytes, std::uint32_t slice = 1,
                                   std::uint8_t brightness = 255) {
    device::ScanOrder order;
    order.number = 1;
    order.dark = device::Dark::No;
    order.slice = slice;
    order.brightness = brightness;
    order.bytes = bytes;
    return order;
}

}  // namespace xorvox::test
