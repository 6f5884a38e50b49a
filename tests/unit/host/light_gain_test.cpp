#include "driver/host/light_gain.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "driver/display/toml.h"
#include "driver/host/calibration.h"
#include "driver/host/slices.h"
#include "driver/host/white.h"
#include "tests/catch.h"
#include "tests/displays.h"
#include "tests/unit/host/light_reference.h"

using namespace xorvox;
using namespace xorvox::host;

namespace {

/// Light of a cycle in rings of radius `width_mm`, per area, from the drawing: gains added up where the samples are.
std::vector<double> light_in_rings(const DisplayDescription& display, double width_mm, bool even) {
    const std::vector<float> gains = even ? even_pixel_gains(display) : std::vector<float>();
    std::vector<double> rings;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        std::size_t pixel = 0;
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                for (std::uint32_t column = 0; column < display.panels[p].columns; ++column, ++pixel) {
                    const glm::dvec3 place = test::drawn(display, slice, p, row, column);
                    const auto ring = static_cast<std::size_t>(std::hypot(place.x, place.y) / width_mm);
                    if (rings.size() <= ring) rings.resize(ring + 1);
                    rings[ring] += even ? static_cast<double>(gains[pixel]) : 1.0;
                }
            }
        }
    }
    for (std::size_t i = 0; i < rings.size(); ++i) rings[i] /= static_cast<double>(2 * i + 1);
    return rings;
}

double ratio(const std::vector<double>& rings, std::size_t first, std::size_t last) {
    const auto [least, most] = std::minmax_element(rings.begin() + static_cast<std::ptrdiff_t>(first),
                                                   rings.begin() + static_cast<std::ptrdiff_t>(last));
    return *most / *least;
}

DisplayDescription preset(const char* name) {
    return load_display(name).value();
}

}  // namespace

TEST_CASE("even light of a rotor is even from the axis to the rim, and the largest gain is 1") {
    for (const char* name : {"vortex", "rotovox", "perspecta"}) {
        CAPTURE(name);
        DisplayDescription display = preset(name);
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            (display.panels[p].turned % 2 == 1 ? display.panels[p].columns : display.panels[p].rows) = 2;
        }
        display.slices = 12;
        const double pitch = display.panels[0].column_pitch_mm;
        const double width = 8.0 * pitch;
        const std::vector<double> even = light_in_rings(display, width, true);
        const std::vector<double> bright = light_in_rings(display, width, false);
        // The innermost ring that light reaches, and the outermost, are not whole.
        const std::size_t first = display.panels[0].offset_mm > width ? 2 : display.panels[0].offset_mm > 0.0 ? 1 : 0;
        const std::size_t last = even.size() - 2;
        REQUIRE(last > first + 3);
        CHECK(ratio(even, first, last) < 1.2);  // 8 LEDs a ring, of which one may stand on its border
        CHECK(ratio(bright, first, last) > 3.0);
        CHECK(std::ranges::max(even_pixel_gains(display)) == 1.0f);
        CHECK(std::ranges::min(even_pixel_gains(display)) > 0.0f);
    }
}

TEST_CASE("even light counts the panels that pass: where two of them do, each gives half") {
    DisplayDescription display;
    display.kind = DisplayKind::RotatingPanel;
    display.slices = 8;
    display.cycles_per_second = 10.0;
    display.panel_count = 2;
    display.panels[0] = {.columns = 200, .rows = 3};
    display.panels[1] = {.columns = 80, .rows = 2, .lift_mm = -0.5, .angle_deg = 90.0, .tilt_deg = 20.0};
    const std::vector<float> gains = even_pixel_gains(display);
    REQUIRE(gains.size() == 200 * 3 + 80 * 2);
    const auto at = [&](std::uint32_t column) { return static_cast<double>(gains[200 + column]); };  // panel 0, row 1
    // Radius 39.5 and 40.5: inside and outside of the smaller panel's reach.
    CHECK(at(140) / at(139) == Approx(2.0 * 40.5 / 39.5));
    CHECK(at(120) / at(110) == Approx(20.5 / 10.5));
    // The upper row is above the smaller panel.
    CHECK(static_cast<double>(gains[110]) == Approx(2.0 * at(110)));
    // A tilted panel's rows stand closer together in height.
    CHECK(static_cast<double>(gains[600 + 60]) == Approx(at(120) * std::cos(20.0 / 180.0 * 3.14159265358979)));
}

TEST_CASE("a pixel over the axis stands for what its two parts sweep") {
    DisplayDescription display;
    display.kind = DisplayKind::RotatingPanel;
    display.slices = 8;
    display.cycles_per_second = 10.0;
    display.panels[0] = {.columns = 9, .rows = 1, .column_pitch_mm = 2.0};
    const std::vector<float> gains = even_pixel_gains(display);
    REQUIRE(gains.size() == 9);
    // A disc of radius 1, passed by one half at a time; and rings of 1 … 3 to 7 … 9, passed by two.
    CHECK(gains[4] / gains[8] == Approx(2.0 * (1.0 / 2.0) / ((81.0 - 49.0) / 2.0 / 2.0)));
    CHECK(gains[5] / gains[8] == Approx(2.0 / 8.0));
    CHECK(gains[3] == gains[5]);
}

TEST_CASE("even light of planes goes by the space between them") {
    for (const DisplayDescription& display : test::odd_displays()) {
        const std::vector<float> gains = even_slice_gains(display);
        REQUIRE(gains.size() == display.slices);
        const std::string name(display.name.view());
        if (name == "uneven-stack") {
            // Heights −11, −7.5, −4, 0.5, 6.
            CHECK(gains[0] == Approx(3.5 / 5.5));
            CHECK(gains[2] == Approx(4.0 / 5.5));
            CHECK(gains[3] == Approx(5.0 / 5.5));
            CHECK(gains[4] == 1.0f);
        } else if (name == "sine-sweep") {
            // What is swept while a slice is lit, by the formula.
            const auto height = [&](double part) { return -std::cos(3.14159265358979 * (0.05 + 0.9 * part)); };
            for (std::uint32_t s = 0; s < 9; ++s) {
                const double swept = height((s + 1) / 9.0) - height(s / 9.0);
                CHECK(gains[s] == Approx(swept / (height(5.0 / 9.0) - height(4.0 / 9.0))));
            }
        } else if (name == "table-sweep") {
            CHECK(gains[0] == Approx(0.2 / 0.5));
            CHECK(gains[1] == Approx(0.2 / 0.5));
            CHECK(gains[2] == 1.0f);
            CHECK(gains[4] == Approx(0.3 / 0.5));
        } else {
            CHECK(std::ranges::all_of(gains, [](float gain) { return gain == 1.0f; }));
        }
        if (display.kind != DisplayKind::RotatingPanel) CHECK(even_pixel_gains(display).empty());
    }
}

TEST_CASE("light is colour × gain × calibration × brightness × white balance") {
    for (DisplayDescription display : test::odd_displays()) {
        display.format = PixelFormat::Rgb888;
        CAPTURE(std::string(display.name.view()));
        const bool planes = display.kind == DisplayKind::StackedPlanes;
        const auto calibration = Calibration::parse(
            std::string(planes ? "plane" : "panel") + ",row,column,red,green,blue\n0,1,2,0.5,0.25,1\n", display);
        REQUIRE(calibration);
        const glm::dvec3 color(0.9, 0.8, 1.0);
        const LightSettings settings{
            .mode = LightMode::Even, .brightness = 0.9f, .white = {1.0f, 0.75f, 0.5f}, .calibration = &*calibration};
        const FramePainter painter(display, settings);
        BitVolume volume(painter.lattice().view());
        const Lattice lattice = painter.lattice().view();
        for (std::uint32_t k = 0; k < lattice.nz; ++k) {
            for (std::uint32_t y = 0; y < lattice.ny; ++y) {
                for (std::uint32_t x = 0; x < lattice.nx; ++x) volume.view().flip(x, y, k);
            }
        }
        const auto field = parse_color("expr: rgb(0.9, 0.8, 1)").value();
        std::vector<std::byte> frame(frame_bytes(display));
        REQUIRE(painter.paint(volume.view(), *field, frame) == Status::Ok);
        const std::vector<float> slices = even_slice_gains(display);
        const std::vector<float> pixels = even_pixel_gains(display);
        std::size_t pixel = 0;
        test::for_each_pixel(display, frame, [&](auto slice, auto p, auto row, auto column, std::uint32_t code) {
            const std::size_t of_slice = pixel++ % (frame_pixels(display) / display.slices);
            glm::dvec3 light = color * 0.9 * glm::dvec3(1.0, 0.75, 0.5) * static_cast<double>(slices[slice]);
            if (!pixels.empty()) light *= static_cast<double>(pixels[of_slice]);
            if (p == 0 && row == 1 && column == 2 && (!planes || slice == 0)) light *= glm::dvec3(0.5, 0.25, 1.0);
            for (int c = 0; c < 3; ++c) {
                REQUIRE(test::light_of(display, code, c) == Approx(light[c]).margin(0.51 / 255.0));
            }
        });
    }
}

TEST_CASE("no light at all is dark, and brightness can be changed between frames") {
    DisplayDescription display = test::odd_displays().front();
    display.format = PixelFormat::Mono4;
    FramePainter painter(display, {.brightness = 0.0f});
    BitVolume volume(painter.lattice().view());
    volume.view().flip(0, 0, 0);
    const auto white = parse_color("constant:white").value();
    std::vector<std::byte> frame(frame_bytes(display));
    REQUIRE(painter.paint(volume.view(), *white, frame) == Status::Ok);
    CHECK(frame[0] == std::byte{0});
    painter.set_brightness(0.4f);
    REQUIRE(painter.paint(volume.view(), *white, frame) == Status::Ok);
    CHECK(frame[0] == std::byte{6});
}

TEST_CASE("white of a colour temperature") {
    const auto largest = [](const glm::vec3& white) { return std::max({white.r, white.g, white.b}); };
    for (double kelvin = kLeastKelvin; kelvin <= kMostKelvin; kelvin += 100.0) {
        const glm::vec3 white = white_of_temperature(kelvin);
        CHECK(largest(white) == 1.0f);
        CHECK(std::min({white.r, white.g, white.b}) >= 0.0f);
    }
    // The white of sRGB is daylight of 6504 K, next to the black body of 6500 K.
    for (int c = 0; c < 3; ++c) CHECK(white_of_temperature(6500)[c] == Approx(1.0).margin(0.06));
    // Illuminant A, 2856 K: x = 0.44757, y = 0.40745 in linear sRGB's primaries.
    const double x = 0.44757 / 0.40745;
    const double z = (1.0 - 0.44757 - 0.40745) / 0.40745;
    const double red = 3.2406 * x - 1.5372 - 0.4986 * z;
    CHECK(white_of_temperature(2856).g == Approx((-0.9689 * x + 1.8758 + 0.0415 * z) / red).margin(0.01));
    CHECK(white_of_temperature(2856).b == Approx((0.0557 * x - 0.2040 + 1.0570 * z) / red).margin(0.01));
    CHECK(white_of_temperature(15000).b == 1.0f);
}
