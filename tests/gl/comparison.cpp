#include "sim/comparison.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "sim/scan_out.h"
#include "sim/seats.h"
#include "tests/catch.h"
#include "tests/gl/required.h"
#include "tests/unit/sim/displays.h"
#include "tests/unit/sim/perfect.h"

namespace xorvox {
namespace {

using namespace test;

constexpr sim::PictureOptions kSize{.width = 240, .height = 180};

DisplayDescription small_rotor() {
    return rotor_of(24, 12, 60, PixelFormat::Mono4);
}

/// The pixels of a page within a ball about the middle.
std::vector<std::byte> ball(const DisplayDescription& display, double radius_mm, std::uint32_t code) {
    std::vector<std::byte> page = dark_page(display);
    const sim::Faults none;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const sim::Seats seats(display, p, slice, none);
            for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                for (std::uint32_t column = 0; column < display.panels[p].columns; ++column) {
                    if (glm::length(seats.place_mm(row, column)) > radius_mm) continue;
                    set_pixel(display, page, {slice, p, row, column}, code);
                }
            }
        }
    }
    return page;
}

sim::Exposure exposed(const DisplayDescription& display, std::span<const std::byte> lit, const sim::Faults& faults) {
    const TimeAt time_at = perfect_time(display);
    sim::Exposure exposure(display, display, {}, 0, time_at(device::kCycle), faults);
    const auto scan = sim::make_strobe_scan(display, [&](const sim::Strobe& strobe) { exposure.add(strobe); });
    scan_page(display, lit, 1, *scan, time_at);
    return exposure;
}

/// Pixels of a side (0: sent, 1: lit, 2: differences) that are clearly red, yellow, blue or violet.
struct Marks {
    std::size_t red = 0;
    std::size_t yellow = 0;
    std::size_t blue = 0;
    std::size_t violet = 0;

    bool none() const { return red + yellow + blue + violet == 0; }
};
Marks marks_of(const sim::Image& image, std::uint32_t side) {
    Marks marks;
    for (std::uint32_t y = 34; y < 34 + kSize.height; ++y) {
        for (std::uint32_t x = side * kSize.width; x < (side + 1) * kSize.width; ++x) {
            const std::uint8_t* rgb = &image.rgb[3 * (std::size_t{y} * image.width + x)];
            const bool r = rgb[0] > 140;
            const bool low_g = rgb[1] < rgb[0] * 3 / 4;
            marks.red += r && low_g && rgb[2] < rgb[0] / 2;
            marks.yellow += r && rgb[1] > 120 && rgb[2] < rgb[1] * 3 / 4;
            marks.blue += rgb[2] > 140 && rgb[0] < rgb[2] * 3 / 4;
            marks.violet += r && low_g && rgb[2] > rgb[0] / 2 && rgb[2] < rgb[0];
        }
    }
    return marks;
}

TEST_CASE("sent, lit and differences are side by side, and nothing is marked where they agree") {
    const DisplayDescription display = small_rotor();
    const std::vector<std::byte> page = ball(display, 18.0, 15);
    const auto picture = sim::render_comparison(exposed(display, page, {}), page, 255, kSize);
    XORVOX_NEED_GL(picture);
    CHECK(picture->image.width == 720);
    CHECK(picture->image.height > 180 + 2 * 34);
    CHECK(picture->covered > 0.2);
    CHECK(marks_of(picture->image, 0).none());
    CHECK(marks_of(picture->image, 1).none());
    CHECK(marks_of(picture->image, 2).none());
}

TEST_CASE("what is lost, extra, displaced and changed is marked among the differences alone") {
    const DisplayDescription display = small_rotor();
    const std::vector<std::byte> large = ball(display, 18.0, 15);
    const std::vector<std::byte> small = ball(display, 12.0, 15);
    const auto marks = [&](std::span<const std::byte> sent, std::span<const std::byte> lit, const sim::Faults& faults) {
        const auto picture = sim::render_comparison(exposed(display, lit, faults), sent, 255, kSize);
        REQUIRE(picture.has_value());
        CHECK(marks_of(picture->image, 0).none());
        CHECK(marks_of(picture->image, 1).none());
        return marks_of(picture->image, 2);
    };
    const auto picture = sim::render_comparison(exposed(display, large, {}), large, 255, kSize);
    XORVOX_NEED_GL(picture);

    const Marks lost = marks(large, small, {});
    CHECK(lost.red > 500);
    CHECK(lost.yellow + lost.blue + lost.violet == 0);
    const Marks extra = marks(small, large, {});
    CHECK(extra.yellow > 500);
    CHECK(extra.red + extra.blue + extra.violet == 0);
    sim::Faults faults;
    faults.list.push_back({.kind = sim::FaultKind::OffAxis, .panel = 1, .amount = 5.0});
    const Marks displaced = marks(large, large, faults);
    CHECK(displaced.blue > 500);
    CHECK(displaced.red + displaced.yellow + displaced.violet == 0);
    const Marks changed = marks(large, ball(display, 18.0, 7), {});
    CHECK(changed.violet > 500);
    CHECK(changed.red + changed.yellow + changed.blue == 0);
}

/// Red above green among the differences, all told.
double redness(const sim::Image& image) {
    double all = 0.0;
    for (std::uint32_t y = 34; y < 34 + kSize.height; ++y) {
        for (std::uint32_t x = 2 * kSize.width; x < 3 * kSize.width; ++x) {
            const std::uint8_t* rgb = &image.rgb[3 * (std::size_t{y} * image.width + x)];
            all += std::max(0, int{rgb[0]} - int{rgb[1]});
        }
    }
    return all;
}

TEST_CASE("a difference within the body shines through it") {
    const DisplayDescription display = small_rotor();
    const std::vector<std::byte> large = ball(display, 18.0, 15);
    const std::vector<std::byte> small = ball(display, 9.0, 15);
    std::vector<std::byte> hollow = large;
    for (std::size_t i = 0; i < hollow.size(); ++i) hollow[i] ^= small[i];
    const auto none = sim::render_comparison(exposed(display, large, {}), large, 255, kSize);
    XORVOX_NEED_GL(none);
    const auto within = sim::render_comparison(exposed(display, hollow, {}), large, 255, kSize);
    REQUIRE(within.has_value());
    CHECK(redness(within->image) > redness(none->image) + 20'000.0);
}

}  // namespace
}  // namespace xorvox
