// voxelize_solid on regular lattices against the oracle.

#include <cmath>

#include "meshes.h"
#include "oracle.h"
#include "tests/catch.h"
#include "voxelizer/voxelize.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

const std::vector<glm::uvec3> kShapes{{1, 1, 1},  {2, 1, 1},  {1, 1, 33}, {8, 8, 8},  {31, 5, 3},  {32, 3, 4},
                                      {33, 4, 5}, {63, 2, 5}, {64, 4, 4}, {65, 5, 9}, {129, 3, 2}, {7, 33, 65}};

std::string name_of(const glm::uvec3& n) {
    return std::to_string(n.x) + " x " + std::to_string(n.y) + " x " + std::to_string(n.z);
}

bool padding_is_clear(const ConstBitVolumeView& volume) {
    for (std::uint32_t z = 0; z < volume.nz; ++z) {
        for (std::uint32_t y = 0; y < volume.ny; ++y) {
            if (volume.nx % 64 != 0 && volume.row(y, z).back() >> (volume.nx % 64) != 0) return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("samples on faces, edges and vertices get the oracle's bits on grids of any shape") {
    unsigned seed = 1;
    for (const glm::uvec3& n : kShapes) {
        INFO(name_of(n));
        const glm::ivec3 reach = glm::ivec3(n) + 1;
        IntegerPoints points(seed++, glm::ivec3(-2), reach);
        const Mesh mesh = tetrahedra(points, 8);
        const Lattice lattice = integer_lattice(n);
        const BitVolume got = voxelized(mesh.view(), lattice);
        CHECK(difference(got, oracle(mesh.view(), lattice)) == "");
        CHECK(padding_is_clear(got.view()));
    }
}

TEST_CASE("rays along every axis agree on closed meshes full of ties") {
    for (unsigned seed = 100; seed < 140; ++seed) {
        INFO(seed);
        IntegerPoints points(seed, glm::ivec3(-1), glm::ivec3(6));
        const Mesh mesh = tetrahedra(points, 5);
        const Lattice lattice = integer_lattice({6, 5, 7});
        const BitVolume got = voxelized(mesh.view(), lattice);
        CHECK(difference(got, oracle(mesh.view(), lattice, Ray::X)) == "");
        CHECK(difference(got, oracle(mesh.view(), lattice, Ray::Y)) == "");
        CHECK(difference(got, oracle(mesh.view(), lattice, Ray::Z)) == "");
    }
}

TEST_CASE("vertices anywhere between the samples get the oracle's bits") {
    for (unsigned seed = 200; seed < 210; ++seed) {
        INFO(seed);
        IntegerPoints points(seed, glm::ivec3(-3'000'000), glm::ivec3(12'000'000));
        const Mesh mesh = tetrahedra(points, 6, glm::dvec3(1e-6));
        const Lattice lattice = integer_lattice({10, 9, 11});
        CHECK(difference(voxelized(mesh.view(), lattice), oracle(mesh.view(), lattice)) == "");
    }
}

TEST_CASE("a pitch that differs by axis changes no bit") {
    IntegerPoints points(300, glm::ivec3(-2), glm::ivec3(14));
    const Mesh unit = tetrahedra(points, 10);
    const BitVolume expected = voxelized(unit.view(), integer_lattice({13, 12, 11}));
    for (const glm::dvec3& pitch :
         {glm::dvec3(0.1, 3.0, 7.0), glm::dvec3(1e3, 1e-3, 1.0), glm::dvec3(1.0, 1.0, 25.4)}) {
        Mesh mesh = unit;
        for (glm::dvec3& p : mesh.positions) p *= pitch;
        const Lattice lattice = integer_lattice({13, 12, 11}, pitch);
        const BitVolume got = voxelized(mesh.view(), lattice);
        CHECK(difference(got, expected) == "");
        CHECK(difference(got, oracle(mesh.view(), lattice)) == "");
    }
}

TEST_CASE("models a millionth and a million units in size get the oracle's bits") {
    IntegerPoints points(400, glm::ivec3(-2), glm::ivec3(14));
    const Mesh unit = tetrahedra(points, 10);
    for (const double size : {1e-6, 1e-3, 1.0, 1e6, 1e12}) {
        INFO(size);
        Mesh mesh = unit;
        for (glm::dvec3& p : mesh.positions) p *= size / 16.0;
        const Lattice lattice = integer_lattice({13, 12, 11}, glm::dvec3(size / 16.0));
        CHECK(difference(voxelized(mesh.view(), lattice), oracle(mesh.view(), lattice, Ray::X)) == "");
    }
}

TEST_CASE("columns start inside a solid that begins below the lattice") {
    const Mesh mesh = box_mesh({1.5, 1.5, -100.0}, {5.5, 6.5, 3.5});
    const Lattice lattice = integer_lattice({8, 8, 8});
    const BitVolume got = voxelized(mesh.view(), lattice);
    CHECK(got.test(2, 2, 0));
    CHECK(got.count() == 4 * 5 * 4);
    CHECK(difference(got, oracle(mesh.view(), lattice)) == "");
}

TEST_CASE("solids beside, above and below the lattice leave it clear, one around it fills it") {
    const Lattice lattice = integer_lattice({9, 8, 7});
    for (const glm::dvec3& to :
         {glm::dvec3(-20, 0, 0), glm::dvec3(20, 0, 0), glm::dvec3(0, -20, 0), glm::dvec3(0, 20, 0),
          glm::dvec3(0, 0, -20), glm::dvec3(0, 0, 20), glm::dvec3(20, 20, 20)}) {
        CHECK(voxelized(box_mesh(to - 1.0, to + 10.0).view(), lattice).count() == 0);
    }
    CHECK(voxelized(box_mesh(glm::dvec3(-1.0), glm::dvec3(9.0)).view(), lattice).count() == 9 * 8 * 7);
}

TEST_CASE("a mesh without faces gives a clear volume") {
    CHECK(voxelized(MeshView{}, integer_lattice({5, 6, 7})).count() == 0);
}

TEST_CASE("nested solids alternate between inside and outside") {
    Mesh mesh = box_mesh(glm::dvec3(0.0), glm::dvec3(12.0));
    add_box(mesh, glm::dvec3(2.0), glm::dvec3(10.0));
    add_box(mesh, glm::dvec3(4.0), glm::dvec3(8.0));
    const Lattice lattice = integer_lattice({13, 13, 13});
    const BitVolume got = voxelized(mesh.view(), lattice);
    CHECK(got.count() == 12 * 12 * 12 - 8 * 8 * 8 + 4 * 4 * 4);
    CHECK(difference(got, oracle(mesh.view(), lattice, Ray::Y)) == "");
}

TEST_CASE("a sample on the face between two touching solids belongs to exactly one") {
    const Lattice lattice = integer_lattice({9, 9, 9});
    const glm::dvec3 a(0, 0, 0);
    const glm::dvec3 b(8, 0, 0);
    const glm::dvec3 c(0, 8, 0);
    const glm::dvec3 d(8, 8, 8);
    const glm::dvec3 e(8, 8, 0);
    // Two tetrahedra on one slanted face, which passes through many samples.
    Mesh left;
    add_tetrahedron(left, {a, b, c, d});
    Mesh right;
    add_tetrahedron(right, {e, b, c, d});
    Mesh both = left;
    add_tetrahedron(both, {e, b, c, d});
    const BitVolume l = voxelized(left.view(), lattice);
    const BitVolume r = voxelized(right.view(), lattice);
    const BitVolume lr = voxelized(both.view(), lattice);
    CHECK(l.count() > 0);
    CHECK(r.count() > 0);
    CHECK(lr.count() == l.count() + r.count());
    CHECK(difference(lr, oracle(both.view(), lattice, Ray::X)) == "");
}

TEST_CASE("tiles that fill space set every sample once, however they are cut") {
    const Lattice lattice = integer_lattice({7, 7, 7});
    IntegerPoints points(500, glm::ivec3(0), glm::ivec3(6));
    for (int i = 0; i < 20; ++i) {
        // A cube around everything, cut into the cones from a random point to its twelve triangles.
        const Mesh cube = box_mesh(glm::dvec3(-1.0), glm::dvec3(7.0));
        const glm::dvec3 apex = points();
        std::size_t total = 0;
        for (std::size_t t = 0; t < 12; ++t) {
            Mesh cone;
            add_tetrahedron(cone, {apex, cube.positions[3 * t], cube.positions[3 * t + 1], cube.positions[3 * t + 2]});
            total += voxelized(cone.view(), lattice).count();
        }
        CHECK(total == 7 * 7 * 7);
    }
}

TEST_CASE("where a mesh intersects itself, samples inside twice are outside") {
    Mesh mesh = box_mesh({0.5, 0.5, 0.5}, {6.5, 6.5, 6.5});
    add_box(mesh, {3.5, 3.5, 3.5}, {9.5, 9.5, 9.5});
    const Lattice lattice = integer_lattice({11, 11, 11});
    const BitVolume got = voxelized(mesh.view(), lattice);
    CHECK(got.count() == 2 * (6 * 6 * 6 - 3 * 3 * 3));
    CHECK_FALSE(got.test(5, 5, 5));
    CHECK(difference(got, oracle(mesh.view(), lattice)) == "");
}

TEST_CASE("mirrored meshes and meshes turned inside out get the oracle's bits") {
    IntegerPoints points(600, glm::ivec3(-1), glm::ivec3(9));
    const Mesh mesh = tetrahedra(points, 8);
    const Lattice lattice = integer_lattice({9, 8, 10});
    const BitVolume bits = voxelized(mesh.view(), lattice);

    Mesh inside_out = mesh;
    for (std::size_t i = 0; i < inside_out.indices.size(); i += 3)
        std::swap(inside_out.indices[i], inside_out.indices[i + 2]);
    CHECK(difference(voxelized(inside_out.view(), lattice), bits) == "");

    for (int axis = 0; axis < 3; ++axis) {
        Mesh mirrored = mesh;
        for (glm::dvec3& p : mirrored.positions) p[axis] = 8.0 - p[axis];
        CHECK(difference(voxelized(mirrored.view(), lattice), oracle(mirrored.view(), lattice)) == "");
    }
}

TEST_CASE("triangles near the end of the snapping grid are as exact as small ones") {
    // 16 samples a side: 2^16 units a voxel, so that the grid ends 16,384 voxels away.
    const Lattice lattice = integer_lattice({16, 15, 13});
    for (unsigned seed = 700; seed < 720; ++seed) {
        INFO(seed);
        IntegerPoints far(seed, glm::ivec3(-16'383), glm::ivec3(16'383));
        IntegerPoints near(seed, glm::ivec3(0), glm::ivec3(15));
        Mesh mesh;
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 p = near();
            // The plane through p and two far points, or p mirrored there, passes through samples.
            const glm::dvec3 q = far();
            add_tetrahedron(mesh, {q, 2.0 * p - q * 0.5, far(), i % 2 == 0 ? p : far()});
        }
        const BitVolume got = voxelized(mesh.view(), lattice);
        CHECK(difference(got, oracle(mesh.view(), lattice, Ray::Z)) == "");
        CHECK(difference(got, oracle(mesh.view(), lattice, Ray::X)) == "");
    }
}

TEST_CASE("a plane as large as the snapping grid passes through the samples that it should") {
    const Lattice lattice = integer_lattice({9, 9, 9});
    Mesh mesh;  // The half-space x + y + z <= 12, as far as the tetrahedron reaches.
    const double reach = 5000.0;
    add_tetrahedron(mesh, {glm::dvec3(12 + 2 * reach, -reach, -reach), glm::dvec3(-reach, 12 + 2 * reach, -reach),
                           glm::dvec3(-reach, -reach, 12 + 2 * reach), glm::dvec3(-reach, -reach, -reach)});
    const BitVolume got = voxelized(mesh.view(), lattice);
    std::size_t expected = 0;
    for (int x = 0; x < 9; ++x) {
        for (int y = 0; y < 9; ++y) {
            for (int z = 0; z < 9; ++z) expected += x + y + z < 12;  // Moved by (ε, ε², ε³), a sample on it is beyond.
        }
    }
    CHECK(got.count() == expected);
}

TEST_CASE("open meshes are counted from below") {
    for (unsigned seed = 800; seed < 820; ++seed) {
        INFO(seed);
        IntegerPoints points(seed, glm::ivec3(-2), glm::ivec3(9));
        Mesh mesh;
        for (int i = 0; i < 12; ++i) add_triangle(mesh, points(), points(), points());
        const Lattice lattice = integer_lattice({8, 9, 7});
        CHECK(difference(voxelized(mesh.view(), lattice), oracle(mesh.view(), lattice, Ray::Z)) == "");
    }
}

TEST_CASE("faces given twice cancel") {
    Mesh mesh = box_mesh({0.5, 0.5, 0.5}, {4.5, 4.5, 4.5});
    add_box(mesh, {0.5, 0.5, 0.5}, {4.5, 4.5, 4.5});
    CHECK(voxelized(mesh.view(), integer_lattice({6, 6, 6})).count() == 0);
}

TEST_CASE("faces without area change nothing") {
    Mesh mesh = box_mesh({0.0, 0.0, 0.0}, {4.0, 4.0, 4.0});
    const Lattice lattice = integer_lattice({6, 6, 6});
    const BitVolume expected = voxelized(mesh.view(), lattice);
    add_triangle(mesh, {1, 1, 1}, {1, 1, 1}, {1, 1, 1});
    add_triangle(mesh, {0, 0, 2}, {2, 2, 2}, {4, 4, 2});
    add_triangle(mesh, {3, 1, 0}, {3, 1, 5}, {3, 1, 9});
    CHECK(difference(voxelized(mesh.view(), lattice), expected) == "");
}

TEST_CASE("the output's former contents and the scratch memory's do not matter") {
    const Mesh mesh = box_mesh(glm::dvec3(0.5), glm::dvec3(70.5));
    const Lattice lattice = integer_lattice({72, 5, 4});
    BitVolume out(lattice);
    for (std::uint64_t& word : out.view().words) word = ~std::uint64_t{0};
    alignas(16) std::byte scratch[4096];
    for (std::byte& byte : scratch) byte = std::byte{0xa5};
    REQUIRE(voxelize_solid(mesh.view(), lattice, scratch, out.view()) == Status::Ok);
    CHECK(difference(out, oracle(mesh.view(), lattice)) == "");
}

TEST_CASE("the report counts crossings below the top of the lattice") {
    const Lattice lattice = integer_lattice({6, 6, 6});
    SolidReport report;
    REQUIRE(voxelize(box_mesh(glm::dvec3(0.5), glm::dvec3(3.5)).view(), lattice, &report));
    CHECK(report.crossings == 2 * 3 * 3);
    REQUIRE(voxelize(box_mesh(glm::dvec3(0.5), glm::dvec3(3.5, 3.5, 9.0)).view(), lattice, &report));
    CHECK(report.crossings == 3 * 3);
}
