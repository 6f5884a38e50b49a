#include "sim/picture.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "sim/camera.h"
#include "sim/develop.h"
#include "sim/image.h"
#include "sim/surface.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"

namespace xorvox {
namespace {

using namespace test;

/// The middle of what is lit in columns `from` … `to` of an image, as shares of that part: 0 … 1 from the left and from
/// the bottom.
glm::dvec2 middle_of_light(const sim::Image& image, std::uint32_t from, std::uint32_t to) {
    glm::dvec2 sum(0.0);
    double weight = 0.0;
    for (std::uint32_t row = 0; row < image.height; ++row) {
        for (std::uint32_t column = from; column < to; ++column) {
            const std::uint8_t* pixel = image.rgb.data() + 3 * (std::size_t{row} * image.width + column);
            if (std::max({pixel[0], pixel[1], pixel[2]}) < 120) continue;
            sum += glm::dvec2((column - from + 0.5) / (to - from), 1.0 - (row + 0.5) / image.height);
            weight += 1.0;
        }
    }
    REQUIRE(weight > 0.0);
    return sum / weight;
}

TEST_CASE("orthographic views are the right way round") {
    // One lit voxel, to the right of, in front of and below the middle.
    const DisplayDescription display = stack_of(8, 8, 8, PixelFormat::Mono1);
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, {.slice = 1, .row = 2, .column = 6}, 1);
    const sim::Picture picture = sim::render_orthographic(display, sim::expose(display, page, 255), 160);
    REQUIRE(picture.image.width == 480);
    REQUIRE(picture.image.height == 160);

    // The longest side, 56 mm upwards, takes 92 % of each view.
    const auto share = [](double mm) { return 0.5 + 0.92 * mm / 56.0; };
    const glm::dvec3 place(5.0, -4.5, -17.5);
    const glm::dvec2 front = middle_of_light(picture.image, 0, 160);
    CHECK(front.x == Approx(share(place.x)).margin(0.01));
    CHECK(front.y == Approx(share(place.z)).margin(0.01));
    const glm::dvec2 side = middle_of_light(picture.image, 160, 320);
    CHECK(side.x == Approx(share(place.y)).margin(0.01));
    CHECK(side.y == Approx(share(place.z)).margin(0.01));
    const glm::dvec2 top = middle_of_light(picture.image, 320, 480);
    CHECK(top.x == Approx(share(place.x)).margin(0.01));
    CHECK(top.y == Approx(share(place.y)).margin(0.01));
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
    field.flashes.push_back({{3.0, 4.0, 2.0}, glm::vec3(1.0f, 0.0f, 0.0f), 1, 0});
    field.flashes.push_back({{9.0, -4.0, 6.0}, glm::vec3(0.0f, 1.0f, 0.0f), 1, 1});
    field.flashes.push_back({{3.0 + 1e-13, 4.0, 2.0 - 1e-13}, glm::vec3(0.0f, 0.0f, 1.0f), 1, 5});
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
                if (glm::length(place) < 27.0) field.flashes.push_back({place, glm::vec3(1.0f), 1, 0});
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
