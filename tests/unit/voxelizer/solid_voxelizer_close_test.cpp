// Triangles whose plane passes through a sample, or one unit of the snapping grid's arithmetic above or below it: where
// an inexact product would show. Random triangles are never so close.

#include <cstdint>
#include <optional>
#include <random>

#include <glm/common.hpp>

#include "engines.h"
#include "meshes.h"
#include "oracle.h"
#include "tables.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

__extension__ typedef __int128 Wide;

struct Vector {
    std::int64_t x, y, z;
};

/// x·a + y·b = the greatest common divisor.
std::int64_t divide(std::int64_t a, std::int64_t b, std::int64_t& x, std::int64_t& y) {
    if (b == 0) {
        x = a < 0 ? -1 : 1;
        y = 0;
        return a < 0 ? -a : a;
    }
    std::int64_t u = 0;
    std::int64_t v = 0;
    const std::int64_t common = divide(b, a % b, u, v);
    x = v;
    y = u - a / b * v;
    return common;
}

Wide round_down(Wide n, Wide d) {
    const Wide quotient = n / d;
    return n % d != 0 && (n < 0) != (d < 0) ? quotient - 1 : quotient;
}

/// A third corner so that the triangle a, b, c has the origin inside of its projection, and the determinant of the
/// three is `determinant` times the smallest that they can have: nothing when these two do not allow it.
std::optional<Vector> third_corner(const Vector& b, const Vector& c, int determinant) {
    const Vector normal{b.y * c.z - b.z * c.y, b.z * c.x - b.x * c.z, b.x * c.y - b.y * c.x};
    if (normal.z == 0) return std::nullopt;
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::int64_t s = 0;
    std::int64_t z = 0;
    const std::int64_t common = divide(divide(normal.x, normal.y, x, y), normal.z, s, z);
    if (common == 0) return std::nullopt;
    // One solution; any whole number of b and c may be added to it.
    const Wide first[3] = {Wide{x} * s * determinant, Wide{y} * s * determinant, Wide{z} * determinant};
    constexpr Wide kMost = Wide{1} << 90;
    for (const Wide coordinate : first) {
        if (coordinate > kMost || coordinate < -kMost) return std::nullopt;
    }
    const Wide of_b = round_down(first[0] * c.y - first[1] * c.x, normal.z) + 1;
    const Wide of_c = round_down(Wide{b.x} * first[1] - Wide{b.y} * first[0], normal.z) + 1;
    const Wide a[3] = {first[0] - of_b * b.x - of_c * c.x, first[1] - of_b * b.y - of_c * c.y,
                       first[2] - of_b * b.z - of_c * c.z};
    for (const Wide coordinate : a) {
        if (coordinate > (1 << 29) || coordinate < -(1 << 29)) return std::nullopt;
    }
    return Vector{static_cast<std::int64_t>(a[0]), static_cast<std::int64_t>(a[1]), static_cast<std::int64_t>(a[2])};
}

/// An end of an edge from `a` that passes the origin, seen from above, at `determinant` times the smallest distance.
std::optional<Vector> other_end(const Vector& a, int determinant, std::int64_t z) {
    std::int64_t x = 0;
    std::int64_t y = 0;
    if (divide(a.x, a.y, x, y) == 0) return std::nullopt;
    // a.x · (determinant · x) - a.y · (-determinant · y) is that; going on along -a keeps it, and passes the origin.
    return Vector{-determinant * y - a.x, determinant * x - a.y, z};
}

/// Triangles with corners up to `reach` units from samples of a lattice, which stand at `sample(random)` units: the
/// plane of every other one is close to its sample, and an edge of the others.
template <class Sample>
Mesh close_triangles(unsigned seed, int count, std::int64_t reach, double units_per_length, const Sample& sample) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<std::int64_t> offset(-reach, reach);
    Mesh mesh;
    for (int tries = 0; tries < 4 * count && mesh.indices.size() < 3 * static_cast<std::size_t>(count); ++tries) {
        const Vector b{offset(random), offset(random), offset(random)};
        const Vector c{offset(random), offset(random), offset(random)};
        const int determinant = tries / 2 % 3 - 1;
        const std::optional<Vector> a =
            tries % 2 == 0 ? third_corner(b, c, determinant) : other_end(b, determinant, offset(random));
        if (!a) continue;
        const Vector at = sample(random);
        const auto corner = [&](const Vector& v) {
            return glm::dvec3(static_cast<double>(at.x + v.x), static_cast<double>(at.y + v.y),
                              static_cast<double>(at.z + v.z)) /
                   units_per_length;
        };
        add_triangle(mesh, corner(*a), corner(b), corner(c));
    }
    return mesh;
}

void check_kernels(const Mesh& mesh, const Lattice& lattice) {
    const BitVolume expected = reference(mesh.view(), lattice);
    for (const Kernel kernel : available_kernels()) {
        INFO(to_string(kernel));
        SolidVoxelizer engine = engine_for(mesh.view(), lattice, {.kernel = kernel});
        BitVolume got(lattice);
        REQUIRE(engine.solid(got.view()) == Status::Ok);
        CHECK(difference(got, expected) == "");
        // Triangles are cut at the borders of a region, and reach beyond it.
        const glm::uvec3 half = glm::max(whole(lattice).size / 2u, 1u);
        const Region region{whole(lattice).size - half, half};
        BitVolume part(half.x, half.y, half.z);
        REQUIRE(engine.solid(region, part.view()) == Status::Ok);
        CHECK(difference(part, part_of(expected, region)) == "");
    }
}

const std::vector<std::int64_t> kReaches{300,        20'000,     60'000,     66'000,    130'000,
                                         140'000,    1 << 18,    1 << 20,    3'000'000, 16'000'000,
                                         17'000'000, 33'000'000, 35'000'000, 1 << 27,   1 << 29};

}  // namespace

TEST_CASE("kernels agree on samples that triangles touch or miss by one unit, on regular lattices") {
    for (const std::uint32_t n : {8u, 16u, 32u, 64u, 128u}) {
        const std::int64_t pitch = (1 << 20) / n;
        const Lattice lattice{.nx = n, .ny = n, .nz = n};
        for (const std::int64_t reach : kReaches) {
            INFO(n << " samples, " << reach << " units");
            std::uniform_int_distribution<std::int64_t> index(0, n - 1);
            const auto sample = [&](std::mt19937& random) {
                return Vector{index(random) * pitch + pitch / 2, index(random) * pitch + pitch / 2,
                              index(random) * pitch + pitch / 2};
            };
            const auto seed = static_cast<unsigned>(reach + n);
            check_kernels(close_triangles(seed, 60, reach, static_cast<double>(pitch), sample), lattice);
            // Along the low border, where triangles stick out.
            const auto border = [&](std::mt19937& random) {
                const std::int64_t low = (index(random) & 7) * pitch + pitch / 2;
                return Vector{low, (index(random) & 7) * pitch + pitch / 2, index(random) * pitch + pitch / 2};
            };
            check_kernels(close_triangles(seed + 1, 60, reach, static_cast<double>(pitch), border), lattice);
        }
    }
}

TEST_CASE("kernels agree on samples that triangles touch or miss by one unit, on tables") {
    // A plan of 2^20 units a side, with its corners; samples every 2^13 units. Of few columns each has a lane of its
    // own.
    for (const std::uint32_t columns : {12u, 800u}) {
        Tables tables{.nx = columns, .ny = 1};
        std::mt19937 random(5);
        std::uniform_int_distribution<int> place(0, 1 << 20);
        for (std::uint32_t i = 0; i < columns; ++i) tables.plan.emplace_back(place(random), place(random));
        tables.plan[0] = {0.0, 0.0};
        tables.plan[1] = {1 << 20, 1 << 20};
        for (int k = 0; k <= 128; ++k) tables.z.push_back(k * 8192.0);
        for (const std::int64_t reach : kReaches) {
            INFO(columns << " columns, " << reach << " units");
            const auto sample = [&](std::mt19937& any) {
                const glm::dvec2& column = tables.plan[any() % tables.plan.size()];
                return Vector{static_cast<std::int64_t>(column.x), static_cast<std::int64_t>(column.y),
                              static_cast<std::int64_t>(any() % 129) * 8192};
            };
            check_kernels(close_triangles(static_cast<unsigned>(reach), 300, reach, 1.0, sample), tables.view());
        }
    }
}

TEST_CASE("kernels agree on a triangle whose heights are as far apart as they may be") {
    Tables tables{.nx = 33, .ny = 33};
    for (int y = 0; y < 33; ++y) {
        for (int x = 0; x < 33; ++x) tables.plan.emplace_back(x / 32.0, y / 32.0);
    }
    for (int k = 0; k <= 64; ++k) tables.z.push_back(k / 64.0);
    Mesh mesh;
    add_triangle(mesh, {0.486, 0.548, 1024.0}, {1.237, 1.167, -1024.0}, {-0.42, -0.66, 1.34});
    check_kernels(mesh, tables.view());
    Mesh upright;
    add_triangle(upright, {3.5, 3.25, 16384.0}, {9.5, 4.75, -16384.0}, {5.125, 11.5, 8.0});
    check_kernels(upright, Lattice{.nx = 64, .ny = 64, .nz = 64});
}
