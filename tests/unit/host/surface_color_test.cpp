#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "driver/host/image_light.h"
#include "driver/host/surface_color.h"
#include "tests/catch.h"
#include "tests/unit/host/color_points.h"

using namespace xorvox;
using namespace xorvox::host;

namespace {

const glm::dvec3 kLower(-10, -20, -30);
const glm::dvec3 kUpper(10, 20, 30);

/// A place in millimetres as a point of the box.
glm::vec3 point(const glm::dvec3& mm) {
    return glm::vec3((mm - kLower) / (kUpper - kLower));
}

/// Two squares side by side in the plane z = 0, as four triangles: x from -8 to 0, and from 0 to 8.
Mesh two_squares() {
    Mesh mesh;
    mesh.positions = {{-8, -4, 0}, {0, -4, 0}, {8, -4, 0}, {-8, 4, 0}, {0, 4, 0}, {8, 4, 0}};
    mesh.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    return mesh;
}

Image checkers() {
    return {2, 2, {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 0}, {255, 255, 255, 255}}};
}

}  // namespace

TEST_CASE("colours of corners are mixed on the nearest place") {
    SurfaceColors colors;
    const Mesh mesh = two_squares();
    for (const std::uint32_t vertex : mesh.indices) {
        const glm::dvec3& p = mesh.positions[vertex];
        colors.corner_colors.emplace_back((p.x + 8.0) / 16.0, (p.y + 4.0) / 8.0, 0.25);
    }
    const SurfaceColor field(mesh.view(), colors, kLower, kUpper);
    for (const glm::vec3& at : color_points()) {
        const glm::dvec3 mm = kLower + glm::dvec3(at) * (kUpper - kLower);
        const glm::dvec3 expected((std::min(8.0, std::max(-8.0, mm.x)) + 8.0) / 16.0,
                                  (std::min(4.0, std::max(-4.0, mm.y)) + 4.0) / 8.0, 0.25);
        REQUIRE(glm::distance(glm::dvec3(color_of(field, at)), expected) < 1e-5);
    }
    std::vector<glm::vec3> points = color_points();
    std::vector<glm::vec3> whole(points.size());
    field.evaluate(points, whole);
    for (std::size_t i = 0; i < points.size(); ++i) REQUIRE(color_of(field, points[i]) == whole[i]);
    CHECK(hash_of(field) == 0xbfa98007cc546ed2);
}

TEST_CASE("a material has a factor and an image, and each face its material") {
    SurfaceColors colors;
    const Mesh mesh = two_squares();
    colors.images = {checkers()};
    colors.materials.resize(2);
    colors.materials[0].factor = {0.5f, 1.0f, 0.25f};
    colors.materials[1].image = 0;
    colors.face_materials = {0, 0, 1, 1};
    for (const std::uint32_t vertex : mesh.indices) {
        const glm::dvec3& p = mesh.positions[vertex];
        colors.corner_texcoords.emplace_back(p.x / 8.0, (4.0 - p.y) / 8.0);  // the upper left is at x = 0, y = 4
    }
    const SurfaceColor field(mesh.view(), colors, kLower, kUpper);
    const auto is_near = [&](const glm::dvec3& mm, const glm::vec3& color) {
        return glm::distance(color_of(field, point(mm)), color) < 1e-5f;
    };
    CHECK(is_near({-4, 0, 5}, {0.5f, 1.0f, 0.25f}));
    CHECK(is_near({2, 2, 5}, {1, 0, 0}));
    CHECK(is_near({6, 2, -5}, {0, 1, 0}));
    CHECK(is_near({2, -2, 5}, {0, 0, 1}));
    CHECK(is_near({6, -2, 5}, {1, 1, 1}));
    const glm::vec3 middle = color_of(field, point({4, 0, 5}));
    CHECK(middle.r == Approx(0.5f));
    CHECK(middle.g == Approx(0.5f));
}

TEST_CASE("what is missing is white") {
    const Mesh mesh = two_squares();
    CHECK(color_of(SurfaceColor(mesh.view(), {}, kLower, kUpper), {0.1f, 0.2f, 0.3f}) == glm::vec3(1.0f));
    CHECK(color_of(SurfaceColor(MeshView{}, {}, kLower, kUpper), {0.1f, 0.2f, 0.3f}) == glm::vec3(1.0f));
    SurfaceColors colors;
    colors.materials.resize(1);
    colors.materials[0].image = 0;
    colors.images = {checkers()};
    CHECK(color_of(SurfaceColor(mesh.view(), colors, kLower, kUpper), {0.1f, 0.2f, 0.3f}) == glm::vec3(1.0f));
}

TEST_CASE("colours go where the mesh goes") {
    Mesh mesh = two_squares();
    SurfaceColors colors;
    colors.materials.resize(2);
    colors.materials[0].factor = {1, 0, 0};
    colors.materials[1].factor = {0, 0, 1};
    colors.face_materials = {0, 0, 1, 1};
    SurfaceColor field(mesh.view(), colors, kLower, kUpper);
    CHECK(color_of(field, point({2, 0, 0})) == glm::vec3(0, 0, 1));
    for (glm::dvec3& p : mesh.positions) p.x += 5.0;
    field.set_positions(mesh.positions);
    CHECK(color_of(field, point({2, 0, 0})) == glm::vec3(1, 0, 0));
}

TEST_CASE("texture coordinates beyond an image repeat, mirror or stay at its border") {
    const auto place = [](double u, TextureWrap wrap) {
        const PixelPair pair = pixels_at(u, 4, wrap);
        return std::array{double(pair.first), double(pair.second), double(pair.share)};
    };
    using Place = std::array<double, 3>;
    for (const TextureWrap wrap : {TextureWrap::Repeat, TextureWrap::Mirror, TextureWrap::Clamp}) {
        CHECK(place(0.125, wrap) == Place{0, 1, 0});
        CHECK(place(0.5, wrap) == Place{1, 2, 0.5});
        for (const double far : {1e300, -1e300, std::nan("")}) {
            const PixelPair pair = pixels_at(far, 4, wrap);
            CHECK(pair.first < 4);
            CHECK(pair.second < 4);
        }
    }
    CHECK(place(0.0, TextureWrap::Repeat) == Place{3, 0, 0.5});
    CHECK(place(1.0, TextureWrap::Repeat) == Place{3, 0, 0.5});
    CHECK(place(-0.5, TextureWrap::Repeat) == Place{1, 2, 0.5});
    CHECK(place(0.9375, TextureWrap::Repeat) == Place{3, 0, 0.25});
    CHECK(place(7.375, TextureWrap::Repeat) == Place{1, 2, 0});
    CHECK(place(0.0, TextureWrap::Mirror) == Place{0, 0, 0.5});
    CHECK(place(-0.375, TextureWrap::Mirror) == Place{1, 2, 0});
    CHECK(place(1.375, TextureWrap::Mirror) == Place{2, 3, 0});
    CHECK(place(2.375, TextureWrap::Mirror) == Place{1, 2, 0});
    CHECK(place(-3.0, TextureWrap::Clamp) == Place{0, 0, 0.5});
    CHECK(place(1.5, TextureWrap::Clamp) == Place{3, 3, 0.5});
    const PixelPair alone = pixels_at(0.7, 1, TextureWrap::Repeat);
    CHECK(alone.first == 0);
    CHECK(alone.second == 0);
}
