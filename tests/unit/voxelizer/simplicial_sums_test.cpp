// The signed inclusion sum, and what it tells of orientation.

#include <algorithm>
#include <array>

#include "meshes.h"
#include "oracle.h"
#include "simplicial_calls.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

constexpr std::array kSweeps{Axis::X, Axis::Y, Axis::Z};

void turn_face(Mesh& mesh, std::size_t face) {
    std::swap(mesh.indices[3 * face], mesh.indices[3 * face + 1]);
}

void turn_all(Mesh& mesh) {
    for (std::size_t face = 0; face < mesh.indices.size() / 3; ++face) turn_face(mesh, face);
}

BitVolume positive(const std::vector<std::int16_t>& of, const Lattice& lattice) {
    BitVolume bits(lattice);
    for (std::uint64_t& word : bits.view().words) word = ~std::uint64_t{0};
    REQUIRE(positive_inclusions(of, bits.view()) == Status::Ok);
    return bits;
}

/// A box of 6 × 5 × 4 samples, faces counter-clockwise seen from outside.
Mesh small_box() {
    return box_mesh({1.5, 1.5, 1.5}, {7.5, 6.5, 5.5});
}

}  // namespace

TEST_CASE("the signed sum is 1 inside and 0 outside of a well oriented solid, for every apex and sweep") {
    const Lattice lattice = integer_lattice({70, 9, 8});
    for (const Axis sweep : kSweeps) {
        for (const glm::dvec3& apex : {glm::dvec3(4.2, 4.1, 3.3), glm::dvec3(1.5, 6.5, 5.5), glm::dvec3(3.0, 2.0, 1.5),
                                       glm::dvec3(-40.0, 3.0, 9.0), glm::dvec3(4.0, 4.0, 4.0)}) {
            const auto got = sums(small_box().view(), lattice, {.apex = apex, .sweep = sweep});
            const InclusionReport report = inspect_inclusions(got);
            CHECK(report.is_consistent());
            CHECK(report.inside == 6 * 5 * 4);
            CHECK(report.outside == 70 * 9 * 8 - 6 * 5 * 4);
            CHECK(report.lowest == 0);
            CHECK(report.highest == 1);
            CHECK(difference(positive(got, lattice), voxelized(small_box().view(), lattice)) == "");
            CHECK(got[(5 * 9 + 6) * 70 + 7] == 1);  // Sample (7, 6, 5), the last inside: x fastest, then y, then z.
            CHECK(got[(5 * 9 + 6) * 70 + 8] == 0);
        }
    }
}

TEST_CASE("the signed sum is -1 in a solid that is inside out") {
    Mesh mesh = small_box();
    turn_all(mesh);
    const Lattice lattice = integer_lattice({10, 9, 8});
    const auto got = sums(mesh.view(), lattice);
    const InclusionReport report = inspect_inclusions(got);
    CHECK(report.negative == 6 * 5 * 4);
    CHECK(report.inside == 0);
    CHECK(report.lowest == -1);
    CHECK_FALSE(report.is_consistent());
    CHECK(positive(got, lattice).count() == 0);
}

TEST_CASE("the signed sum is 2 where solids overlap, which parity leaves outside") {
    Mesh mesh = box_mesh({0.5, 0.5, 0.5}, {6.5, 6.5, 6.5});
    add_box(mesh, {3.5, 3.5, 3.5}, {9.5, 9.5, 9.5});
    const Lattice lattice = integer_lattice({11, 11, 11});
    const auto got = sums(mesh.view(), lattice);
    const InclusionReport report = inspect_inclusions(got);
    CHECK(report.multiple == 3 * 3 * 3);
    CHECK(report.inside == 2 * (6 * 6 * 6 - 3 * 3 * 3));
    CHECK(report.highest == 2);
    CHECK(positive(got, lattice).count() == 2 * 6 * 6 * 6 - 3 * 3 * 3);
    CHECK(covered(mesh.view(), lattice).count() == report.inside);
}

TEST_CASE("one face against its neighbours shows in the signed sum, and changes no bit of the parity") {
    const Lattice lattice = integer_lattice({10, 9, 8});
    for (std::size_t face = 0; face < 12; ++face) {
        Mesh mesh = small_box();
        turn_face(mesh, face);
        const InclusionReport report = inspect_inclusions(sums(mesh.view(), lattice));
        CHECK_FALSE(report.is_consistent());
        CHECK(report.negative > 0);
        CHECK(difference(covered(mesh.view(), lattice), voxelized(small_box().view(), lattice)) == "");
    }
}

TEST_CASE("the signed sum counts the winding of soups the same for every apex and sweep") {
    for (unsigned seed = 1; seed < 20; ++seed) {
        CAPTURE(seed);
        IntegerPoints points(seed, glm::ivec3(-1), glm::ivec3(8));
        const Mesh mesh = tetrahedra(points, 6);
        const Lattice lattice = integer_lattice({8, 7, 9});
        const auto expected = sums(mesh.view(), lattice);
        for (const Axis sweep : kSweeps) {
            for (const glm::dvec3& apex : {points(), points(), glm::dvec3(-30.0, 400.0, 7.0)}) {
                CHECK(sums(mesh.view(), lattice, {.apex = apex, .sweep = sweep}) == expected);
            }
        }
        BitVolume odd(lattice);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const auto at = static_cast<std::uint32_t>(i);
            if (expected[i] % 2 != 0) odd.view().flip(at % 8, at / 8 % 7, at / 56);
        }
        CHECK(difference(odd, voxelized(mesh.view(), lattice)) == "");
    }
}

TEST_CASE("the signed sum of polygons with holes is 1 inside when the holes run against the outer ring") {
    const auto oriented = [](bool holes_against) {
        using Ring = std::vector<glm::dvec3>;
        const auto at = [](double z, Ring ring) {
            for (glm::dvec3& p : ring) p.z = z;
            return ring;
        };
        const Ring outer{{0.5, 0.5, 0}, {8.5, 0.5, 0}, {8.5, 8.5, 0}, {0.5, 8.5, 0}};  // Seen from above, to the left.
        const Ring hole{{2.5, 2.5, 0}, {2.5, 6.5, 0}, {6.5, 6.5, 0}, {6.5, 2.5, 0}};   // To the right.
        const auto turned = [](Ring ring) {
            std::reverse(ring.begin(), ring.end());
            return ring;
        };
        Mesh mesh;
        add_polygon(mesh, {at(5.5, outer), at(5.5, holes_against ? hole : turned(hole))});
        add_polygon(mesh, {turned(at(1.5, outer)), turned(at(1.5, holes_against ? hole : turned(hole)))});
        for (const Ring& ring : {outer, hole}) {
            for (std::size_t i = 0; i < 4; ++i) {
                const glm::dvec3 a = ring[i];
                const glm::dvec3 b = ring[(i + 1) % 4];
                const glm::dvec3 low(0, 0, 1.5);
                const glm::dvec3 high(0, 0, 5.5);
                add_polygon(mesh, {{a + low, b + low, b + high, a + high}});
            }
        }
        return mesh;
    };
    const Lattice lattice = integer_lattice({10, 10, 8});
    const InclusionReport good = inspect_inclusions(sums(oriented(true).view(), lattice));
    CHECK(good.is_consistent());
    CHECK(good.inside == (8 * 8 - 4 * 4) * 4);
    CHECK_FALSE(inspect_inclusions(sums(oriented(false).view(), lattice)).is_consistent());
    CHECK(covered(oriented(false).view(), lattice).count() == good.inside);
}

TEST_CASE("counters hold 32767 tetrahedra over a sample and refuse one more") {
    const Lattice lattice = integer_lattice({5, 5, 5});
    for (const bool turned : {false, true}) {
        Mesh mesh;
        mesh.positions = {{9, -1, -1}, {-1, 9, -1}, {-1, -1, 9}};
        for (int i = 0; i < 32'767; ++i) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
        if (turned) turn_all(mesh);
        const SimplicialOptions options{.apex = glm::dvec3(-1.0), .sweep = Axis::X};
        const auto got = sums(mesh.view(), lattice, options);
        CHECK(got[0] == (turned ? -32'767 : 32'767));
        const int more = turned ? 2 : 1;  // The range has one more below 0.
        for (int i = 0; i < more; ++i) {
            mesh.indices.insert(mesh.indices.end(), {mesh.indices[0], mesh.indices[1], mesh.indices[2]});
        }
        SimplicialScratch scratch(mesh.view());
        std::vector<std::int16_t> out(lattice.sample_count(), 77);
        SimplicialReport report;
        CHECK(sum_inclusions(mesh.view(), lattice, options, scratch.bytes(), out, &report) == Status::OutOfRange);
        CHECK(report.fault == SimplicialFault::Counter);
        CHECK(std::count(out.begin(), out.end(), 0) == 125);
    }
}

TEST_CASE("bits above zero leave the padding clear, and shapes that do not match are refused") {
    const std::vector<std::int16_t> ones(65 * 2 * 3, 1);
    BitVolume bits(65, 2, 3);
    REQUIRE(positive_inclusions(ones, bits.view()) == Status::Ok);
    CHECK(bits.count() == 65 * 2 * 3);
    BitVolume other(65, 2, 2);
    CHECK(positive_inclusions(ones, other.view()) == Status::InvalidArgument);
    CHECK(other.count() == 0);
}
