// The two fidelities give the same light: strobes from orders, and strobes from pins.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "driver/device/scan/modulation.h"
#include "driver/display/timing.h"
#include "driver/display/toml.h"
#include "sim/exposure.h"
#include "sim/make_sim.h"
#include "sim/scan_out.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"
#include "tests/unit/sim/orders.h"
#include "tests/unit/sim/pins.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

/// What is compared of a strobe: everything, its rows as bytes.
struct Compared {
    std::uint64_t on_ns = 0;
    std::uint64_t off_ns = 0;
    std::uint32_t row_group = 0;
    std::uint32_t plane = 0;
    std::uint32_t slice = 0;
    std::uint32_t frame = 0;
    std::vector<std::byte> bits;

    bool operator==(const Compared&) const = default;
};

Compared compared(const DisplayDescription& display, const sim::Strobe& strobe) {
    const bool all_rows = strobe.row_group == sim::Strobe::kAllRows;
    Compared seen{
        strobe.on_ns, strobe.off_ns, all_rows ? 0 : strobe.row_group, strobe.plane, strobe.slice, strobe.frame, {}};
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        for (std::uint32_t row = seen.row_group; row < panel.rows; row += display.scan.row_groups) {
            for (std::uint32_t channel = 0; channel < channel_count(display.format); ++channel) {
                const std::byte* bits = strobe.panels[p].at(row, channel);
                seen.bits.insert(seen.bits.end(), bits, bits + (panel.columns + 7) / 8);
            }
        }
    }
    return seen;
}

/// Both fidelities of one display, which are given the same orders.
class Both {
public:
    explicit Both(const DisplayDescription& display)
        : display_(display),
          seen_light_(display, display, {}, 0, std::uint64_t{1} << 62),
          pin_light_(display, display, {}, 0, std::uint64_t{1} << 62),
          strobes_(sim::make_strobe_scan(display, [this](const sim::Strobe& strobe) {
              by_orders_.push_back(compared(display_, strobe));
              seen_light_.add(strobe);
          })) {
        auto edges = sim::make_edge_scan(display,
                                         [this](const sim::Strobe& strobe) {
                                             by_pins_.push_back(compared(display_, strobe));
                                             pin_light_.add(strobe);
                                         },
                                         {});
        REQUIRE(edges);
        edges_ = std::move(*edges);
    }

    void run_until(std::uint64_t now_ns) {
        strobes_->run_until(now_ns);
        edges_->run_until(now_ns);
    }
    void begin(const device::ScanOrder& order, std::uint32_t frame, std::uint64_t now_ns) {
        run_until(now_ns);
        strobes_->begin(order, frame, now_ns);
        edges_->begin(order, frame, now_ns);
        compare();
    }
    /// Compares all strobes since the last time.
    void compare() {
        count_ += by_orders_.size();
        const auto [order, pin] = std::ranges::mismatch(by_orders_, by_pins_);
        if (order != by_orders_.end() || pin != by_pins_.end()) {
            const auto text = [](const auto& at, const auto& list) {
                if (at == list.end()) return std::string("none");
                const Compared& strobe = *at;
                return fmt::format("{} … {} ns, row group {}, plane {}, slice {}, frame {}", strobe.on_ns,
                                   strobe.off_ns, strobe.row_group, strobe.plane, strobe.slice, strobe.frame);
            };
            const bool bits = order != by_orders_.end() && pin != by_pins_.end() && order->bits != pin->bits;
            FAIL(fmt::format("{}: strobe {} differs{}: {} by orders, {} by pins", display_.name.view(),
                             order - by_orders_.begin(), bits ? " in its bits" : "", text(order, by_orders_),
                             text(pin, by_pins_)));
        }
        by_orders_.clear();
        by_pins_.clear();
    }
    void compare_light() const {
        const sim::LightField seen = seen_light_.light();
        const sim::LightField by_pins = pin_light_.light();
        REQUIRE(!seen.flashes.empty());
        REQUIRE(seen.flashes.size() == by_pins.flashes.size());
        CHECK(seen.measured == by_pins.measured);
        CHECK(std::ranges::equal(seen.flashes, by_pins.flashes, [](const sim::Flash& a, const sim::Flash& b) {
            return a.place_mm == b.place_mm && a.time == b.time;
        }));
    }
    std::size_t count() const { return count_; }

private:
    DisplayDescription display_;
    sim::Exposure seen_light_;
    sim::Exposure pin_light_;
    std::vector<Compared> by_orders_;
    std::vector<Compared> by_pins_;
    std::size_t count_ = 0;
    std::unique_ptr<sim::ScanOut> strobes_;
    std::unique_ptr<sim::ScanOut> edges_;
};

/// Random frames for `slices` slices, one after the other: whole ones, some that are cut by the next, some that have
/// little time or much of it, some dark time, every brightness, and, of half turns, every second turn mirrored. Gives
/// the number of strobes that were equal.
std::size_t agree(const DisplayDescription& display, std::uint32_t slices, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto one_in = [&](std::uint32_t n) { return random() % n == 0; };
    Both both(display);
    const auto slice_ns = static_cast<std::uint64_t>(slice_time_ns(display));
    const bool half_turns = display.kind == DisplayKind::RotatingPanel && display.sweep_deg < 270.0;
    std::vector<std::byte> page;
    std::uint64_t now_ns = 12'345;
    for (std::uint32_t n = 0; n < slices; ++n) {
        const std::uint32_t cycle = n / display.slices;
        if (n % display.slices == 0) page = random_page(display, static_cast<std::uint32_t>(random()));
        std::uint64_t lasts_ns = slice_ns;
        if (one_in(5)) lasts_ns = slice_ns * (random() % 100 + 60) / 100 + random() % 100;
        device::ScanOrder order = lit_order(display, page, n % display.slices, now_ns, now_ns + lasts_ns);
        order.mirrored = half_turns && cycle % 2 == 1;
        if (one_in(3)) order.brightness = static_cast<std::uint8_t>(random());
        both.begin(order, cycle + 1, now_ns);
        if (one_in(6)) lasts_ns = random() % lasts_ns;
        now_ns += lasts_ns;
        if (one_in(10)) {
            both.begin(dark_order(now_ns), 0, now_ns);
            now_ns += random() % slice_ns;
        }
    }
    both.begin(dark_order(now_ns), 0, now_ns);
    both.run_until(now_ns + 2 * slice_ns);
    both.compare();
    both.compare_light();
    return both.count();
}

DisplayDescription cube(PixelFormat format) {
    DisplayDescription display = stack_of(5, 3, 4, format);
    display.name = DisplayName("cube");
    display.scan.driver = DriverChip::ShiftRegister595;
    display.scan.pixel_clock_hz = 7'000'000;  // 142.857 ns.
    display.scan.latch_ns = 150;
    display.scan.min_on_ns = 2'000;
    display.scan.rise_ns = 70;
    display.scan.fall_ns = 130;
    return display;
}

/// Two panels of different sizes in a chain, and one on a connector of its own.
DisplayDescription chained(PixelFormat format) {
    DisplayDescription display = rotor_of(12, 16, 9, format, 3);
    display.name = DisplayName("chained");
    for (std::uint32_t p = 0; p < 3; ++p) {
        display.panels[p].offset_mm = 30.0;
        display.panels[p].angle_deg = 120.0 * p;
    }
    display.panels[0].columns = 19;
    display.panels[0].chain_position = 1;
    display.panels[2].columns = 7;
    display.panels[2].rows = 8;
    display.panels[2].connector = 3;
    display.scan.driver = DriverChip::Hub75;
    display.scan.row_groups = 4;
    display.scan.pixel_clock_hz = 33'000'000;
    display.scan.latch_ns = 100;
    display.scan.min_on_ns = 200;
    display.scan.rise_ns = 50;
    display.scan.fall_ns = 40;
    return display;
}

DisplayDescription matrix(PixelFormat format) {
    DisplayDescription display = rotor_of(3, 8, 7, format);
    display.name = DisplayName("matrix");
    display.scan.row_groups = 4;
    display.scan.min_on_ns = 20'000;
    display.scan.latch_ns = 500;
    display.scan.fall_ns = 300;
    return display;
}

}  // namespace

TEST_CASE("edges and strobes agree on every preset that has pins", "[sim][fidelities]") {
    std::vector<std::string_view> with_pins;
    for (const Preset& preset : presets()) {
        const auto display = load_display(std::string(preset.name));
        REQUIRE(display);
        if (const auto edges = sim::make_edge_scan(*display, {}, {}); !edges) {
            std::printf("no pins: %s\n", edges.error().message.c_str());
            continue;
        }
        const bool small = display->panels[0].columns < 100;
        const std::size_t strobes = agree(*display, (small ? 3 : 1) * display->slices, 1);
        std::printf("%s: %zu strobes are equal\n", std::string(preset.name).c_str(), strobes);
        CHECK(strobes >= display->slices);
        with_pins.push_back(preset.name);
    }
    CHECK(with_pins == std::vector<std::string_view>{"candle", "cube8-595", "rotovox", "vortex"});
}

TEST_CASE("edges and strobes agree on cubes of every format and order of bits", "[sim][fidelities]") {
    for (const PixelFormat format : kPixelFormats) {
        for (const bool msb_first : {true, false}) {
            for (const bool layers_first : {true, false}) {
                DisplayDescription display = cube(format);
                display.scan.msb_first = msb_first;
                display.scan.layers_first = layers_first;
                if (!is_mono(format)) display.scan.color_order = {'b', 'r', 'g'};
                CHECK(agree(display, 60, 3) >= 60);
            }
        }
    }
}

TEST_CASE("edges and strobes agree on hub75 panels of every format, in chains", "[sim][fidelities]") {
    for (const PixelFormat format : kPixelFormats) CHECK(agree(chained(format), 40, 4) > 100);
}

TEST_CASE("edges and strobes agree whatever the rows and colours are", "[sim][fidelities]") {
    for (const int groups : {1, 2, 4}) {
        DisplayDescription display = chained(PixelFormat::Rgb565);
        display.scan.row_groups = static_cast<std::uint16_t>(groups);
        CHECK(agree(display, 30, 5) > 30);
    }
    DisplayDescription three = chained(PixelFormat::Mono4);
    for (std::uint32_t p = 0; p < 3; ++p) three.panels[p].rows = 12;
    three.scan.row_groups = 3;
    CHECK(agree(three, 30, 6) > 100);
    std::string order = "bgr";
    do {
        DisplayDescription display = chained(PixelFormat::Rgb332);
        std::ranges::copy(order, display.scan.color_order.begin());
        display.scan.bit_planes = 2;
        CHECK(agree(display, 10, 7) > 40);
    } while (std::ranges::prev_permutation(order).found);
}

TEST_CASE("edges and strobes agree on half turns, every second one mirrored", "[sim][fidelities]") {
    DisplayDescription display = rotor_of(13, 8, 5, PixelFormat::Rgb111, 1);
    display.name = DisplayName("half-turns");
    display.sweep_deg = 180.0;
    display.panels[0].offset_mm = 0.0;
    display.scan.driver = DriverChip::Hub75;
    display.scan.row_groups = 2;
    display.scan.pixel_clock_hz = 5'000'000;
    display.scan.latch_ns = 100;
    CHECK(agree(display, 40, 8) > 60);
}

TEST_CASE("edges and strobes agree at whatever moment an order cuts another", "[sim][fidelities]") {
    for (DisplayDescription display :
         {cube(PixelFormat::Mono2), chained(PixelFormat::Rgb111), matrix(PixelFormat::Mono1)}) {
        display.scan.min_on_ns = 0;
        const device::ModulationConfig config = device::modulation_config(display);
        const std::uint64_t slice_ns = device::modulate(config, 0).total_ns() * 2;
        const std::uint64_t slots_ns = device::modulate(config, slice_ns).slot_ns(0) * 2;
        const std::vector<std::byte> page = random_page(display, 12);
        Both both(display);
        std::uint64_t now_ns = 0;
        for (std::uint64_t cut_ns = 0; cut_ns < config.shift_ns + slots_ns; cut_ns += 17) {
            both.begin(lit_order(display, page, 0, now_ns, now_ns + slice_ns), 1, now_ns);
            now_ns += cut_ns;
            both.begin(lit_order(display, page, 1, now_ns, now_ns + slice_ns), 1, now_ns);
            now_ns += slice_ns;
        }
        both.run_until(now_ns);
        both.compare();
        CHECK(both.count() > 100);
    }
}

TEST_CASE("edges and strobes agree on matrices", "[sim][fidelities]") {
    for (const PixelFormat format :
         {PixelFormat::Mono1, PixelFormat::Mono4, PixelFormat::Rgb111, PixelFormat::Rgb888}) {
        CHECK(agree(matrix(format), 40, 9) > 100);
    }
}

TEST_CASE("edges and strobes agree where the pixel clock is not known", "[sim][fidelities]") {
    for (DisplayDescription display : {cube(PixelFormat::Mono4), chained(PixelFormat::Rgb888)}) {
        display.scan.pixel_clock_hz = 0;
        CHECK(agree(display, 30, 10) > 30);
    }
}

TEST_CASE("edges and strobes agree on a swept plane", "[sim][fidelities]") {
    DisplayDescription display = swept_of(16, 8, 10, MotionProfile::Sine, PixelFormat::Rgb332);
    display.motion.dead_zone = 0.1;
    display.scan = chained(PixelFormat::Rgb332).scan;
    CHECK(agree(display, 40, 11) > 100);
}

TEST_CASE("edges and strobes agree on what the whole simulator shows, however its rotor turns", "[sim][fidelities]") {
    const auto candle = load_display("candle");
    REQUIRE(candle);
    DisplayDescription half_turns = rotor_of(13, 8, 5, PixelFormat::Rgb111, 1);
    half_turns.sweep_deg = 180.0;
    half_turns.panels[0].offset_mm = 0.0;
    half_turns.scan = chained(PixelFormat::Rgb111).scan;
    half_turns.sync.index = IndexSource::Pulses;
    DisplayDescription rotor = chained(PixelFormat::Rgb332);
    rotor.sync.index = IndexSource::Pulses;
    struct Case {
        DisplayDescription display;
        sim::RotorConditions rotor;
    };
    for (const Case& one : {Case{*candle, {.jitter = 0.02}}, Case{rotor, {.missed = 0.1, .doubled = 0.1}},
                            Case{rotor, {.acceleration = -0.1, .stall_s = 0.9}}, Case{half_turns, {.speed = 1.1}}}) {
        const std::vector<std::byte> page = random_page(one.display, 13);
        std::vector<std::vector<Compared>> seen(2);
        for (const sim::Fidelity fidelity : {sim::Fidelity::Strobes, sim::Fidelity::Edges}) {
            auto rig = sim::make_sim().display(one.display).rotor(one.rotor).fidelity(fidelity).build();
            INFO((rig ? "" : rig.error().message));
            REQUIRE(rig);
            auto& list = seen[fidelity == sim::Fidelity::Edges ? 1 : 0];
            rig->watch([&](const sim::Strobe& strobe) { list.push_back(compared(one.display, strobe)); });
            REQUIRE(rig->show(page) != 0);
            rig->run_for(1'200'000'000);
        }
        CHECK(seen[0].size() > 200);
        CHECK(std::ranges::equal(seen[0], seen[1]));
    }
}
