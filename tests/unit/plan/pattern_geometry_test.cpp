// The patterns `index`, `axis` and `wedge` in millimetres: where their light is when the display is as its file says,
// and what moves when it is not.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "driver/host/pattern.h"
#include "tests/catch.h"
#include "tests/unit/plan/displays.h"

using namespace xorvox;
using namespace xorvox::host;
using namespace xorvox::test;

namespace {

std::vector<LitPixel> lit(const DisplayDescription& display, Pattern pattern) {
    std::vector<std::byte> frame(frame_bytes(display));
    paint_pattern(display, pattern, 0, frame);
    return lit_pixels(display, frame);
}

/// The angle, in degrees, of the middle of the pixels of `code`.
double direction_deg(const DisplayDescription& display, const std::vector<LitPixel>& pixels, std::uint32_t code) {
    glm::dvec3 sum(0.0);
    for (const LitPixel& pixel : pixels) {
        if (pixel.code == code) sum += rotor_place_mm(display, pixel);
    }
    return std::atan2(sum.y, sum.x) / kTurn * 360.0;
}

double radius_mm(const glm::dvec3& place) {
    return std::sqrt(place.x * place.x + place.y * place.y);
}

constexpr std::uint32_t kWhite = 7;
constexpr std::uint32_t kGreen = 2;

}  // namespace

TEST_CASE("the index spoke points along x, and the second one a quarter turn later", "[pattern]") {
    for (const bool clockwise : {false, true}) {
        for (const double angle : {0.0, 90.0, -45.0, 180.0}) {
            DisplayDescription display = rotor(PixelFormat::Rgb111, clockwise);
            display.slices = 360;
            for (std::uint32_t p = 0; p < 2; ++p) {
                display.panels[p].angle_deg += angle;
                display.panels[p].offset_mm = 0.0;
            }
            CAPTURE(clockwise, angle);
            const std::vector<LitPixel> pixels = lit(display, Pattern::Index);
            CHECK(direction_deg(display, pixels, kWhite) == Approx(0.0).margin(0.01));
            CHECK(direction_deg(display, pixels, kGreen) == Approx(clockwise ? -90.0 : 90.0).margin(0.01));
            std::set<std::uint32_t> bright, thin;
            for (const LitPixel& pixel : pixels) (pixel.code == kWhite ? bright : thin).insert(pixel.slice);
            CHECK(bright.size() == 8);
            CHECK(thin.size() == 2);
        }
    }
}

TEST_CASE("a display whose first panel has no right side draws the index with one that has", "[pattern]") {
    DisplayDescription display = side_by_side(PixelFormat::Rgb111);
    const std::vector<LitPixel> pixels = lit(display, Pattern::Index);
    CHECK(std::ranges::all_of(pixels, [](const LitPixel& pixel) { return pixel.panel == 1; }));
    CHECK(direction_deg(display, pixels, kWhite) == Approx(0.0).margin(0.01));
}

TEST_CASE("a single column of LEDs that turns has an index, on the axis and off it", "[pattern]") {
    for (const double offset_mm : {0.0, 7.0, -7.0}) {
        DisplayDescription display = rotor(PixelFormat::Mono1);
        display.panel_count = 1;
        display.panels[0] = {.columns = 1, .rows = 16, .offset_mm = offset_mm};
        std::vector<std::byte> frame(frame_bytes(display));
        CHECK(paint_pattern(display, Pattern::Index, 0, frame).pixels > 0);
    }
}

TEST_CASE("a display that shows half turns has its index in both of them", "[pattern]") {
    DisplayDescription display = rotor(PixelFormat::Rgb111, false, 180.0);
    const std::vector<LitPixel> pixels = lit(display, Pattern::Index);
    for (const LitPixel& pixel : pixels) {
        if (pixel.code != kWhite) continue;
        const glm::dvec3 place = rotor_place_mm(display, pixel);
        CHECK(std::abs(place.y) < 0.1 * std::abs(place.x));
    }
    CHECK(std::ranges::any_of(pixels, [](const LitPixel& pixel) { return pixel.slice == 0; }));
    CHECK(std::ranges::any_of(pixels, [](const LitPixel& pixel) { return pixel.slice == 35; }));
}

TEST_CASE("the axis wall is one cylinder when the display is as its file says", "[pattern]") {
    for (DisplayDescription display : {rotor(PixelFormat::Rgb111), rotor(PixelFormat::Rgb111, true),
                                       rotor(PixelFormat::Rgb111, false, 180.0), side_by_side(PixelFormat::Rgb111)}) {
        for (const double shift : {0.0, 1.0}) {
            if (shift != 0.0 && display.name.view() != "rotor") continue;
            for (std::uint32_t p = 0; p < 2; ++p) display.panels[p].shift_mm += shift;
            double least = 1e9;
            double most = 0.0;
            std::set<double> wall_heights;
            for (const LitPixel& pixel : lit(display, Pattern::Axis)) {
                const glm::dvec3 place = rotor_place_mm(display, pixel);
                const double radius = radius_mm(place);
                if (radius < 5.0) continue;  // the post
                least = std::min(least, radius);
                most = std::max(most, radius);
                wall_heights.insert(place.z);
            }
            CAPTURE(display.name.view(), display.clockwise, display.sweep_deg, shift);
            CHECK(least == Approx(most));
            CHECK(wall_heights.size() == 12);
        }
    }
}

TEST_CASE("each band of the axis wall is lit by one side of one panel, all round", "[pattern]") {
    const DisplayDescription display = rotor(PixelFormat::Rgb111);
    // Row from the top: who lights it, and in how many slices.
    std::array<std::set<std::pair<std::uint32_t, std::uint32_t>>, 12> writers;
    std::array<std::size_t, 12> count{};
    for (const LitPixel& pixel : lit(display, Pattern::Axis)) {
        if (pixel.column >= 7 && pixel.column <= 8) continue;  // the post
        writers[pixel.row].insert({pixel.panel, pixel.column});
        ++count[pixel.row];
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> all;
    for (std::size_t row = 1; row < 11; ++row) {
        CHECK(writers[row].size() == 1);
        CHECK(count[row] == 36);
        all.insert(writers[row].begin(), writers[row].end());
    }
    CHECK(all.size() == 4);
    for (const std::size_t row : {std::size_t{0}, std::size_t{11}}) CHECK(writers[row].size() == 4);
}

TEST_CASE("the bands of the axis wall stand where axis_bands says, interleaved, skewed, tilted or turned",
          "[pattern]") {
    DisplayDescription interleaved = rotor(PixelFormat::Rgb111);
    interleaved.panels[1].shift_mm = 1.0;
    interleaved.panels[1].lift_mm = 1.0;
    DisplayDescription skewed = interleaved;
    skewed.panels[0].skew_mm = 0.7;
    skewed.panels[1].mirrored = true;
    skewed.panels[1].skew_mm = -0.4;
    for (const DisplayDescription& display :
         {rotor(PixelFormat::Rgb111), rotor(PixelFormat::Rgb111, false, 180.0), side_by_side(PixelFormat::Rgb111),
          tilted_rotor(PixelFormat::Rgb111), interleaved, skewed}) {
        const std::vector<AxisBand> bands = axis_bands(display);
        const bool is_double = display.name.view() != "side by side";
        REQUIRE(bands.size() == (is_double ? 4 : 2));
        // Of each side, the light of rings and band: heights, and distances by height.
        std::map<std::pair<std::uint32_t, bool>, std::map<double, double>> seen;
        for (const LitPixel& pixel : lit(display, Pattern::Axis)) {
            const glm::dvec3 place = rotor_place_mm(display, pixel);
            if (radius_mm(place) < 5.0) continue;  // the post
            const Panel& panel = display.panels[pixel.panel];
            const bool right = panel.shift_mm + on_panel_mm(panel, pixel.row, pixel.column).x > 0.0;
            seen[{pixel.panel, right}][place.z] = radius_mm(place);
        }
        CHECK(seen.size() == bands.size());
        double before = -1e9;
        for (const AxisBand& band : bands) {
            CAPTURE(display.name.view(), band.panel, band.right_side);
            const std::map<double, double>& light = seen[{band.panel, band.right_side}];
            REQUIRE(light.size() >= 4);
            CHECK(band.low_arc_mm == Approx(light.begin()->first));
            CHECK(band.high_arc_mm == Approx(light.rbegin()->first));
            double radius = 0.0;
            double height = 0.0;
            for (auto at = std::next(light.begin()); at != std::prev(light.end()); ++at) {
                radius += at->second;
                height += at->first;
            }
            const auto rows = static_cast<double>(light.size() - 2);
            // The outermost band's middle row may be one of the ring: half a row away.
            CHECK(radius / rows == Approx(band.radius_mm).margin(display.panels[1].tilt_deg == 0.0 ? 1e-9 : 0.2));
            CHECK(height / rows > before);
            before = height / rows;
        }
    }
    const std::vector<AxisBand> apart = axis_bands(interleaved);
    CHECK(std::abs(apart[2].radius_mm - apart[0].radius_mm) > 0.9);
    CHECK(axis_bands(stack(PixelFormat::Rgb111)).empty());
}

TEST_CASE("each height of the axis post has the colour of one panel", "[pattern]") {
    const DisplayDescription display = rotor(PixelFormat::Rgb111);
    std::map<std::uint32_t, std::set<std::uint32_t>> panels_of_row;
    std::set<std::uint32_t> panels;
    for (const LitPixel& pixel : lit(display, Pattern::Axis)) {
        if (pixel.column < 7 || pixel.column > 8) continue;
        panels_of_row[pixel.row].insert(pixel.panel);
        panels.insert(pixel.panel);
    }
    CHECK(panels_of_row.size() == 12);
    for (const auto& [row, of_row] : panels_of_row) CHECK(of_row.size() == 1);
    CHECK(panels.size() == 2);
}

TEST_CASE("the arcs of the axis ring fill the circle once, where the LEDs are", "[pattern]") {
    for (const bool clockwise : {false, true}) {
        DisplayDescription display = rotor(PixelFormat::Rgb111, clockwise);
        display.slices = 80;
        display.panels[0].offset_mm = 4.0;  // LEDs of the two sides are then not opposite of each other
        display.panels[1].offset_mm = 4.0;
        std::vector<double> degrees;
        for (const LitPixel& pixel : lit(display, Pattern::Axis)) {
            if (pixel.row != 0 || (pixel.column >= 7 && pixel.column <= 8)) continue;
            const glm::dvec3 place = rotor_place_mm(display, pixel);
            degrees.push_back(std::atan2(place.y, place.x) / kTurn * 360.0);
        }
        CHECK(degrees.size() == 80);
        std::ranges::sort(degrees);
        // Slices are 4.5 degrees apart; where two arcs meet, neighbours may be a slice nearer or farther.
        for (std::size_t i = 1; i < degrees.size(); ++i) CHECK(degrees[i] - degrees[i - 1] < 9.0);
    }
}

TEST_CASE("a shift that the file has wrong makes steps of twice its size in the axis wall", "[pattern]") {
    const DisplayDescription file = rotor(PixelFormat::Rgb111);
    DisplayDescription real = file;
    real.panels[1].shift_mm = 1.0;
    for (Panel& panel : real.panels) panel.offset_mm = 0.0;
    std::set<int> radii_of[2];
    for (const LitPixel& pixel : lit(file, Pattern::Axis)) {
        const double radius = radius_mm(rotor_place_mm(real, pixel));
        if (radius > 5.0) radii_of[pixel.panel].insert(static_cast<int>(std::lround(1000.0 * radius)));
    }
    CHECK(radii_of[0].size() == 1);
    REQUIRE(radii_of[1].size() == 2);
    CHECK(*radii_of[1].rbegin() - *radii_of[1].begin() == 2000);
}

TEST_CASE("index and axis outline the planes of displays that do not turn", "[pattern]") {
    const DisplayDescription display = stack(PixelFormat::Rgb111, 16, 12, 8);
    CHECK(index_border_slice(display) == 2);
    CHECK(index_border_slice(stack(PixelFormat::Rgb111, 16, 12, 2)) == 1);
    for (const LitPixel& pixel : lit(display, Pattern::Index)) {
        CHECK((pixel.slice == 0 || pixel.slice == 2));
        if (pixel.slice == 2) CHECK((pixel.column % 15 == 0 || pixel.row % 11 == 0));
    }
    std::size_t border = 0;
    for (const LitPixel& pixel : lit(display, Pattern::Axis)) {
        if (pixel.slice != 7) continue;
        const bool outer = pixel.column % 15 == 0 || pixel.row % 11 == 0;
        border += outer ? 1 : 0;
        if (!outer) CHECK((pixel.column == 4 || pixel.column == 11 || pixel.row == 3 || pixel.row == 8));
    }
    CHECK(border == 2 * 16 + 2 * 12 - 4);
}

TEST_CASE("the axis of a helix has circles about it", "[pattern]") {
    const DisplayDescription display = helix(PixelFormat::Rgb111);
    for (const LitPixel& pixel : lit(display, Pattern::Axis)) {
        const glm::dvec2 place = on_panel_mm(display.panels[0], pixel.row, pixel.column);
        const double radius = std::sqrt(place.x * place.x + place.y * place.y);
        CHECK(radius == Approx(pixel.code == kGreen ? 8.0 : 14.0).margin(1.0));
    }
}

TEST_CASE("the axis of free points shows those farthest along x, y and z", "[pattern]") {
    const DisplayDescription display = free_points(PixelFormat::Rgb111);
    const auto far = [](auto coordinate) {
        const auto [least, most] = std::ranges::minmax_element(kPoints, {}, coordinate);
        return std::set<std::ptrdiff_t>{least - kPoints.begin(), most - kPoints.begin()};
    };
    std::set<std::ptrdiff_t> red, green, blue;
    for (const LitPixel& pixel : lit(display, Pattern::Axis)) {
        const std::ptrdiff_t point = pixel.row * 4 + pixel.column;
        if ((pixel.code & 1u) != 0) red.insert(point);
        if ((pixel.code & 2u) != 0) green.insert(point);
        if ((pixel.code & 4u) != 0) blue.insert(point);
    }
    CHECK(red == far(&PointMm::x));
    CHECK(green == far(&PointMm::y));
    CHECK(blue == far(&PointMm::z));
}

TEST_CASE("the wedge of a rotor brightens outwards, alike on both sides of each panel", "[pattern]") {
    for (const DisplayDescription& display : {rotor(PixelFormat::Mono4), side_by_side(PixelFormat::Mono4)}) {
        std::map<int, std::set<std::uint32_t>> of_radius;
        double top = -1e9;
        const std::vector<LitPixel> pixels = lit(display, Pattern::Wedge);
        for (const LitPixel& pixel : pixels) top = std::max(top, rotor_place_mm(display, pixel).z);
        for (const LitPixel& pixel : pixels) {
            const glm::dvec3 place = rotor_place_mm(display, pixel);
            if (place.z > top - 0.1) of_radius[static_cast<int>(std::lround(radius_mm(place)))].insert(pixel.code);
        }
        CAPTURE(display.name.view());
        CHECK(of_radius.size() == 8);
        std::uint32_t before = 0;
        for (const auto& [radius, codes] : of_radius) {
            CHECK(codes.size() == 1);
            CHECK(*codes.begin() > before);
            before = *codes.begin();
        }
        CHECK(before == 15);
        CHECK(*of_radius.begin()->second.begin() == 1);
    }
}
