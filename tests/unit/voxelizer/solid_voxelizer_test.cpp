// SolidVoxelizer: the bits of voxelize_solid() from every kernel and number of threads.

#include <cmath>

#include "engines.h"
#include "meshes.h"
#include "oracle.h"
#include "tables.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

void check_engines(const Mesh& mesh, const Lattice& lattice) {
    const BitVolume expected = reference(mesh.view(), lattice);
    for (const SolidOptions& options : all_engines()) {
        INFO(name_of(options));
        SolidVoxelizer engine = engine_for(mesh.view(), lattice, options);
        BitVolume got(lattice);
        for (std::uint64_t& word : got.view().words) word = ~std::uint64_t{0};
        REQUIRE(engine.solid(got.view()) == Status::Ok);
        CHECK(difference(got, expected) == "");
    }
}

/// Triangles that share no edge: an open soup.
Mesh soup(IntegerPoints& points, int count, const glm::dvec3& scale = glm::dvec3(1.0)) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) add_triangle(mesh, points() * scale, points() * scale, points() * scale);
    return mesh;
}

}  // namespace

TEST_CASE("kernels and threads agree on closed meshes full of ties, on grids of any shape") {
    unsigned seed = 1000;
    for (const glm::uvec3& n : std::vector<glm::uvec3>{{1, 1, 1},
                                                       {3, 2, 1},
                                                       {1, 1, 70},
                                                       {8, 8, 8},
                                                       {33, 5, 64},
                                                       {20, 21, 65},
                                                       {64, 4, 100},
                                                       {65, 33, 9},
                                                       {129, 3, 80}}) {
        INFO(n.x << " x " << n.y << " x " << n.z);
        IntegerPoints points(seed++, glm::ivec3(-2), glm::ivec3(n) + 1);
        check_engines(tetrahedra(points, 40), integer_lattice(n));
    }
}

TEST_CASE("kernels and threads agree on open soups") {
    for (unsigned seed = 0; seed < 4; ++seed) {
        INFO(seed);
        IntegerPoints ties(seed, glm::ivec3(-2), glm::ivec3(24));
        check_engines(soup(ties, 300), integer_lattice({22, 23, seed < 2 ? 21u : 80u}));
        IntegerPoints anywhere(seed + 50, glm::ivec3(-2'000'000), glm::ivec3(24'000'000));
        check_engines(soup(anywhere, 300, glm::dvec3(1e-6)), integer_lattice({22, 23, seed < 2 ? 80u : 21u}));
    }
}

TEST_CASE("kernels and threads agree on thousands of small triangles of all sizes") {
    for (const int size : {1, 2, 3, 5, 9, 17, 30}) {
        INFO(size);
        IntegerPoints corners(static_cast<unsigned>(size), glm::ivec3(0), glm::ivec3(90'000));
        IntegerPoints offsets(7, glm::ivec3(-1000 * size), glm::ivec3(1000 * size));
        Mesh mesh;
        for (int i = 0; i < 1500; ++i) {
            const glm::dvec3 at = corners();
            add_triangle(mesh, (at + offsets()) / 1000.0, (at + offsets()) / 1000.0, (at + offsets()) / 1000.0);
        }
        check_engines(mesh, integer_lattice({90, 91, 92}));
    }
}

TEST_CASE("kernels agree where vertices are as far away as they may be, and at the limits of their arithmetic") {
    // A lattice of 16 has 2^16 units a pitch: reaches of 2^17, 2^25 and 2^30 units are 2, 512 and 16384 pitches.
    for (const double reach : {1.99, 2.0, 2.01, 20.0, 511.0, 512.0, 513.0, 5000.0, 16380.0}) {
        INFO(reach);
        const int thousandths = static_cast<int>(reach * 1000);
        IntegerPoints points(static_cast<unsigned>(thousandths), glm::ivec3(-thousandths), glm::ivec3(thousandths));
        const Mesh mesh = tetrahedra(points, 30, glm::dvec3(1e-3));
        check_engines(mesh, integer_lattice({16, 15, 14}));
        check_engines(mesh, integer_lattice({3, 16, 2}));
    }
}

TEST_CASE("kernels agree just below and just above the width at which 128 bits are needed") {
    // The product of a triangle's extents, each plus one, passes 2^61 near 2^20.33 units a side: 1.26 lattices.
    for (const int percent : {90, 120, 125, 126, 127, 130, 150, 160, 400}) {
        INFO(percent);
        const int side = 64 * percent * 10;
        IntegerPoints points(static_cast<unsigned>(percent), glm::ivec3(-side / 2), glm::ivec3(side / 2));
        Mesh mesh = tetrahedra(points, 12, glm::dvec3(1e-3));
        for (glm::dvec3& p : mesh.positions) p += 32.0;
        check_engines(mesh, integer_lattice({64, 64, 64}));
    }
}

TEST_CASE("kernels agree on slivers") {
    IntegerPoints points(3, glm::ivec3(-5), glm::ivec3(205));
    Mesh mesh;
    for (int i = 0; i < 120; ++i) {
        const glm::dvec3 a = points();
        const glm::dvec3 b = points();
        add_tetrahedron(mesh, {a, b, a + glm::dvec3(1e-3, 2e-3, -1e-3), b + glm::dvec3(0.0, 1e-3, 1e-3)});
        add_tetrahedron(mesh, {a, b, a + glm::dvec3(1.0, 0.0, 0.0), b + glm::dvec3(0.0, 1.0, 1.0)});
    }
    check_engines(mesh, integer_lattice({200, 190, 70}));
}

TEST_CASE("kernels agree on fans of coplanar triangles, flat, upright and slanted") {
    for (const glm::dvec3& slant : {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0.5, -0.25, 0)}) {
        Mesh mesh;
        const auto lift = [&](double x, double y, double z) { return glm::dvec3(x, y, z + slant.x * x + slant.y * y); };
        for (int i = 0; i < 48; ++i) {
            const double from = i * 0.1309;
            const double to = (i + 1) % 48 * 0.1309;
            const auto rim = [&](double angle, double z) {
                return lift(std::round(20 + 18 * std::cos(angle)), std::round(20 + 18 * std::sin(angle)), z);
            };
            for (const double z : {4.0, 30.0}) add_triangle(mesh, lift(20, 20, z), rim(from, z), rim(to, z));
            add_triangle(mesh, rim(from, 4), rim(to, 4), rim(to, 30));
            add_triangle(mesh, rim(from, 4), rim(to, 30), rim(from, 30));
        }
        check_engines(mesh, integer_lattice({40, 41, 70}));
        check_engines(mesh, integer_lattice({40, 41, 40}));
    }
}

TEST_CASE("kernels agree on polygons with holes") {
    const Mesh mesh =
        prism({{{1, 1}, {60, 2}, {63, 50}, {30, 62}, {2, 40}}, {{20, 20}, {40, 22}, {38, 40}, {18, 36}}}, 2.5, 30.0);
    check_engines(mesh, integer_lattice({66, 65, 33}));
    check_engines(mesh, integer_lattice({66, 65, 80}, {1.0, 1.0, 0.4}));
}

TEST_CASE("kernels and threads agree on lattices given by tables") {
    for (unsigned seed = 0; seed < 6; ++seed) {
        INFO(seed);
        const std::uint32_t nz = std::vector<std::uint32_t>{1, 5, 40, 64, 65, 150}[seed];
        const Tables tables = random_tables(seed, 30 + seed, 20, nz, seed < 3 ? 12 : 40);
        const int high = static_cast<int>(tables.z.back()) + 4;
        IntegerPoints points(seed, glm::ivec3(-3), glm::ivec3(44, 44, high));
        check_engines(tetrahedra(points, 30), tables.view());
        IntegerPoints far(seed + 9, glm::ivec3(-40000), glm::ivec3(44000, 44000, 1000 * high));
        check_engines(tetrahedra(far, 30, glm::dvec3(1e-3)), tables.view());
        IntegerPoints near(seed + 19, glm::ivec3(0), glm::ivec3(40000, 40000, 1000 * high));
        Mesh small;
        for (int i = 0; i < 400; ++i) {
            const glm::dvec3 at = near();
            add_triangle(small, at * 1e-3, (at + glm::dvec3(900, 200, 500)) * 1e-3,
                         (at + glm::dvec3(100, 800, 0)) * 1e-3);
        }
        check_engines(small, tables.view());
    }
}

TEST_CASE("all columns in one place are crossed like one") {
    Tables tables{.nx = 9000, .ny = 1, .plan = std::vector<glm::dvec2>(9000, {1.0, 1.0}), .z = {0.0, 1.0, 2.0}};
    check_engines(box_mesh({0.0, 0.0, 0.5}, {2.0, 2.0, 1.5}), tables.view());
}

TEST_CASE("rounds for want of room for events change no bit") {
    IntegerPoints points(77, glm::ivec3(-10), glm::ivec3(300));
    const Mesh mesh = tetrahedra(points, 60);
    const Tables tables = random_tables(5, 300, 80, 100, 250);
    for (const Lattice& lattice : {integer_lattice({290, 280, 100}), tables.view()}) {
        const BitVolume expected = reference(mesh.view(), lattice);
        for (const Kernel kernel : available_kernels()) {
            for (const unsigned threads : {1u, 3u}) {
                INFO(to_string(kernel) << ", " << threads);
                SolidVoxelizer engine =
                    engine_for(mesh.view(), lattice, {.kernel = kernel, .threads = threads, .event_bytes = 1});
                BitVolume got(lattice);
                SolidReport report;
                REQUIRE(engine.solid(got.view(), &report) == Status::Ok);
                CHECK(difference(got, expected) == "");
                CHECK(report.crossings > 50'000);
            }
        }
    }
}

TEST_CASE("a kernel is forced by its name") {
    CHECK(available_kernels().front() == Kernel::Scalar);
    CHECK(available_kernels().back() == best_kernel());
    for (const Kernel kernel : available_kernels()) {
        CHECK(kernel_named(to_string(kernel)) == kernel);
        CHECK(SolidVoxelizer({.kernel = kernel}).kernel() == kernel);
    }
    CHECK_FALSE(kernel_named("mmx").has_value());
#if defined(__x86_64__)
    CHECK(SolidVoxelizer({.kernel = Kernel::Neon}).kernel() == best_kernel());
#endif
}
