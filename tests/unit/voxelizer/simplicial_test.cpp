// voxelize_simplicial and SimplicialCovering: the same bits as the columns', whatever the apex and the sweep.

#include "voxelizer/simplicial.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "meshes.h"
#include "oracle.h"
#include "simplicial_calls.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

constexpr std::array kSweeps{Axis::X, Axis::Y, Axis::Z};

/// Apexes of every kind for a lattice of samples at the integers, none further away than `farthest`.
std::vector<glm::dvec3> apexes(const Mesh& mesh, const glm::uvec3& n, double farthest) {
    const glm::dvec3 middle = 0.5 * glm::dvec3(n);
    const glm::dvec3 face_middle = (mesh.positions[0] + mesh.positions[1] + 2.0 * mesh.positions[2]) * 0.25;
    const glm::dvec3 beyond_edge = 3.0 * mesh.positions[4] - 2.0 * mesh.positions[5];
    std::vector<glm::dvec3> all{
        middle + glm::dvec3(0.1234, -0.321, 0.0711),          // Inside, off every sample.
        glm::dvec3(n / 2u),                                   // On a sample.
        mesh.positions[3],                                    // On a vertex.
        face_middle,                                          // On a face.
        glm::dvec3(-3.0, double(n.y) + 2.0, middle.z),        // Outside, in line with samples.
        glm::dvec3(-100.5, 77.25, -3.0),                      // Far outside.
        glm::dvec3(farthest, -farthest, farthest),            // As far as the grid goes.
        glm::dvec3(std::floor(middle.x), middle.y, farthest)  // The same along one axis.
    };
    // On the planes of two faces, outside of both.
    if (std::abs(beyond_edge.x) <= farthest && std::abs(beyond_edge.y) <= farthest &&
        std::abs(beyond_edge.z) <= farthest) {
        all.push_back(beyond_edge);
    }
    return all;
}

/// The farthest integer from the origin that the snapping grid of an integer lattice reaches.
double reach(const glm::uvec3& n) {
    return std::floor(static_cast<double>(kSnapLimit) / (1u << snap_grid(integer_lattice(n)).shift)) - 1.0;
}

void check_all(const Mesh& mesh, const Lattice& lattice, const std::vector<glm::dvec3>& apexes_to_try) {
    const BitVolume expected = voxelized(mesh.view(), lattice);
    for (const Axis sweep : kSweeps) {
        CHECK(difference(covered(mesh.view(), lattice, {.apex = {}, .sweep = sweep}), expected) == "");
        for (const glm::dvec3& apex : apexes_to_try) {
            CAPTURE(static_cast<int>(sweep), apex.x, apex.y, apex.z);
            CHECK(difference(covered(mesh.view(), lattice, {.apex = apex, .sweep = sweep}), expected) == "");
        }
    }
}

}  // namespace

TEST_CASE("the covering gives the columns' bits for every apex and sweep, on grids of any shape") {
    unsigned seed = 1;
    for (const glm::uvec3& n : std::vector<glm::uvec3>{{1, 1, 1},
                                                       {2, 1, 1},
                                                       {1, 1, 33},
                                                       {1, 9, 1},
                                                       {8, 8, 8},
                                                       {31, 5, 3},
                                                       {63, 2, 5},
                                                       {64, 4, 4},
                                                       {65, 5, 9},
                                                       {129, 3, 2},
                                                       {7, 33, 65},
                                                       {3, 130, 4}}) {
        CAPTURE(n.x, n.y, n.z);
        IntegerPoints points(seed++, glm::ivec3(-2), glm::ivec3(n) + 1);
        const Mesh mesh = tetrahedra(points, 8);
        check_all(mesh, integer_lattice(n), apexes(mesh, n, reach(n)));
    }
}

TEST_CASE("the covering settles ties as the oracle's rays do") {
    for (unsigned seed = 100; seed < 140; ++seed) {
        CAPTURE(seed);
        IntegerPoints points(seed, glm::ivec3(-1), glm::ivec3(6));
        const Mesh mesh = tetrahedra(points, 5);
        const Lattice lattice = integer_lattice({6, 5, 7});
        const BitVolume expected = oracle(mesh.view(), lattice, Ray::X);
        for (const Axis sweep : kSweeps) {
            const glm::dvec3 apex = points();
            CAPTURE(static_cast<int>(sweep), apex.x, apex.y, apex.z);
            CHECK(difference(covered(mesh.view(), lattice, {.apex = apex, .sweep = sweep}), expected) == "");
        }
    }
}

TEST_CASE("the covering gives the columns' bits for vertices anywhere between the samples") {
    for (unsigned seed = 200; seed < 210; ++seed) {
        CAPTURE(seed);
        IntegerPoints points(seed, glm::ivec3(-3'000'000), glm::ivec3(12'000'000));
        const Mesh mesh = tetrahedra(points, 6, glm::dvec3(1e-6));
        check_all(mesh, integer_lattice({10, 9, 11}), apexes(mesh, {10, 9, 11}, 1000.0));
    }
}

TEST_CASE("the covering is exact on triangles as large as the snapping grid") {
    const glm::uvec3 n(16, 15, 13);
    const Lattice lattice = integer_lattice(n);
    for (unsigned seed = 300; seed < 315; ++seed) {
        CAPTURE(seed);
        IntegerPoints far(seed, glm::ivec3(-16'383), glm::ivec3(16'383));
        IntegerPoints near(seed, glm::ivec3(0), glm::ivec3(15));
        Mesh mesh;
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 p = near();
            const glm::dvec3 q = far();
            add_tetrahedron(mesh, {q, 2.0 * p - q * 0.5, far(), i % 2 == 0 ? p : far()});
        }
        std::vector<glm::dvec3> all = apexes(mesh, n, reach(n));
        all.push_back(far());
        check_all(mesh, lattice, all);
    }
}

TEST_CASE("the covering is exact on small triangles with an apex at each corner of the snapping grid") {
    const glm::uvec3 n(12, 13, 14);
    IntegerPoints points(400, glm::ivec3(-1), glm::ivec3(14));
    const Mesh mesh = tetrahedra(points, 6);
    const double far = reach(n);
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? far : -far, i & 2 ? far : -far, i & 4 ? far : -far);
    check_all(mesh, integer_lattice(n), corners);
}

TEST_CASE("slivers and coplanar fans change nothing in the covering") {
    const glm::uvec3 n(20, 19, 18);
    Mesh mesh;
    add_tetrahedron(mesh, {glm::dvec3(0, 0, 0), glm::dvec3(19, 18, 17), glm::dvec3(19, 18, 16), glm::dvec3(1, 0, 0)});
    add_tetrahedron(mesh,
                    {glm::dvec3(-5, 3, 3), glm::dvec3(25, 3, 3), glm::dvec3(25, 3.0001, 3), glm::dvec3(25, 3, 4)});
    add_tetrahedron(mesh,
                    {glm::dvec3(9, -5, 9), glm::dvec3(9, 25, 9), glm::dvec3(9.0001, 25, 9), glm::dvec3(9, 25, 10)});
    // A box whose lid is a fan of twelve triangles around a point on it, all through samples.
    Mesh box = box_mesh(glm::dvec3(2.0), glm::dvec3(15.0));
    for (const std::uint32_t i : box.indices)
        mesh.indices.push_back(i + static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.insert(mesh.positions.end(), box.positions.begin(), box.positions.end());
    for (int i = 0; i < 24; ++i) {
        // Flat tetrahedra in the plane z = 15: each sample on it is in an even number of their faces.
        IntegerPoints in_plane(static_cast<unsigned>(500 + i), glm::ivec3(0, 0, 15), glm::ivec3(18, 18, 15));
        add_tetrahedron(mesh, {in_plane(), in_plane(), in_plane(), in_plane()});
    }
    std::vector<glm::dvec3> all = apexes(mesh, n, 5000.0);
    all.emplace_back(4.0, 5.0, 15.0);
    check_all(mesh, integer_lattice(n), all);
}

TEST_CASE("a pitch that differs by axis changes no bit of the covering") {
    IntegerPoints points(600, glm::ivec3(-2), glm::ivec3(14));
    const Mesh unit = tetrahedra(points, 10);
    const BitVolume expected = voxelized(unit.view(), integer_lattice({13, 12, 11}));
    for (const glm::dvec3& pitch :
         {glm::dvec3(0.1, 3.0, 7.0), glm::dvec3(1e3, 1e-3, 1.0), glm::dvec3(1.0, 1.0, 25.4)}) {
        Mesh mesh = unit;
        for (glm::dvec3& p : mesh.positions) p *= pitch;
        for (const Axis sweep : kSweeps) {
            const SimplicialOptions options{.apex = glm::dvec3(5.0, -20.0, 6.0) * pitch, .sweep = sweep};
            CHECK(difference(covered(mesh.view(), integer_lattice({13, 12, 11}, pitch), options), expected) == "");
        }
    }
}

TEST_CASE("the covering of polygons with holes gives the columns' bits") {
    const Mesh mesh = prism({{{1, 1}, {17, 2}, {16, 9}, {19, 17}, {2, 16}, {5, 9}},
                             {{6, 5}, {12, 6}, {9, 9}},
                             {{7, 12}, {11, 11}, {12, 15}, {8, 14}}},
                            1.0, 12.0);
    check_all(mesh, integer_lattice({20, 19, 14}), apexes(mesh, {20, 19, 14}, 4000.0));
    // The same polygons, slanted.
    Mesh slanted = mesh;
    for (glm::dvec3& p : slanted.positions) p = {p.x, p.y + 0.5 * p.z, p.z + 0.25 * p.x - 0.125 * p.y};
    check_all(slanted, integer_lattice({20, 27, 18}), apexes(slanted, {20, 27, 18}, 4000.0));
}

TEST_CASE("where a mesh intersects itself, the covering leaves samples inside twice outside") {
    Mesh mesh = box_mesh({0.5, 0.5, 0.5}, {6.5, 6.5, 6.5});
    add_box(mesh, {3.5, 3.5, 3.5}, {9.5, 9.5, 9.5});
    const BitVolume got = covered(mesh.view(), integer_lattice({11, 11, 11}));
    CHECK(got.count() == 2 * (6 * 6 * 6 - 3 * 3 * 3));
    CHECK_FALSE(got.test(5, 5, 5));
}

TEST_CASE("the sweep changes no bit of an open mesh") {
    for (unsigned seed = 700; seed < 720; ++seed) {
        CAPTURE(seed);
        IntegerPoints points(seed, glm::ivec3(-2), glm::ivec3(9));
        Mesh mesh;
        for (int i = 0; i < 12; ++i) add_triangle(mesh, points(), points(), points());
        const glm::dvec3 apex = points();
        const Lattice lattice = integer_lattice({8, 9, 7});
        const BitVolume expected = covered(mesh.view(), lattice, {.apex = apex, .sweep = Axis::Y});
        CHECK(difference(covered(mesh.view(), lattice, {.apex = apex, .sweep = Axis::X}), expected) == "");
        CHECK(difference(covered(mesh.view(), lattice, {.apex = apex, .sweep = Axis::Z}), expected) == "");
    }
}

TEST_CASE("one tetrahedron covers the samples that its four faces enclose") {
    // An open mesh of one face: the oracle sees the tetrahedron's whole boundary.
    for (unsigned seed = 800; seed < 900; ++seed) {
        CAPTURE(seed);
        IntegerPoints points(seed, glm::ivec3(-4), glm::ivec3(12));
        const Corners corners{points(), points(), points(), points()};
        Mesh face;
        add_triangle(face, corners[1], corners[2], corners[3]);
        Mesh boundary;
        add_tetrahedron(boundary, corners);
        const Lattice lattice = integer_lattice({9, 8, 10});
        const BitVolume expected = oracle(boundary.view(), lattice);
        for (const Axis sweep : kSweeps) {
            SimplicialReport report;
            const BitVolume got = covered(face.view(), lattice, {.apex = corners[0], .sweep = sweep}, &report);
            CHECK(difference(got, expected) == "");
            CHECK(report.covered == expected.count());
            CHECK(report.tetrahedra <= 1);
        }
    }
}

TEST_CASE("the default apex is the mean of the faces' corners on the snapping grid") {
    const Lattice lattice = integer_lattice({16, 16, 16});  // 2^16 units a sample.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {8, 0, 0}, {0, 6, 0}, {0, 0, 4}, {1e30, 0, 0}};  // The last is not used.
    mesh.indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    SimplicialReport report;
    (void)covered(mesh.view(), lattice, {}, &report);
    const auto unit = [](double sample) { return static_cast<int>((sample + 0.5) * 65536.0); };
    CHECK(report.apex == glm::ivec3(unit(2.0), unit(1.5), unit(1.0)));
    CHECK(report.tetrahedra == 4);

    // Unwelded, the corners are the same; seven corners 2^-16 apart are rounded to the nearest unit.
    Mesh soup;
    for (const std::uint32_t index : mesh.indices) soup.positions.push_back(mesh.positions[index]);
    for (std::uint32_t i = 0; i < soup.positions.size(); ++i) soup.indices.push_back(i);
    (void)covered(soup.view(), lattice, {}, &report);
    CHECK(report.apex == glm::ivec3(unit(2.0), unit(1.5), unit(1.0)));
    Mesh small;
    small.positions = {{0, 0, 0}, {0, 0, 0}, {0x1p-16, 0x1p-15, -0x1p-15}};
    small.indices = {0, 1, 2};
    (void)covered(small.view(), lattice, {}, &report);
    CHECK(report.apex == glm::ivec3(unit(0), unit(0) + 1, unit(0) - 1));
}

TEST_CASE("a mesh without faces covers nothing") {
    SimplicialReport report;
    CHECK(covered(MeshView{}, integer_lattice({5, 6, 7}), {}, &report).count() == 0);
    CHECK(report.tetrahedra == 0);
    CHECK(report.covered == 0);
}

TEST_CASE("triangles added one at a time give the bits of the whole mesh") {
    IntegerPoints points(900, glm::ivec3(-2), glm::ivec3(70));
    const Mesh mesh = tetrahedra(points, 10);
    const Lattice lattice = integer_lattice({70, 66, 13});
    const glm::dvec3 apex(1.5, 2.5, 30.0);
    for (const Axis sweep : kSweeps) {
        SimplicialReport report;
        const BitVolume expected = covered(mesh.view(), lattice, {.apex = apex, .sweep = sweep}, &report);
        BitVolume out(lattice);
        for (std::uint64_t& word : out.view().words) word = ~std::uint64_t{0};
        SimplicialCovering covering;
        REQUIRE(covering.start(lattice, apex, sweep, out.view()) == Status::Ok);
        // Last face first, turned round: neither order nor orientation matters.
        for (std::size_t i = mesh.indices.size(); i > 0; i -= 3) {
            const auto corner = [&](std::size_t back) { return mesh.positions[mesh.indices[i - back]]; };
            REQUIRE(covering.add(corner(1), corner(2), corner(3)) == Status::Ok);
        }
        CHECK(difference(out, expected) == "");
        CHECK(covering.tetrahedra() == report.tetrahedra);
        CHECK(covering.covered() == report.covered);

        REQUIRE(covering.start(lattice, apex, sweep, out.view()) == Status::Ok);
        CHECK(out.count() == 0);
        CHECK(covering.covered() == 0);
    }
}

TEST_CASE("a triangle with a corner beyond the snapping grid is refused and flips nothing") {
    const Lattice lattice = integer_lattice({9, 9, 9});
    BitVolume out(lattice);
    SimplicialCovering covering;
    REQUIRE(covering.start(lattice, glm::dvec3(4.0), Axis::Y, out.view()) == Status::Ok);
    for (const double bad : {1e9, std::numeric_limits<double>::quiet_NaN()}) {
        CHECK(covering.add({0, 0, 0}, {9, 0, 0}, {0, bad, 9}) == Status::OutOfRange);
    }
    CHECK(out.count() == 0);
    CHECK(covering.add({0, 0, 0}, {9, 0, 0}, {0, 0, 9}) == Status::Ok);
    CHECK(out.count() > 0);
}
