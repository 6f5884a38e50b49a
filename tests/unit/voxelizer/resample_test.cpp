#include "voxelizer/resample.h"

#include <cmath>
#include <random>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/catch.h"

using namespace xorvox;

namespace {

SampledVolume make(VolumeKind kind, std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, unsigned seed) {
    std::mt19937 random(seed);
    SampledVolume volume;
    volume.kind = kind;
    volume.nx = nx;
    volume.ny = ny;
    volume.nz = nz;
    for (std::size_t n = 0; n < volume.voxel_count(); ++n) {
        if (kind == VolumeKind::Colors) {
            volume.colors.push_back({1, 2, 3, static_cast<std::uint8_t>(random() % 2)});
        } else if (kind == VolumeKind::Scalar) {
            volume.values.push_back(static_cast<float>(random() % 1000) / 100.0f);
        } else {
            volume.values.push_back(static_cast<float>(random() % 2));
        }
    }
    return volume;
}

Lattice regular(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) {
    Lattice lattice;
    lattice.nx = nx;
    lattice.ny = ny;
    lattice.nz = nz;
    lattice.origin = {-1.3, 0.7, -2};
    lattice.pitch = {0.31, 0.47, 0.23};
    return lattice;
}

/// Columns on circles, as a rotating panel has them.
struct Rotor {
    std::vector<glm::dvec2> plan;
    std::vector<double> z;
    Lattice lattice;

    Rotor() {
        for (int slice = 0; slice < 30; ++slice) {
            for (int led = 0; led < 20; ++led) {
                const double angle = 0.2094 * slice;
                plan.emplace_back(0.3 * (led + 0.5) * std::cos(angle), 0.3 * (led + 0.5) * std::sin(angle));
            }
        }
        for (int k = 0; k < 25; ++k) z.push_back(-3.0 + 0.25 * k);
        lattice.nx = 20;
        lattice.ny = 30;
        lattice.nz = 25;
        lattice.plan = plan;
        lattice.z = z;
    }
};

/// The definition, in other words than the code's: all eight voxels, by their weights.
bool inside_by_definition(const SampledVolume& volume, double threshold, const glm::dvec3& at) {
    const glm::ivec3 sides(volume.nx, volume.ny, volume.nz);
    glm::ivec3 nearest(0);
    for (int axis = 0; axis < 3; ++axis) {
        nearest[axis] = static_cast<int>(std::floor(at[axis] + 0.5));
        if (nearest[axis] < 0 || nearest[axis] >= sides[axis]) return false;
    }
    const auto index = [&](glm::ivec3 v) {
        v = glm::clamp(v, glm::ivec3(0), sides - 1);
        return volume.index(static_cast<std::uint32_t>(v.x), static_cast<std::uint32_t>(v.y),
                            static_cast<std::uint32_t>(v.z));
    };
    if (volume.kind == VolumeKind::Colors) return volume.colors[index(nearest)][3] != 0;
    if (volume.kind != VolumeKind::Scalar) return volume.values[index(nearest)] != 0.0f;
    const glm::dvec3 low = glm::floor(at);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, (corner >> 1) & 1, corner >> 2);
        double weight = 1.0;
        for (int axis = 0; axis < 3; ++axis) {
            const double part = at[axis] - low[axis];
            weight *= step[axis] == 1 ? part : 1.0 - part;
        }
        sum += weight * double{volume.values[index(glm::ivec3(low) + step)]};
    }
    return sum >= threshold;
}

std::size_t differences(const SampledVolume& volume, double threshold, const glm::dmat4& map, const Lattice& lattice,
                        unsigned threads, std::size_t* set = nullptr) {
    BitVolume bits(lattice);
    REQUIRE(resample(volume, threshold, map, lattice, bits.view(), threads) == Status::Ok);
    std::size_t wrong = 0;
    for (std::uint32_t z = 0; z < lattice.nz; ++z) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < lattice.nx; ++x) {
                const glm::dvec3 at(map * glm::dvec4(sample_position(lattice, x, y, z), 1.0));
                wrong += bits.test(x, y, z) != inside_by_definition(volume, threshold, at) ? 1u : 0u;
            }
        }
    }
    if (set != nullptr) *set = bits.count();
    return wrong;
}

glm::dmat4 askew() {
    glm::dmat4 map = glm::translate(glm::dmat4(1.0), glm::dvec3(3.1, 2.7, 4.3));
    map = glm::rotate(map, 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
    return glm::scale(map, glm::dvec3(1.3, -0.9, 1.1));
}

}  // namespace

TEST_CASE("resample: all kinds of volumes on all kinds of lattices are as defined") {
    const auto kind = GENERATE(VolumeKind::Binary, VolumeKind::Scalar, VolumeKind::Labels, VolumeKind::Colors);
    const SampledVolume volume = make(kind, 7, 6, 9, 5);
    const Rotor rotor;
    for (const glm::dmat4& map : {askew(), glm::translate(glm::dmat4(1.0), glm::dvec3(2.01, 1.02, 3.03))}) {
        for (const Lattice& lattice : {regular(130, 5, 11), regular(1, 9, 40), rotor.lattice}) {
            std::size_t set = 0;
            CHECK(differences(volume, 5.0, map, lattice, 1, &set) == 0);
            CHECK(set > lattice.sample_count() / 100);
            CHECK(set < lattice.sample_count());
        }
    }
}

TEST_CASE("resample: a place that rounds up to the end of a volume is beyond it") {
    const auto kind = GENERATE(VolumeKind::Binary, VolumeKind::Scalar, VolumeKind::Labels, VolumeKind::Colors);
    SampledVolume volume;
    volume.kind = kind;
    volume.nx = volume.ny = volume.nz = 1;
    if (kind == VolumeKind::Colors) {
        volume.colors = {{1, 2, 3, 255}};
    } else {
        volume.values = {1.0f};
    }
    Lattice lattice;
    lattice.nx = lattice.ny = lattice.nz = 1;
    lattice.origin = glm::dvec3(-0.5);
    constexpr double kBelowHalf = 0.49999999999999994;  // And half a voxel is 1, rounded.
    for (const glm::dvec3& at : {glm::dvec3(kBelowHalf, 0, 0), glm::dvec3(0, kBelowHalf, 0),
                                 glm::dvec3(0, 0, kBelowHalf), glm::dvec3(kBelowHalf)}) {
        std::size_t set = 0;
        CHECK(differences(volume, 1.0, glm::translate(glm::dmat4(1.0), at), lattice, 1, &set) == 0);
        CHECK(set == 0);
    }
    CHECK(differences(volume, 1.0, glm::translate(glm::dmat4(1.0), glm::dvec3(-0.5)), lattice, 1) == 0);
}

TEST_CASE("resample: any number of threads gives the same bits") {
    const SampledVolume volume = make(VolumeKind::Scalar, 7, 6, 9, 6);
    for (const unsigned threads : {2u, 3u, 16u, 100u}) {
        CHECK(differences(volume, 5.0, askew(), regular(70, 5, 11), threads) == 0);
    }
}

TEST_CASE("resample: a stop request ends it") {
    const SampledVolume volume = make(VolumeKind::Binary, 3, 3, 3, 4);
    const Lattice lattice = regular(70, 5, 11);
    BitVolume bits(lattice);
    std::stop_source stop;
    stop.request_stop();
    CHECK(resample(volume, 0.0, askew(), lattice, bits.view(), 2, stop.get_token()) == Status::Cancelled);
    CHECK(bits.count() == 0);
}

TEST_CASE("resample: on its own grid a volume is itself, and beyond it there is nothing") {
    const SampledVolume volume = make(VolumeKind::Binary, 65, 3, 4, 7);
    Lattice lattice;
    lattice.nx = 67;
    lattice.ny = 5;
    lattice.nz = 6;
    lattice.origin = glm::dvec3(-1.5);
    BitVolume bits(lattice);
    REQUIRE(resample(volume, 0.0, glm::dmat4(1.0), lattice, bits.view()) == Status::Ok);
    for (std::uint32_t z = 0; z < 6; ++z) {
        for (std::uint32_t y = 0; y < 5; ++y) {
            for (std::uint32_t x = 0; x < 67; ++x) {
                const bool within = x >= 1 && x <= 65 && y >= 1 && y <= 3 && z >= 1 && z <= 4;
                const bool expected = within && volume.values[volume.index(x - 1, y - 1, z - 1)] != 0.0f;
                REQUIRE(bits.test(x, y, z) == expected);
            }
        }
    }
}

TEST_CASE("resample: rows that are not asked for are not touched; those that are, are written whole") {
    const SampledVolume volume = make(VolumeKind::Binary, 9, 9, 9, 8);
    const Lattice lattice = regular(70, 4, 3);
    BitVolume whole(lattice);
    REQUIRE(resample(volume, 0.0, glm::dmat4(1.0), lattice, whole.view()) == Status::Ok);
    BitVolume bits(lattice);
    std::ranges::fill(bits.view().words, ~std::uint64_t{0});
    REQUIRE(resample_rows(volume, 0.0, glm::dmat4(1.0), lattice, {5, 2}, bits.view()) == Status::Ok);
    for (std::uint32_t row = 0; row < 12; ++row) {
        const auto words = bits.view().row(row % 4, row / 4);
        const auto expected = whole.view().row(row % 4, row / 4);
        for (std::size_t w = 0; w < words.size(); ++w) {
            CHECK(words[w] == (row == 5 || row == 6 ? expected[w] : ~std::uint64_t{0}));
        }
    }
}

TEST_CASE("resample: shapes that do not fit are refused") {
    const SampledVolume volume = make(VolumeKind::Scalar, 2, 2, 2, 9);
    const Lattice lattice = regular(4, 4, 4);
    BitVolume bits(lattice);
    BitVolume other(4, 4, 5);
    SampledVolume broken = volume;
    broken.values.pop_back();
    const glm::dmat4 map(1.0);
    CHECK(resample(volume, 0.0, map, lattice, other.view()) == Status::InvalidArgument);
    CHECK(resample(broken, 0.0, map, lattice, bits.view()) == Status::InvalidArgument);
    CHECK(resample(SampledVolume{}, 0.0, map, lattice, bits.view()) == Status::InvalidArgument);
    CHECK(resample(volume, 0.0, map, lattice, bits.view(), 0) == Status::InvalidArgument);
    CHECK(resample_rows(volume, 0.0, map, lattice, {15, 2}, bits.view()) == Status::InvalidArgument);
    const double nan = std::nan("");
    CHECK(resample(volume, 0.0, glm::dmat4(nan), lattice, bits.view()) == Status::Ok);
    CHECK(bits.count() == 0);
}

namespace {
double otsu(std::span<const float> values) {
    return otsu_threshold({&values, 1});
}
}  // namespace

TEST_CASE("otsu: the threshold parts two groups, and is the least value where there is one") {
    std::vector<float> values(900, 10.0f);
    values.insert(values.end(), 100, 200.0f);
    const double threshold = otsu(values);
    CHECK(threshold > 10.0);
    CHECK(threshold <= 200.0);
    CHECK(threshold == Approx(105.0).margin(2.0));
    CHECK(otsu(std::vector<float>(5, 3.0f)) == 3.0);
    CHECK(otsu({}) == 0.0);
    // Frames count together.
    const std::vector<float> low(30, 1.0f);
    const std::vector<float> high(10, 9.0f);
    const std::vector<std::span<const float>> frames{low, {}, high, low};
    CHECK(otsu_threshold(frames) == Approx(5.0).margin(0.1));
    CHECK(otsu_threshold({}) == 0.0);
    std::mt19937 random(1);
    values.clear();
    for (int n = 0; n < 20000; ++n) {
        const float blur = static_cast<float>(random() % 1000 + random() % 1000 + random() % 1000) / 100.0f;
        values.push_back(n % 4 == 0 ? 60.0f + blur : 10.0f + blur);
    }
    CHECK(otsu(values) == Approx(50.0).margin(5.0));
    const std::vector<float> extremes{-3e38f, 3e38f, 3e38f};
    CHECK(std::isfinite(otsu(extremes)));
}
