#include "sim/picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <glm/geometric.hpp>

#include "driver/display/toml.h"
#include "driver/host/pattern.h"
#include "tests/catch.h"
#include "tests/gl/required.h"

namespace xorvox {
namespace {

/// A page in which the pixels in a ball around the origin are lit.
sim::LightField ball_on(const DisplayDescription& display, double radius_mm) {
    const std::vector<std::byte> white(frame_bytes(display), std::byte{0xff});
    sim::LightField field = sim::expose(display, white, 255);
    std::erase_if(field.flashes, [&](const sim::Flash& flash) { return glm::length(flash.place_mm) > radius_mm; });
    return field;
}

struct Scene {
    DisplayDescription display;
    sim::LightField field;
};

Scene scene_on(const char* preset) {
    const auto display = load_display(preset);
    REQUIRE(display.has_value());
    const double radius_mm = display->kind == DisplayKind::StackedPlanes ? 180.0 : 70.0;
    return {*display, ball_on(*display, radius_mm)};
}

int brightest(const sim::Image& image, std::uint32_t column, std::uint32_t row) {
    const std::uint8_t* pixel = image.rgb.data() + 3 * (std::size_t{row} * image.width + column);
    return std::max({pixel[0], pixel[1], pixel[2]});
}

TEST_CASE("a ball of light fills the picture as one solid, unclipped, before a dark ground") {
    const char* preset = GENERATE("cube16-ws2812", "vortex");
    INFO(preset);
    const Scene scene = scene_on(preset);
    const auto picture = sim::render_perspective(scene.display, scene.field);
    XORVOX_NEED_GL(picture);
    const sim::Image& image = picture->image;
    REQUIRE(image.width == 960);
    REQUIRE(image.height == 720);
    // A ball as large as fits into 4:3 covers 0.59 at most.
    CHECK(picture->covered > 0.45);
    CHECK(picture->covered < 0.6);
    CHECK(picture->clipped < 0.01);

    // No hole in the middle of it, dark corners that are not quite black, light from the upper left.
    for (std::uint32_t row = 200; row < 520; ++row) {
        for (std::uint32_t column = 320; column < 640; ++column) REQUIRE(brightest(image, column, row) > 60);
    }
    for (const std::uint32_t column : {0u, 959u}) {
        for (const std::uint32_t row : {0u, 719u}) {
            CHECK(brightest(image, column, row) > 4);
            CHECK(brightest(image, column, row) < 90);
        }
    }
    CHECK(brightest(image, 360, 240) > brightest(image, 600, 480) + 30);
}

/// The light of a pattern; of one that moves, the last of its frames.
sim::LightField light_of(const DisplayDescription& display, host::Pattern pattern) {
    std::vector<std::byte> frame(frame_bytes(display));
    host::paint_pattern(display, pattern, host::pattern_frames(display, pattern) - 1, frame);
    return sim::expose(display, frame, 255);
}

/// Whether a pixel is much darker than each of its neighbours.
bool is_speck(const sim::Image& image, std::uint32_t column, std::uint32_t row) {
    if (column == 0 || row == 0 || column + 1 == image.width || row + 1 == image.height) return false;
    int darkest = 255;
    for (std::uint32_t y = row - 1; y <= row + 1; ++y) {
        for (std::uint32_t x = column - 1; x <= column + 1; ++x) {
            if (x != column || y != row) darkest = std::min(darkest, brightest(image, x, y));
        }
    }
    return brightest(image, column, row) + 60 < darkest;
}

TEST_CASE("no pixel of a pattern's picture is black, neither light nor ground") {
    // A voxel that is seen from straight in front is where rounding once made a pixel that was no number, and black
    // everything below it and on its right.
    const auto [preset, pattern] = GENERATE(table<const char*, host::Pattern>(
        {{"cube8-595", host::Pattern::Orientation}, {"cube20-ws2812", host::Pattern::Axis}}));
    INFO(preset);
    const auto display = load_display(preset);
    REQUIRE(display.has_value());
    const auto picture = sim::render_perspective(*display, light_of(*display, pattern));
    XORVOX_NEED_GL(picture);
    const sim::Image& image = picture->image;
    std::size_t black = 0;
    std::size_t specks = 0;
    for (std::uint32_t row = 0; row < image.height; ++row) {
        for (std::uint32_t column = 0; column < image.width; ++column) {
            black += brightest(image, column, row) < 4;
            specks += is_speck(image, column, row);
        }
    }
    CHECK(black == 0);
    CHECK(specks == 0);
}

TEST_CASE("a picture that frames the display has all of its light in view, wherever it is") {
    const auto display = load_display("vortex");
    REQUIRE(display.has_value());
    sim::LightField corner{sim::PixelLight(*display), 255, {}};
    corner.flashes.push_back({{150.0, 0.0, 70.0}, 0xff, 0});
    sim::PictureOptions options{.width = 320, .height = 240, .azimuth_deg = 0.0};
    const auto near = sim::render_perspective(*display, corner, options);
    XORVOX_NEED_GL(near);
    options.framing = sim::Framing::Display;
    const auto whole = sim::render_perspective(*display, corner, options);
    REQUIRE(whole.has_value());
    CHECK(near->covered > 0.3);
    CHECK(whole->covered > 0.0);
    CHECK(whole->covered < 0.01);
    // A light far outside of the display is in the picture too.
    corner.flashes.push_back({{-900.0, 0.0, 0.0}, 0xff, 0});
    const auto wide = sim::render_perspective(*display, corner, options);
    REQUIRE(wide.has_value());
    int left = 0;
    for (std::uint32_t row = 0; row < 240; ++row) {
        for (std::uint32_t column = 0; column < 40; ++column) {
            left = std::max(left, brightest(wide->image, column, row));
        }
    }
    CHECK(left > 60);
}

TEST_CASE("pictures by EGL and OSMesa are nearly equal") {
    const Scene scene = scene_on("cube16-ws2812");
    sim::PictureOptions options{.width = 320, .height = 240};
    options.context = gl::ContextKind::Surfaceless;
    const auto by_egl = sim::render_perspective(scene.display, scene.field, options);
    XORVOX_NEED_GL(by_egl);
    options.context = gl::ContextKind::Osmesa;
    const auto by_osmesa = sim::render_perspective(scene.display, scene.field, options);
    XORVOX_NEED_GL(by_osmesa);
    CHECK(by_egl->drawn_by != by_osmesa->drawn_by);

    std::size_t different = 0;
    for (std::size_t i = 0; i < by_egl->image.rgb.size(); ++i) {
        different += std::abs(by_egl->image.rgb[i] - by_osmesa->image.rgb[i]) > 2;
    }
    CHECK(different < by_egl->image.rgb.size() / 1000);
}

TEST_CASE("the side that the camera is on is the side that is seen") {
    // A stack whose front half is red and back half blue.
    DisplayDescription display;
    display.format = PixelFormat::Rgb888;
    display.slices = 4;
    display.cycles_per_second = 60.0;
    display.panels[0] = {.columns = 4, .rows = 4};
    sim::LightField field = sim::expose(display, std::vector<std::byte>(frame_bytes(display), std::byte{0xff}), 255);
    for (sim::Flash& flash : field.flashes) {
        flash.code = flash.place_mm.y < 0.0 ? 0x0000ff : 0xff0000;
    }
    sim::PictureOptions options{.width = 120, .height = 90, .azimuth_deg = 0.0, .elevation_deg = 0.0};
    const auto front = sim::render_perspective(display, field, options);
    XORVOX_NEED_GL(front);
    options.azimuth_deg = 180.0;
    const auto back = sim::render_perspective(display, field, options);
    REQUIRE(back.has_value());
    const std::size_t middle = 3 * (45 * 120 + 60);
    CHECK(front->image.rgb[middle] > front->image.rgb[middle + 2] + 60);
    CHECK(back->image.rgb[middle + 2] > back->image.rgb[middle] + 60);
}

TEST_CASE("a picture of nothing shows the display's outline") {
    const auto display = load_display("vortex");
    REQUIRE(display.has_value());
    const auto picture = sim::render_perspective(*display, {}, {.width = 320, .height = 240});
    XORVOX_NEED_GL(picture);
    CHECK(picture->covered == 0.0);
    const auto [darkest, lightest] = std::minmax_element(picture->image.rgb.begin(), picture->image.rgb.end());
    CHECK(*lightest > *darkest + 20);
}

TEST_CASE("the same light gives the same picture") {
    const Scene scene = scene_on("cube16-ws2812");
    const sim::PictureOptions options{.width = 160, .height = 120};
    const auto once = sim::render_perspective(scene.display, scene.field, options);
    XORVOX_NEED_GL(once);
    const auto again = sim::render_perspective(scene.display, scene.field, options);
    REQUIRE(again.has_value());
    CHECK(once->image.rgb == again->image.rgb);
}

TEST_CASE("a single voxel is seen from near, from within the display") {
    // One voxel lit in a large stack: the camera stands within the display's box.
    DisplayDescription display;
    display.slices = 64;
    display.cycles_per_second = 60.0;
    display.panels[0] = {.columns = 64, .rows = 64};
    sim::LightField field;
    field.flashes.push_back({{31.5, -31.5, 31.5}, 1, 0});
    const auto picture = sim::render_perspective(display, field, {.width = 160, .height = 120});
    XORVOX_NEED_GL(picture);
    CHECK(picture->covered > 0.45);
}

}  // namespace
}  // namespace xorvox
