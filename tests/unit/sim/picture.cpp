#include "sim/picture.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "sim/camera.h"
#include "sim/develop.h"
#include "sim/image.h"
#include "sim/label.h"
#include "sim/outline.h"
#include "sim/surface.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"

namespace xorvox {
namespace {

using namespace test;

/// Where the pixels are of which channel `strong` is bright and channel `weak` dark, in columns `from` … `to`: their
/// bounds, in pixels from the left and from the bottom.
struct Patch {
    glm::dvec2 lower{1e9};
    glm::dvec2 upper{-1e9};
    glm::dvec2 middle() const { return (lower + upper) / 2.0; }
};

Patch patch_of(const sim::Image& image, unsigned strong, unsigned weak, std::uint32_t from, std::uint32_t to) {
    Patch patch;
    for (std::uint32_t row = 0; row < image.height; ++row) {
        for (std::uint32_t column = from; column < to; ++column) {
            const std::uint8_t* pixel = image.rgb.data() + 3 * (std::size_t{row} * image.width + column);
            if (pixel[strong] < 70 || pixel[weak] > 40) continue;
            const glm::dvec2 place(column + 0.5, image.height - row - 0.5);
            patch.lower = glm::min(patch.lower, place);
            patch.upper = glm::max(patch.upper, place);
        }
    }
    REQUIRE(patch.lower.x < 1e9);
    return patch;
}

TEST_CASE("orthographic views are the right way round, at one scale, and as large as the light allows") {
    // A red voxel, and a blue one farther right, at the back and above.
    const DisplayDescription display = stack_of(30, 30, 30, PixelFormat::Rgb111);
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, {.slice = 4, .row = 2, .column = 6}, 1);
    set_pixel(display, page, {.slice = 6, .row = 6, .column = 12}, 4);
    const glm::dvec3 apart_mm(12.0, 12.0, 14.0);
    const std::uint32_t side = 200;
    const sim::Image image = sim::render_orthographic(display, sim::expose(display, page, 255), side).image;
    REQUIRE(image.width == 3 * side);
    REQUIRE(image.height == side);

    const int axes[3][2] = {{0, 2}, {1, 2}, {0, 1}};
    double scale = 0.0;
    for (std::uint32_t view = 0; view < 3; ++view) {
        INFO("view " << view);
        const Patch red = patch_of(image, 0, 2, view * side, (view + 1) * side);
        const Patch blue = patch_of(image, 2, 0, view * side, (view + 1) * side);
        const glm::dvec2 seen = blue.middle() - red.middle();
        const glm::dvec2 apart(apart_mm[axes[view][0]], apart_mm[axes[view][1]]);
        if (view == 0) scale = seen.x / apart.x;
        CHECK(seen.x == Approx(scale * apart.x).margin(3.0));
        CHECK(seen.y == Approx(scale * apart.y).margin(3.0));
    }
    const Patch red = patch_of(image, 0, 2, 0, side);
    const Patch blue = patch_of(image, 2, 0, 0, side);
    CHECK(blue.upper.y - red.lower.y > 0.8 * side);
    CHECK(red.lower.y > 0.02 * side);
    CHECK(blue.upper.y < 0.98 * side);
}

TEST_CASE("orthographic views fit their tiles, however long the object is") {
    const auto long_axis = GENERATE(0, 1, 2);
    const DisplayDescription display = stack_of(40, 40, 40);
    std::vector<std::byte> page = dark_page(display);
    for (std::uint32_t i = 0; i < 40; ++i) {
        const std::uint32_t place[3] = {long_axis == 0 ? i : 20, long_axis == 1 ? i : 20, long_axis == 2 ? i : 20};
        set_pixel(display, page, {.slice = place[2], .row = place[1], .column = place[0]}, 1);
    }
    const sim::Image image = sim::render_orthographic(display, sim::expose(display, page, 255), 240).image;
    const auto lit = [&](std::uint32_t column, std::uint32_t row) {
        return image.rgb[3 * (std::size_t{row} * image.width + column)] > 150;
    };
    for (std::uint32_t column = 0; column < image.width; ++column) {
        CHECK_FALSE(lit(column, 0));
        CHECK_FALSE(lit(column, image.height - 1));
    }
    // Three separate pieces of light, neither of which touches the border.
    std::uint32_t pieces = 0;
    bool before = false;
    for (std::uint32_t column = 0; column < image.width; ++column) {
        bool any = false;
        for (std::uint32_t row = 20; row < image.height; ++row) any = any || lit(column, row);
        pieces += any && !before;
        before = any;
        if (column == 0) CHECK_FALSE(any);
    }
    CHECK_FALSE(before);
    CHECK(pieces == 3);
}

TEST_CASE("orthographic views are labelled where there is room") {
    const auto ink = [](std::uint32_t side) {
        const sim::Image image = sim::render_orthographic(stack_of(4, 4, 4), {}, side).image;
        std::size_t bright = 0;
        for (const std::uint8_t value : image.rgb) bright += value > 90;
        return bright;
    };
    CHECK(ink(239) == 0);
    CHECK(ink(240) > 3 * 100);
}

TEST_CASE("a label is written where it is asked for, and cut at the film's edge") {
    sim::Film film{12, 10, std::vector<glm::vec4>(120)};
    sim::draw_label(film, "to", 1, 0, 1);
    const auto at = [&](std::uint32_t column, std::uint32_t row) { return film.pixels[row * 12 + column].x > 0.0f; };
    CHECK(at(1, 2));  // The bar of t,
    CHECK(at(4, 2));
    CHECK_FALSE(at(5, 2));
    CHECK(at(7, 4));  // and the left and right of o.
    CHECK_FALSE(at(9, 4));
    CHECK(at(11, 4));
    CHECK_FALSE(at(11, 9));
    sim::draw_label(film, "d", 10, 8, 3);
    CHECK_FALSE(at(0, 9));
}

TEST_CASE("a picture that frames the display shows where in it the light is, and where +x and the axis are") {
    const DisplayDescription display = rotor_of(30, 30, 90, PixelFormat::Rgb111, 1);
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, {.slice = 0, .row = 0, .column = 29}, 1);  // On the right, on top.
    const sim::LightField field = sim::expose(display, page, 255);
    const std::uint32_t side = 240;
    const auto share_of = [&](sim::Framing framing) {
        return sim::render_orthographic(display, field, side, framing).covered;
    };
    CHECK(share_of(sim::Framing::Display) < 0.02 * share_of(sim::Framing::Object));
    const sim::Image image = sim::render_orthographic(display, field, side, sim::Framing::Display).image;
    const Patch light = patch_of(image, 0, 2, 0, side);
    const glm::dvec2 seen = light.middle() / double{side};
    CHECK(seen.x > 0.65);
    CHECK(seen.y > 0.75);

    // The axis, from top to bottom of the front view, is lighter than what is beside it.
    const auto lightest = [&](std::uint32_t row) {
        std::uint32_t best = 10;
        const std::uint8_t* line = image.rgb.data() + 3 * std::size_t{row} * image.width;
        for (std::uint32_t column = 10; column < side / 2 + 20; ++column) {
            if (line[3 * column + 2] > line[3 * best + 2] + 10) best = column;
        }
        return best;
    };
    for (const std::uint32_t row : {60u, 120u, 180u, 220u}) CHECK(lightest(row) == Approx(lightest(120)).margin(1));
    CHECK(lightest(120) > side / 3);
}

std::vector<DisplayDescription> displays_of_all_kinds() {
    std::vector<DisplayDescription> all{stack_of(5, 4, 3),
                                        rotor_of(8, 4, 90),
                                        rotor_of(8, 4, 90),
                                        swept_of(5, 4, 9, MotionProfile::Constant),
                                        swept_of(5, 4, 9, MotionProfile::Sine),
                                        swept_of(5, 4, 9, MotionProfile::Table),
                                        helix_of(6, 5, 12, 2),
                                        points_of()};
    all[2].panels[0].tilt_deg = 25.0;
    all[2].panels[1].lift_mm = -9.0;
    all[2].panels[1].turned = 1;
    return all;
}

TEST_CASE("no voxel sticks out of the outline, and the outermost touch it") {
    for (const DisplayDescription& display : displays_of_all_kinds()) {
        INFO(display.name.view());
        const DisplayExtent space = sim::drawn_extent(display);
        const std::vector<std::byte> page(frame_bytes(display), std::byte{0xff});
        glm::dvec3 lowest(1e9);
        glm::dvec3 highest(-1e9);
        glm::dvec3 half(0.0);
        for (const sim::Voxel& voxel : sim::visible_voxels(display, sim::expose(display, page, 255))) {
            glm::dvec3 place = voxel.place_mm;
            half = double{sim::kVoxelFilling} * glm::dvec3(voxel.half_mm);
            if (space.radius_mm > 0.0) {
                place.x = place.y = glm::length(glm::dvec2(voxel.place_mm));
                half.y = half.x;
            }
            lowest = glm::min(lowest, place - half);
            highest = glm::max(highest, place + half);
        }
        for (int axis = 0; axis < 3; ++axis) {
            INFO("axis " << axis);
            CHECK(highest[axis] < space.upper[axis] + 1e-5);
            CHECK(highest[axis] > space.upper[axis] - 0.6 * half[axis]);
            if (space.radius_mm > 0.0 && axis < 2) continue;
            CHECK(lowest[axis] > space.lower[axis] - 1e-5);
            CHECK(lowest[axis] < space.lower[axis] + 0.6 * half[axis]);
        }
        glm::dvec3 widest(-1e9);
        for (const sim::Segment& segment : sim::outline(display)) widest = glm::max(widest, segment.from_mm);
        CHECK(glm::distance(widest, space.upper) < 1e-9);
    }
}

TEST_CASE("marks point to +x from the outline outwards, and the axis sticks out of what turns") {
    for (const DisplayDescription& display : displays_of_all_kinds()) {
        INFO(display.name.view());
        const DisplayExtent space = sim::drawn_extent(display);
        glm::dvec3 lowest(1e9);
        glm::dvec3 highest(-1e9);
        for (const sim::Segment& mark : sim::marks(display)) {
            lowest = glm::min(lowest, glm::min(mark.from_mm, mark.to_mm));
            highest = glm::max(highest, glm::max(mark.from_mm, mark.to_mm));
        }
        CHECK(highest.x > space.upper.x + 0.05 * (space.upper.x - space.lower.x));
        CHECK(lowest.x > space.lower.x);
        CHECK(highest.y < space.upper.y);
        const bool turns = display.kind == DisplayKind::RotatingPanel || display.kind == DisplayKind::Helix;
        CHECK((highest.z > space.upper.z) == turns);
    }
}

TEST_CASE("a lit block on any display has normals that point out of it, and no inside") {
    // Samples 1 mm apart or less in every direction; the light is a ball.
    std::vector<DisplayDescription> all{stack_of(40, 40, 40), swept_of(40, 40, 60, MotionProfile::Sine),
                                        helix_of(40, 40, 60, 2), rotor_of(40, 40, 120, PixelFormat::Mono1, 1)};
    all[0].plane_pitch_mm = 1.0;
    all[1].motion.stroke_mm = all[2].motion.stroke_mm = 40.0;
    all[3].panels[0].offset_mm = 0.0;
    for (DisplayDescription& display : all) {
        INFO(display.name.view());
        display.panels[0].column_pitch_mm = display.panels[0].row_pitch_mm = 1.0;
        const std::vector<std::byte> page(frame_bytes(display), std::byte{0xff});
        sim::LightField field = sim::expose(display, page, 255);
        std::erase_if(field.flashes, [](const sim::Flash& flash) { return glm::length(flash.place_mm) > 16.0; });
        const std::vector<sim::Voxel> voxels = sim::visible_voxels(display, field);
        CHECK(voxels.size() < field.flashes.size() * 3 / 4);
        std::size_t at_the_surface = 0;
        for (const sim::Voxel& voxel : voxels) {
            CHECK(glm::length(voxel.place_mm) > 9.0);
            if (glm::length(voxel.place_mm) < 14.8) continue;
            ++at_the_surface;
            CHECK(glm::dot(glm::dvec3(voxel.normal), glm::normalize(voxel.place_mm)) > 0.98);
        }
        CHECK(at_the_surface > 500);
    }
}

TEST_CASE("in an orthographic view the nearer voxel hides the farther one") {
    const DisplayDescription display = stack_of(3, 3, 3, PixelFormat::Rgb111);
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, {.slice = 1, .row = 0, .column = 1}, 1);  // red, in front
    set_pixel(display, page, {.slice = 1, .row = 2, .column = 1}, 4);  // blue, at the back
    const sim::Picture picture = sim::render_orthographic(display, sim::expose(display, page, 255), 90);
    const std::uint8_t* middle = picture.image.rgb.data() + 3 * (std::size_t{45} * picture.image.width + 45);
    CHECK(middle[0] > 120);
    CHECK(middle[2] < 60);
}

TEST_CASE("an orthographic view of nothing shows the empty display") {
    const sim::Picture picture = sim::render_orthographic(rotor_of(8, 4, 10), {}, 64);
    CHECK(picture.image.rgb.size() == 3u * 192u * 64u);
    CHECK(picture.covered == 0.0);
    CHECK(picture.clipped == 0.0);
}

TEST_CASE("flashes at one place are one voxel in the mean of their light") {
    const DisplayDescription display = rotor_of(8, 4, 10);
    sim::LightField field;
    field.pixels.format = PixelFormat::Rgb111;
    field.flashes.push_back({{3.0, 4.0, 2.0}, 0b001, 0});
    field.flashes.push_back({{9.0, -4.0, 6.0}, 0b010, 1});
    field.flashes.push_back({{3.0 + 1e-13, 4.0, 2.0 - 1e-13}, 0b100, 5});
    std::vector<sim::Voxel> voxels = sim::visible_voxels(display, field);
    REQUIRE(voxels.size() == 2);
    std::sort(voxels.begin(), voxels.end(), [](const auto& a, const auto& b) { return a.place_mm.x < b.place_mm.x; });
    CHECK(glm::distance(voxels[0].light, glm::vec3(0.5f, 0.0f, 0.5f)) < 1e-6f);
    CHECK(glm::distance(voxels[0].across, glm::vec2(0.6f, 0.8f)) < 1e-6f);
    CHECK(voxels[1].light == glm::vec3(0.0f, 1.0f, 0.0f));
}

TEST_CASE("normals of a lit ball point outwards and its inside is not drawn") {
    DisplayDescription display = stack_of(30, 20, 9);  // about a cube of 60 mm
    sim::LightField field;
    for (int x = 0; x < 30; ++x) {
        for (int y = 0; y < 20; ++y) {
            for (int z = 0; z < 9; ++z) {
                const glm::dvec3 place(-29.0 + 2.0 * x, -28.5 + 3.0 * y, -28.0 + 7.0 * z);
                if (glm::length(place) < 27.0) field.flashes.push_back({place, 1, 0});
            }
        }
    }
    const std::vector<sim::Voxel> voxels = sim::visible_voxels(display, field);
    CHECK(voxels.size() < field.flashes.size());
    std::size_t at_the_surface = 0;
    for (const sim::Voxel& voxel : voxels) {
        CHECK(glm::length(voxel.normal) == Approx(1.0f).margin(1e-3));
        if (glm::length(voxel.place_mm) < 24.0) continue;
        ++at_the_surface;
        CHECK(glm::dot(glm::dvec3(voxel.normal), glm::normalize(voxel.place_mm)) > 0.8);
        CHECK(voxel.open > 0.3f);
    }
    CHECK(at_the_surface > 100);
}

TEST_CASE("the fitted camera sees all targets and touches the border with some") {
    const std::vector<sim::Target> targets = {
        {{-40.0, 0.0, 3.0}, 1.0}, {{25.0, 10.0, -8.0}, 4.0}, {{0.0, -30.0, 20.0}, 2.0}, {{5.0, 5.0, 5.0}, 1.0}};
    const auto [azimuth, elevation] = GENERATE(table<double, double>({{0, 0}, {30, 22}, {-120, 60}, {200, -45}}));
    const sim::Camera camera = sim::fit_camera(targets, azimuth, elevation, 4.0 / 3.0);
    double widest = 0.0;
    for (const sim::Target& target : targets) {
        const glm::dvec3 seen = target.place_mm - camera.eye_mm;
        const double depth = glm::dot(seen, camera.forward);
        CHECK(depth > target.radius_mm);
        const double x = std::abs(glm::dot(seen, camera.right)) / (depth * camera.tan_x);
        const double y = std::abs(glm::dot(seen, camera.up)) / (depth * camera.tan_y);
        widest = std::max({widest, x, y});
    }
    CHECK(widest < 1.0);
    CHECK(widest > 0.8);
    CHECK(glm::dot(camera.right, camera.forward) == Approx(0.0).margin(1e-12));
    CHECK(glm::dot(camera.up, camera.forward) == Approx(0.0).margin(1e-12));
}

TEST_CASE("a camera at azimuth 0 stands in front, at 90 on the right") {
    const std::vector<sim::Target> targets = {{{0.0, 0.0, 0.0}, 1.0}};
    CHECK(sim::fit_camera(targets, 0.0, 0.0, 1.0).eye_mm.y < -2.0);
    CHECK(sim::fit_camera(targets, 90.0, 0.0, 1.0).eye_mm.x > 2.0);
    CHECK(sim::fit_camera(targets, 0.0, 60.0, 1.0).eye_mm.z > 2.0);
}

TEST_CASE("endless light is not clipped, and a dim object keeps its colour") {
    sim::Film film{32, 32, std::vector<glm::vec4>(1024)};
    for (std::size_t i = 0; i < 512; ++i) film.pixels[i] = {1000.0f, 1000.0f, 1000.0f, 1.0f};
    const sim::Image bright = sim::develop(film, 0.3f);
    CHECK(sim::clipped_share(bright) == 0.0);
    CHECK(sim::covered_share(film) == 0.5);
    for (std::size_t i = 0; i < 1024; ++i) film.pixels[i] = {0.1f, 0.0f, 0.0f, 1.0f};
    const sim::Image dim = sim::develop(film, 0.3f);
    CHECK(dim.rgb[0] > 70);
    CHECK(dim.rgb[1] <= 1);
}

TEST_CASE("a pixel that is no number is dark and harms no other") {
    sim::Film film{40, 30, std::vector<glm::vec4>(1200, glm::vec4(0.4f, 0.4f, 0.4f, 1.0f))};
    const std::vector<std::uint8_t> whole = sim::develop(film, 0.3f).rgb;
    const float broken = GENERATE(std::nanf(""), HUGE_VALF, -HUGE_VALF);
    film.pixels[5 * 40 + 7] = glm::vec4(broken);
    film.pixels[6 * 40 + 9].w = broken;
    const std::vector<std::uint8_t> rgb = sim::develop(film, 0.3f).rgb;
    CHECK(rgb[3 * (5 * 40 + 7)] + 40 < whole[3 * (5 * 40 + 7)]);
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        if (i / 3 == 5 * 40 + 7 || i / 3 == 6 * 40 + 9) continue;
        REQUIRE(std::abs(rgb[i] - whole[i]) < 20);
    }
}

TEST_CASE("strong light keeps its hue, and white is white") {
    const auto linear = [](std::uint8_t value) {
        const double code = value / 250.0;
        return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
    };
    for (const float strength : {0.3f, 1.0f, 3.0f}) {
        INFO("strength " << strength);
        const sim::Film gold{1, 1, {glm::vec4(strength, 0.68f * strength, 0.0f, 1.0f)}};
        const std::vector<std::uint8_t> shown = sim::develop(gold, 0.0f).rgb;
        CHECK(linear(shown[1]) / linear(shown[0]) == Approx(0.68).margin(0.02));
        CHECK(shown[2] <= 1);
        const sim::Film white{1, 1, {glm::vec4(strength, strength, strength, 1.0f)}};
        const std::vector<std::uint8_t> equal = sim::develop(white, 0.0f).rgb;
        CHECK(equal[0] == equal[1]);
        CHECK(equal[0] == equal[2]);
    }
}

TEST_CASE("a PNG file gives back the image, and equal images equal files") {
    sim::Image image{7, 3, {}};
    for (unsigned i = 0; i < 3 * 7 * 3; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i * 37));
    const std::vector<std::byte> file = sim::encode_png(image);
    CHECK(file == sim::encode_png(image));

    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_memory(&png, file.data(), file.size()) != 0);
    CHECK(png.width == 7);
    CHECK(png.height == 3);
    png.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> back(PNG_IMAGE_SIZE(png));
    REQUIRE(png_image_finish_read(&png, nullptr, back.data(), 0, nullptr) != 0);
    CHECK(back == image.rgb);
}

TEST_CASE("picture options out of range are refused in words") {
    sim::PictureOptions options;
    options.width = 5000;
    const auto too_wide = sim::render_perspective(stack_of(2, 2, 2), {}, options);
    REQUIRE_FALSE(too_wide.has_value());
    CHECK(too_wide.error().message.find("16 to 4096") != std::string::npos);
    options = {};
    options.elevation_deg = 90.0;
    CHECK_FALSE(sim::render_perspective(stack_of(2, 2, 2), {}, options).has_value());
}

}  // namespace
}  // namespace xorvox
