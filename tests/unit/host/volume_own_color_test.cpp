#include "driver/host/volume_color.h"

#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "driver/host/color_space.h"
#include "driver/host/label_color.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::host;

namespace {

std::shared_ptr<SampledVolume> two_voxels(VolumeKind kind) {
    auto volume = std::make_shared<SampledVolume>();
    volume->kind = kind;
    volume->nx = 2;
    volume->ny = 1;
    volume->nz = 1;
    return volume;
}

/// The voxels fill the box: their centres are at a quarter and three quarters.
glm::vec3 at(std::shared_ptr<const SampledVolume> volume, float x,
             std::optional<TransferFunction> transfer = std::nullopt) {
    glm::dmat4 to_volume(1.0);
    to_volume[3] = glm::dvec4(-0.5, -0.5, -0.5, 1.0);
    const VolumeColor field(std::move(volume), box_to_volume({0, 0, 0}, {2, 1, 1}, to_volume), std::move(transfer));
    const std::vector<glm::vec3> points{{x, 0.5f, 0.5f}};
    std::vector<glm::vec3> colors(1);
    field.evaluate(points, colors);
    return colors[0];
}

}  // namespace

TEST_CASE("volume colour: colours are those of the nearest voxel, dimmed by their opacity, and at the edge beyond it") {
    const auto volume = two_voxels(VolumeKind::Colors);
    volume->colors = {{255, 0, 0, 255}, {0, 255, 0, 51}};
    CHECK(at(volume, 0.1f) == glm::vec3(1, 0, 0));
    CHECK(at(volume, 0.49f) == glm::vec3(1, 0, 0));
    CHECK(at(volume, 0.51f) == glm::vec3(0, 0.2f, 0));
    CHECK(at(volume, -3.0f) == glm::vec3(1, 0, 0));
    CHECK(at(volume, 4.0f) == glm::vec3(0, 0.2f, 0));
}

TEST_CASE("volume colour: labels have the palette's colours, and others where it ends") {
    const auto volume = two_voxels(VolumeKind::Labels);
    volume->values = {1, 2};
    volume->palette = {{}, {0, 0, 255, 255}};
    CHECK(at(volume, 0.25f) == glm::vec3(0, 0, 1));
    const glm::vec3 ours = at(volume, 0.75f);
    CHECK(ours == glm::vec3(distinct_color(2)));
    volume->values = {16777216, 3};
    CHECK(at(volume, 0.25f) != at(volume, 0.75f));
}

TEST_CASE("volume colour: values go through the transfer function, mixed between the voxels") {
    const auto volume = two_voxels(VolumeKind::Scalar);
    volume->values = {100, 200};
    const TransferFunction grey({{100, glm::dvec3(0.0), 1.0}, {200, glm::dvec3(1.0), 1.0}});
    CHECK(at(volume, 0.25f, grey) == glm::vec3(0.0f));
    CHECK(at(volume, 0.5f, grey) == glm::vec3(0.5f));
    CHECK(at(volume, 0.75f, grey) == glm::vec3(1.0f));
    CHECK(at(volume, 0.25f) == glm::vec3(linear_from_hex(0x205cff)));
    CHECK(at(volume, 0.75f) == glm::vec3(linear_from_hex(0xffd400)));
}

TEST_CASE("volume colour: a volume that is placed anew has the colours of that place") {
    const auto values = two_voxels(VolumeKind::Scalar);
    values->values = {100, 200};
    const auto labels = two_voxels(VolumeKind::Labels);
    labels->values = {1, 2};
    const glm::dmat4 along = box_to_volume({0, 0, 0}, {2, 1, 1}, glm::translate(glm::dmat4(1.0), glm::dvec3(-0.5)));
    const glm::dmat4 moved = glm::translate(along, glm::dvec3(0.25, 0.0, 0.0));
    const std::vector<glm::vec3> points{{0.1f, 0.5f, 0.5f}, {0.4f, 0.5f, 0.5f}, {0.9f, 0.5f, 0.5f}};
    for (const auto& volume : {values, labels}) {
        VolumeColor field(volume, along);
        std::vector<glm::vec3> before(points.size()), after(points.size()), made(points.size());
        field.evaluate(points, before);
        field.set_placement(moved);
        field.evaluate(points, after);
        VolumeColor(volume, moved).evaluate(points, made);
        CHECK(after == made);
        CHECK(after != before);
    }
}

TEST_CASE("volume colour: binary volumes are white, everywhere the same") {
    const auto volume = two_voxels(VolumeKind::Binary);
    volume->values = {1, 0};
    CHECK(VolumeColor(volume, glm::dmat4(1.0)).constant() == glm::vec3(1.0f));
    CHECK(at(volume, 0.3f) == glm::vec3(1.0f));
}
