#include "sim/wiring.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <glm/common.hpp>

#include "driver/display/toml.h"
#include "sim/exposure.h"
#include "sim/scan_out.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"
#include "tests/unit/sim/perfect.h"

namespace xorvox {
namespace {

using namespace test;

/// Slice, panel, row and column of an LED, and its code.
using Codes = std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t>;

sim::Faults with(std::initializer_list<std::string_view> texts) {
    sim::Faults faults;
    for (const std::string_view text : texts) faults.list.push_back(sim::parse_fault(text).value());
    return faults;
}

Codes shown(const DisplayDescription& display, std::span<const std::byte> page, const sim::Faults& faults) {
    Codes codes;
    sim::Wiring(display, faults)
        .for_each_row(page, [&](std::uint32_t slice, std::uint32_t p, std::uint32_t row, auto bytes) {
            sim::for_each_lit(bytes, display.panels[p].columns, bits_per_pixel(display.format), 0xffffffff,
                              [&](std::uint32_t column, std::uint32_t code) {
                                  codes[{slice, p, row, column}] = code;
                              });
        });
    return codes;
}

std::vector<std::byte> random_page(const DisplayDescription& display) {
    std::vector<std::byte> page = dark_page(display);
    std::mt19937 random(11);
    for (std::byte& byte : page) byte = static_cast<std::byte>(random() & random());
    return page;
}

/// Two HUB75 panels of 8 rows in 4 groups, addressed by two lines.
DisplayDescription hub75_of(PixelFormat format, std::uint16_t row_groups = 4) {
    DisplayDescription display = rotor_of(10, 8, 6, format);
    display.scan = {.driver = DriverChip::Hub75, .pixel_clock_hz = 10'000'000, .min_on_ns = 500};
    display.scan.row_groups = row_groups;
    display.panels[1].connector = 1;
    REQUIRE(validate_display(display).has_value());
    return display;
}

/// What every LED shows, as `from` says of LED (panel, row, column) which sent code it shows.
template <class From>
void check_shown(const DisplayDescription& display, const sim::Faults& faults, const From& from) {
    const std::vector<std::byte> page = random_page(display);
    const Codes sent = shown(display, page, {});
    Codes expected;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                for (std::uint32_t column = 0; column < display.panels[p].columns; ++column) {
                    const auto code_at = [&](std::uint32_t panel, std::uint32_t r, std::uint32_t c) {
                        const auto found = sent.find({slice, panel, r, c});
                        return found == sent.end() ? 0u : found->second;
                    };
                    const std::uint32_t code = from(code_at, p, row, column);
                    if (code != 0) expected[{slice, p, row, column}] = code;
                }
            }
        }
    }
    CHECK(shown(display, page, faults) == expected);
}

TEST_CASE("without faults of the wiring every LED shows what was sent for it") {
    const sim::Faults faults = with({"off-axis:mm=2", "phase:slices=3", "lost-packets:part=0.5"});
    CHECK(sim::Wiring(hub75_of(PixelFormat::Rgb332), faults).is_right());
    check_shown(hub75_of(PixelFormat::Rgb332), faults,
                [](const auto& sent, auto p, auto row, auto column) { return sent(p, row, column); });
}

TEST_CASE("each fault of the wiring changes what LEDs show, and nothing else") {
    const auto format = GENERATE(from_range(kPixelFormats));
    INFO(to_string(format));
    const DisplayDescription display = hub75_of(format);
    const std::uint32_t top = bits_per_pixel(format) - 1;
    const std::string bit = std::to_string(top);

    check_shown(display, with({"mirrored:panel=1"}), [](const auto& sent, auto p, auto row, auto column) {
        return sent(p, row, p == 1 ? 9 - column : column);
    });
    check_shown(display, with({"swapped-panels:panel=0,other=1"}),
                [](const auto& sent, auto p, auto row, auto column) { return sent(1 - p, row, column); });
    check_shown(display, with({"dead-row:panel=1,row=5"}), [](const auto& sent, auto p, auto row, auto column) {
        return p == 1 && row == 5 ? 0u : sent(p, row, column);
    });
    check_shown(display, with({"stuck-bit:panel=0,value=0,bit=" + bit}),
                [&](const auto& sent, auto p, auto row, auto column) {
                    return p == 0 ? sent(p, row, column) & ~(1u << top) : sent(p, row, column);
                });
    check_shown(display, with({"stuck-bit:panel=0,value=1,bit=" + bit}),
                [&](const auto& sent, auto p, auto row, auto column) {
                    return p == 0 ? sent(p, row, column) | 1u << top : sent(p, row, column);
                });
    check_shown(display, with({"row-order:panel=1,line=0,other=1"}),
                [](const auto& sent, auto p, auto row, auto column) {
                    constexpr std::array<std::uint32_t, 8> kSwapped{0, 2, 1, 3, 4, 6, 5, 7};
                    return sent(p, p == 1 ? kSwapped[row] : row, column);
                });
}

TEST_CASE("faults act together, and a fault that comes twice undoes itself") {
    const DisplayDescription display = hub75_of(PixelFormat::Rgb565);
    check_shown(display, with({"swapped-panels:panel=0,other=1", "mirrored:panel=0", "dead-row:panel=0,row=2"}),
                [](const auto& sent, auto p, auto row, auto column) {
                    if (p == 0 && row == 2) return 0u;
                    return sent(1 - p, row, p == 0 ? 9 - column : column);
                });
    for (const std::string_view fault : {"mirrored", "swapped-panels:panel=0,other=1", "row-order:line=0,other=1"}) {
        check_shown(display, with({fault, fault}),
                    [](const auto& sent, auto p, auto row, auto column) { return sent(p, row, column); });
    }
}

TEST_CASE("an address that the device never gives leaves its rows dark") {
    DisplayDescription display = hub75_of(PixelFormat::Mono1, 4);
    display.scan.row_groups = 6;  // Addresses 0 to 5; swapped, 3 asks for 6.
    check_shown(display, with({"row-order:line=0,other=2"}), [](const auto& sent, auto p, auto row, auto column) {
        constexpr std::array<std::uint32_t, 8> kSwapped{0, 4, 2, 99, 1, 5, 6, 99};
        if (p == 1) return sent(p, row, column);
        return kSwapped[row] == 99 ? 0u : sent(p, kSwapped[row], column);
    });
}

TEST_CASE("row groups of a matrix with lines of their own are swapped as such") {
    DisplayDescription display = hub75_of(PixelFormat::Mono1);
    display.scan.driver = DriverChip::Direct;
    check_shown(display, with({"row-order:line=0,other=3"}), [](const auto& sent, auto p, auto row, auto column) {
        constexpr std::array<std::uint32_t, 8> kSwapped{3, 1, 2, 0, 7, 5, 6, 4};
        return sent(p, p == 0 ? kSwapped[row] : row, column);
    });
}

/// Light of each LED in one cycle, from strobes.
std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::size_t>, glm::vec3> lights(
    const DisplayDescription& display, std::span<const std::byte> page, const sim::Faults& faults) {
    const TimeAt time_at = perfect_time(display);
    sim::Exposure exposure(display, display, {}, time_at(device::kCycle), time_at(2 * device::kCycle));
    const auto scan = sim::make_strobe_scan(
        display, sim::with_wiring_faults(display, faults, [&](const sim::Strobe& strobe) { exposure.add(strobe); }));
    scan_page(display, page, 3, *scan, time_at, 255);
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::size_t>, glm::vec3> found;
    exposure.for_each_row([&](const sim::ExposedRow& row) {
        for (std::size_t c = 0; c < row.light.size(); ++c) {
            if (row.light[c] == glm::vec3(0.0f)) continue;
            found[{row.slice, row.panel, row.row, c}] += row.light[c];
        }
    });
    return found;
}

/// Of bit planes: a channel that has fewer of them than others repeats its own.
glm::vec3 light_of_planes(const DisplayDescription& display, std::uint32_t code) {
    const std::uint32_t planes = shown_bit_planes(display);
    glm::vec3 light(0.0f);
    for (int c = 0; c < 3; ++c) {
        const auto [low, bits] = sim::channels(display.format)[static_cast<std::size_t>(c)];
        for (std::uint32_t plane = 0; plane < planes; ++plane) {
            const std::uint32_t bit = code >> (low + bits - 1 - plane % bits) & 1u;
            light[c] += static_cast<float>(bit << (planes - 1 - plane)) / static_cast<float>((1u << planes) - 1);
        }
    }
    return light;
}

/// Checks that strobes and pages show the same with `faults`.
void check_agreement(const DisplayDescription& display, const sim::Faults& faults) {
    const std::vector<std::byte> page = random_page(display);
    const sim::PixelLight pixels(display);
    const bool by_planes = display.light.response == Response::Linear;
    const auto found = lights(display, page, faults);
    std::size_t lit = 0;
    float worst = 0.0f;
    for (const auto& [led, code] : shown(display, page, faults)) {
        const glm::vec3 light = by_planes ? light_of_planes(display, code) : pixels.of(code);
        ++lit;
        const auto& [slice, panel, row, column] = led;
        const auto seen = found.find({slice, panel, row, column});
        REQUIRE(seen != found.end());
        const glm::vec3 away = glm::abs(seen->second - light);
        worst = std::max({worst, away.x, away.y, away.z});
    }
    CHECK(lit == found.size());
    CHECK(worst < 1e-4f);
}

TEST_CASE("strobes show the same faults of the wiring as pages: bit planes, levels, and every format") {
    const auto format = GENERATE(from_range(kPixelFormats));
    INFO(to_string(format));
    const DisplayDescription planes = hub75_of(format);
    DisplayDescription levels = planes;
    levels.light = {.response = Response::Gamma, .gamma = 2.2};
    const std::string bit = std::to_string(bits_per_pixel(format) - 1);
    for (const DisplayDescription& display : {planes, levels}) {
        for (const std::string& fault :
             {std::string("mirrored:panel=1"), std::string("swapped-panels:panel=0,other=1"),
              std::string("dead-row:panel=1,row=5"), "stuck-bit:value=0,bit=" + bit, "stuck-bit:value=1,bit=" + bit,
              std::string("row-order:panel=1,line=0,other=1")}) {
            CAPTURE(fault);
            check_agreement(display, with({fault}));
        }
        check_agreement(display, with({"row-order:panel=0,line=0,other=1", "swapped-panels:panel=0,other=1",
                                       "mirrored:panel=0", "dead-row:panel=1,row=1"}));
    }
}

TEST_CASE("a sink without faults of the wiring is the sink itself") {
    std::size_t strobes = 0;
    const std::byte* bits = nullptr;
    const sim::StrobeSink sink =
        sim::with_wiring_faults(hub75_of(PixelFormat::Mono1), with({"off-axis:mm=1"}), [&](const sim::Strobe& strobe) {
            ++strobes;
            bits = strobe.panels[0].first;
        });
    const std::byte row{};
    sim::Strobe strobe;
    strobe.panels[0].first = &row;
    sink(strobe);
    CHECK(strobes == 1);
    CHECK(bits == &row);
}

}  // namespace
}  // namespace xorvox
