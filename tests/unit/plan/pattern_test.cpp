// Bring-up patterns: that they show what they say on every kind of display and in every pixel format.
#include "driver/host/pattern.h"

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "driver/host/pixel.h"
#include "tests/catch.h"
#include "tests/unit/plan/displays.h"

using namespace xorvox;
using namespace xorvox::host;
using namespace xorvox::test;

namespace {

std::vector<std::byte> painted(const DisplayDescription& display, Pattern pattern, std::uint64_t number = 0) {
    // What was there before must not matter.
    std::vector<std::byte> frame(frame_bytes(display), std::byte{0xa5});
    paint_pattern(display, pattern, number, frame);
    return frame;
}

std::vector<LitPixel> lit(const DisplayDescription& display, Pattern pattern, std::uint64_t number = 0) {
    return lit_pixels(display, painted(display, pattern, number));
}

std::uint32_t white(PixelFormat format) {
    return static_cast<std::uint32_t>((std::uint64_t{1} << bits_per_pixel(format)) - 1);
}

/// A panel with what is lit on it in slice 0, as whoever looks at it sees it: lines from the top, of '#' and '.'.
std::vector<std::string> seen(const Panel& mounted, const std::vector<LitPixel>& pixels, std::uint32_t panel = 0) {
    const bool on_its_side = mounted.turned % 2 == 1;
    const std::size_t width = on_its_side ? mounted.rows : mounted.columns;
    const std::size_t height = on_its_side ? mounted.columns : mounted.rows;
    std::vector<std::string> picture(height, std::string(width, '.'));
    Panel unit = mounted;
    unit.column_pitch_mm = unit.row_pitch_mm = 1.0;
    for (const LitPixel& pixel : pixels) {
        if (pixel.panel != panel || pixel.slice != 0) continue;
        const glm::dvec2 place = on_panel_mm(unit, pixel.row, pixel.column);
        const auto x = static_cast<std::size_t>(place.x + (static_cast<double>(width) - 1) / 2.0 + 0.5);
        const auto y = static_cast<std::size_t>((static_cast<double>(height) - 1) / 2.0 - place.y + 0.5);
        picture[y][x] = '#';
    }
    return picture;
}

}  // namespace

TEST_CASE("every pattern keeps to the frame and counts what it lights", "[pattern]") {
    for (const PixelFormat format : kPixelFormats) {
        for (const DisplayDescription& display : every_kind(format)) {
            for (const PatternInfo& info : patterns()) {
                CAPTURE(to_string(format), display.name.view(), info.name);
                const std::uint64_t frames = pattern_frames(display, info.pattern);
                CHECK((frames > 1) == info.moves);
                for (const std::uint64_t number : {std::uint64_t{0}, frames / 2, frames - 1}) {
                    std::vector<std::byte> frame(frame_bytes(display), std::byte{0x5a});
                    const PatternLight light = paint_pattern(display, info.pattern, number, frame);
                    CHECK(frame == painted(display, info.pattern, number));
                    CHECK(frame == painted(display, info.pattern, number + frames));
                    bool padding = false;
                    const std::vector<LitPixel> pixels = lit_pixels(display, frame, &padding);
                    CHECK_FALSE(padding);
                    CHECK(light.pixels == pixels.size());
                    CHECK(light.pixels > 0);
                    std::map<std::uint32_t, std::uint64_t> of_slice;
                    for (const LitPixel& pixel : pixels) ++of_slice[pixel.slice];
                    std::uint64_t most = 0;
                    for (const auto& [slice, count] : of_slice) most = std::max(most, count);
                    CHECK(light.most_in_slice == most);
                }
            }
        }
    }
}

TEST_CASE("the patterns that are to be watched for long light a small part of a slice", "[pattern]") {
    for (const PixelFormat format : {PixelFormat::Mono1, PixelFormat::Rgb332}) {
        for (const DisplayDescription& display : every_kind(format)) {
            CAPTURE(to_string(format), display.name.view());
            const auto part = [&](Pattern pattern) {
                std::vector<std::byte> frame(frame_bytes(display));
                const PatternLight light = paint_pattern(display, pattern, 0, frame);
                return static_cast<double>(light.most_in_slice * display.slices) /
                       static_cast<double>(frame_pixels(display));
            };
            CHECK(part(Pattern::Panels) <= 0.5);
            CHECK(part(Pattern::Orientation) <= 0.7);
            CHECK(part(Pattern::Stairs) <= 0.5);
            if (display.kind == DisplayKind::RotatingPanel) {
                CHECK(part(Pattern::Index) <= 0.5);
                CHECK(part(Pattern::Axis) <= 0.4);
            }
        }
    }
    const DisplayDescription large = stack(PixelFormat::Mono1, 64, 32, 4);
    CHECK(lit(large, Pattern::Orientation).size() * 10 <= frame_pixels(large) * 4);
}

TEST_CASE("panel p shows p + 1 bars in a colour of its own", "[pattern]") {
    for (const PixelFormat format : {PixelFormat::Mono1, PixelFormat::Rgb111, PixelFormat::Rgb565}) {
        DisplayDescription display = rotor(format);
        display.panel_count = 8;
        for (std::uint32_t p = 2; p < 8; ++p) display.panels[p] = display.panels[0];
        for (std::uint32_t p = 0; p < 8; ++p) display.panels[p].columns = static_cast<std::uint16_t>(17 + p);
        display.panels[3].turned = 3;
        display.panels[3].rows = 20;
        display.panels[5].mirrored = true;
        const std::vector<LitPixel> pixels = lit(display, Pattern::Panels);
        std::set<std::uint32_t> colors;
        for (std::uint32_t p = 0; p < 8; ++p) {
            CAPTURE(to_string(format), p);
            const std::vector<std::string> picture = seen(display.panels[p], pixels, p);
            for (const std::string& line : picture) {
                std::size_t bars = 0;
                for (std::size_t x = 1; x < line.size(); ++x) bars += line[x] == '#' && line[x - 1] == '.';
                CHECK(bars == p + 1);
                CHECK(line.front() == '.');
                CHECK(line.back() == '.');
            }
            std::set<std::uint32_t> of_panel;
            for (const LitPixel& pixel : pixels) {
                if (pixel.panel == p) of_panel.insert(pixel.code);
            }
            CHECK(of_panel.size() == 1);
            colors.insert(of_panel.begin(), of_panel.end());
        }
        CHECK(colors.size() == (is_mono(format) ? 1u : 7u));
    }
}

TEST_CASE("the orientation mark looks different in every way a panel can be mounted, and right when the file says how",
          "[pattern]") {
    for (const auto& [columns, rows] : {std::pair{3, 3},
                                        {4, 4},
                                        {5, 5},
                                        {8, 8},
                                        {16, 16},
                                        {64, 64},
                                        {2, 3},
                                        {3, 2},
                                        {8, 10},
                                        {10, 8},
                                        {128, 64},
                                        {5, 32}}) {
        DisplayDescription display = rotor(PixelFormat::Mono1);
        display.panel_count = 1;
        Panel& panel = display.panels[0];
        panel.columns = static_cast<std::uint16_t>(columns);
        panel.rows = static_cast<std::uint16_t>(rows);
        const std::vector<LitPixel> of_plain_file = lit(display, Pattern::Orientation);
        const std::vector<std::string> upright = seen(panel, of_plain_file);
        std::set<std::vector<std::string>> pictures;
        for (const bool mirrored : {false, true}) {
            for (const int turned : {0, 1, 2, 3}) {
                CAPTURE(columns, rows, mirrored, turned);
                Panel mounted = panel;
                mounted.mirrored = mirrored;
                mounted.turned = static_cast<std::uint8_t>(turned);
                CHECK(pictures.insert(seen(mounted, of_plain_file)).second);
                DisplayDescription corrected = display;
                corrected.panels[0] = mounted;
                const std::vector<std::string> now = seen(mounted, lit(corrected, Pattern::Orientation));
                if (turned % 2 == 0 || columns == rows) CHECK(now == upright);
                // The stem at the left, the long bar on top, its foot and the lower right corner dark.
                CHECK(now.front() == std::string(now.front().size(), '#'));
                CHECK(now.back().back() == '.');
            }
        }
        CHECK(pictures.size() == 8);
    }
}

TEST_CASE("the orientation mark is an F", "[pattern]") {
    DisplayDescription display = rotor(PixelFormat::Mono1);
    display.panels[0].columns = 6;
    display.panels[0].rows = 7;
    CHECK(seen(display.panels[0], lit(display, Pattern::Orientation)) ==
          std::vector<std::string>{"######", "#.....", "#.....", "####..", "#.....", "#.....", "#....."});
}

TEST_CASE("planes of a stack have their rows upwards", "[pattern]") {
    const DisplayDescription display = stack(PixelFormat::Mono1, 6, 7, 3);
    std::uint32_t bar = 0;
    for (const LitPixel& pixel : lit(display, Pattern::Orientation)) bar += pixel.row == 6 && pixel.slice == 0 ? 1 : 0;
    CHECK(bar == 6);
}

TEST_CASE("stairs climb one step a slice and leave no column out", "[pattern]") {
    for (const auto& [columns, slices] : {std::pair{16, 5}, {16, 16}, {7, 40}, {100, 8}}) {
        const DisplayDescription display =
            stack(PixelFormat::Rgb332, static_cast<std::uint16_t>(columns), 3, static_cast<std::uint32_t>(slices));
        std::vector<std::set<std::uint32_t>> steps(display.slices);
        for (const LitPixel& pixel : lit(display, Pattern::Stairs)) steps[pixel.slice].insert(pixel.column);
        std::set<std::uint32_t> all;
        for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
            CAPTURE(columns, slices, slice);
            REQUIRE_FALSE(steps[slice].empty());
            if (slice > 0) CHECK(*steps[slice].begin() >= *steps[slice - 1].rbegin());
            if (slice > 0 && columns >= slices) CHECK(*steps[slice].begin() == *steps[slice - 1].rbegin() + 1);
            all.insert(steps[slice].begin(), steps[slice].end());
        }
        CHECK(all.size() == static_cast<std::size_t>(columns));
    }
}

TEST_CASE("the wedge uses every level where there is room for them, and never goes back", "[pattern]") {
    for (const PixelFormat format : kPixelFormats) {
        const std::uint32_t levels = (1u << bits_per_channel(format)) - 1;
        const DisplayDescription display = stack(format, 256, 774, 255);
        std::map<std::uint32_t, std::uint32_t> along_columns, along_slices, along_rows;
        for (const LitPixel& pixel : lit(display, Pattern::Wedge)) {
            if (pixel.slice == 0 && pixel.row == 773) along_columns[pixel.column] = pixel.code;
            if (pixel.row == 300 && pixel.column == 0) along_slices[pixel.slice] = pixel.code;
            if (pixel.slice == 0 && pixel.column == 0 && pixel.row < 258) along_rows[pixel.row] = pixel.code;
        }
        for (const auto& steps : {along_columns, along_slices, along_rows}) {
            CAPTURE(to_string(format), steps.size());
            REQUIRE(steps.size() >= 255);
            std::set<std::uint32_t> codes;
            const auto green = [&](std::uint32_t code) {
                return is_mono(format) ? code : code & quantize({0.0f, 1.0f, 0.0f}, format);
            };
            std::uint32_t before = 0;
            for (const auto& [place, code] : steps) {
                CHECK(green(code) >= green(before));
                before = code;
                codes.insert(code);
            }
            CHECK(codes.size() == levels);
            CHECK(before == white(format));
        }
    }
}

TEST_CASE("planes light every bit of every channel by itself, the most significant first", "[pattern]") {
    for (const PixelFormat format : kPixelFormats) {
        DisplayDescription display = stack(format);
        display.cycles_per_second = 3.0;
        const std::uint64_t frames = pattern_frames(display, Pattern::Planes);
        CHECK(frames == 3 * bits_per_pixel(format));
        std::vector<std::uint32_t> order;
        for (std::uint64_t number = 0; number < frames; ++number) {
            const std::vector<LitPixel> pixels = lit(display, Pattern::Planes, number);
            REQUIRE(pixels.size() == frame_pixels(display));
            CHECK(std::popcount(pixels[0].code) == 1);
            CHECK(std::ranges::all_of(pixels, [&](const LitPixel& pixel) { return pixel.code == pixels[0].code; }));
            if (number % 3 == 0) order.push_back(pixels[0].code);
            CHECK(order.back() == pixels[0].code);
        }
        std::uint32_t all = 0;
        for (const std::uint32_t code : order) all |= code;
        CHECK(all == white(format));
        CHECK(std::set(order.begin(), order.end()).size() == bits_per_pixel(format));
        if (!is_mono(format)) CHECK((order[0] & quantize({1.0f, 0.0f, 0.0f}, format)) == order[0]);
    }
    DisplayDescription display = stack(PixelFormat::Rgb332);
    display.cycles_per_second = 1.0;
    std::vector<std::uint32_t> codes;
    for (std::uint64_t number = 0; number < 8; ++number) codes.push_back(lit(display, Pattern::Planes, number)[0].code);
    CHECK(codes == std::vector<std::uint32_t>{0x80, 0x40, 0x20, 0x10, 0x08, 0x04, 0x02, 0x01});
}

TEST_CASE("lines light each row, then each column, of each panel", "[pattern]") {
    DisplayDescription display = rotor(PixelFormat::Rgb111);
    display.cycles_per_second = 5.0;
    REQUIRE(pattern_frames(display, Pattern::Lines) == 2 * (16 + 12));
    for (std::uint32_t number = 0; number < 2 * (16 + 12); ++number) {
        const std::uint32_t panel = number / 28;
        const std::uint32_t line = number % 28;
        const std::vector<LitPixel> pixels = lit(display, Pattern::Lines, number);
        CHECK(pixels.size() == (line < 12 ? 16 : 12) * display.slices);
        CHECK(std::ranges::all_of(pixels, [&](const LitPixel& pixel) {
            return pixel.panel == panel && (line < 12 ? pixel.row == line : pixel.column == line - 12);
        }));
    }
    display.cycles_per_second = 100.0;
    CHECK(pattern_frames(display, Pattern::Lines) == 10 * 2 * (16 + 12));
    CHECK(lit(display, Pattern::Lines, 9) == lit(display, Pattern::Lines, 0));
    CHECK(lit(display, Pattern::Lines, 10) != lit(display, Pattern::Lines, 0));
}

TEST_CASE("walk lights one pixel a frame, and each once, in the order of the wire", "[pattern]") {
    for (const PixelFormat format : kPixelFormats) {
        for (const DisplayDescription& display :
             {stack(format, 5, 3, 4), side_by_side(format), free_points(format), helix(format)}) {
            const std::uint64_t frames = pattern_frames(display, Pattern::Walk);
            CHECK(frames == frame_pixels(display));
            std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t> before{};
            const std::uint64_t step = display.kind == DisplayKind::RotatingPanel ? 7 : 1;
            for (std::uint64_t number = 0; number < frames; number += step) {
                const std::vector<LitPixel> pixels = lit(display, Pattern::Walk, number);
                REQUIRE(pixels.size() == 1);
                CHECK(pixels[0].code == white(format));
                const std::tuple now{pixels[0].slice, pixels[0].panel, pixels[0].row, pixels[0].column};
                if (number > 0) CHECK(now > before);
                before = now;
            }
        }
    }
}

TEST_CASE("all lights every pixel at its faintest", "[pattern]") {
    const std::map<PixelFormat, std::uint32_t> faintest{{PixelFormat::Mono1, 1},      {PixelFormat::Mono2, 1},
                                                        {PixelFormat::Mono4, 1},      {PixelFormat::Rgb111, 7},
                                                        {PixelFormat::Rgb332, 0x25},  {PixelFormat::Rgb555, 0x421},
                                                        {PixelFormat::Rgb565, 0x821}, {PixelFormat::Rgb888, 0x10101}};
    for (const auto& [format, code] : faintest) {
        const std::vector<LitPixel> pixels = lit(rotor(format), Pattern::All);
        CHECK(pixels.size() == frame_pixels(rotor(format)));
        CHECK(std::ranges::all_of(pixels, [c = code](const LitPixel& pixel) { return pixel.code == c; }));
    }
}

TEST_CASE("the faintest light is that of the bits that are shown", "[pattern]") {
    DisplayDescription display = rotor(PixelFormat::Rgb332);
    for (const auto& [planes, code] : {std::pair{2, 0x49u}, std::pair{1, 0x92u}}) {
        display.scan.bit_planes = static_cast<std::uint8_t>(planes);
        CHECK(lit(display, Pattern::All)[0].code == code);
    }
}

TEST_CASE("an unknown pattern is refused with a list", "[pattern]") {
    CHECK(find_pattern("walk")->pattern == Pattern::Walk);
    const auto unknown = find_pattern("wlak");
    REQUIRE_FALSE(unknown.has_value());
    for (const PatternInfo& info : patterns()) {
        CHECK_THAT(unknown.error().message, Catch::Contains(std::string(info.name)));
        CHECK(find_pattern(info.name)->pattern == info.pattern);
    }
}
