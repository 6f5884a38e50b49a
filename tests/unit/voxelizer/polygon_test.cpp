// Polygons: the mod-2 fan over all rings of a face.

#include <algorithm>

#include "meshes.h"
#include "oracle.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

/// Even-odd by crossings of a ray to the right; for points that are on no edge.
bool is_inside(const PlanRings& rings, double x, double y) {
    bool inside = false;
    for (const auto& ring : rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const glm::dvec2& a = ring[i];
            const glm::dvec2& b = ring[(i + 1) % ring.size()];
            if ((a.y > y) == (b.y > y)) continue;
            if (x < a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
        }
    }
    return inside;
}

BitVolume even_odd_prism(const PlanRings& rings, std::uint32_t bottom, std::uint32_t top, const glm::uvec3& n) {
    BitVolume volume(n.x, n.y, n.z);
    for (std::uint32_t z = bottom; z < top; ++z) {
        for (std::uint32_t y = 0; y < n.y; ++y) {
            for (std::uint32_t x = 0; x < n.x; ++x) {
                if (is_inside(rings, x, y)) volume.view().flip(x, y, z);
            }
        }
    }
    return volume;
}

const PlanRings kConcave{{{0.5, 0.5}, {14.5, 0.6}, {14.4, 12.3}, {7.3, 3.2}, {1.2, 13.7}, {6.1, 7.1}}};
const PlanRings kWithHoles{{{0.5, 0.5}, {15.5, 0.5}, {15.5, 13.5}, {0.5, 13.5}},
                           {{2.5, 2.5}, {6.5, 3.5}, {3.3, 8.2}},
                           {{8.5, 4.5}, {13.5, 4.5}, {13.5, 11.5}, {11.2, 6.6}, {8.5, 11.5}}};

PlanRings with_one_ring_reversed(PlanRings rings, std::size_t r) {
    std::reverse(rings[r].begin(), rings[r].end());
    return rings;
}

}  // namespace

TEST_CASE("concave polygons are filled as they are drawn") {
    const glm::uvec3 n{17, 15, 9};
    const Mesh mesh = prism(kConcave, 1.5, 6.5);
    const BitVolume got = voxelized(mesh.view(), integer_lattice(n));
    CHECK(got.count() > 0);
    CHECK(difference(got, even_odd_prism(kConcave, 2, 7, n)) == "");
    CHECK(difference(got, oracle(mesh.view(), integer_lattice(n), Ray::X)) == "");
}

TEST_CASE("polygons with holes are filled between their rings, whatever the rings' directions") {
    const glm::uvec3 n{17, 15, 5};
    const BitVolume expected = even_odd_prism(kWithHoles, 1, 4, n);
    CHECK(difference(voxelized(prism(kWithHoles, 0.5, 3.5).view(), integer_lattice(n)), expected) == "");
    for (std::size_t r = 0; r < kWithHoles.size(); ++r) {
        const Mesh mesh = prism(with_one_ring_reversed(kWithHoles, r), 0.5, 3.5);
        CHECK(difference(voxelized(mesh.view(), integer_lattice(n)), expected) == "");
    }
}

TEST_CASE("an upright polygon with a hole is filled between its rings") {
    // The walls of a tunnel along x, lying on its side: the caps are upright and cross no column.
    Mesh mesh = prism(kWithHoles, 0.5, 3.5);
    for (glm::dvec3& p : mesh.positions) p = {p.z, p.x, p.y};
    const Lattice lattice = integer_lattice({5, 17, 15});
    const BitVolume got = voxelized(mesh.view(), lattice);
    CHECK(got.count() == even_odd_prism(kWithHoles, 1, 4, {17, 15, 5}).count());
    CHECK(difference(got, oracle(mesh.view(), lattice, Ray::X)) == "");
}

TEST_CASE("a bent polygon has the same bits whatever its first vertex and direction") {
    for (unsigned seed = 0; seed < 30; ++seed) {
        INFO(seed);
        IntegerPoints points(seed, glm::ivec3(-2), glm::ivec3(16));
        std::vector<glm::dvec3> ring(5 + seed % 4);
        for (glm::dvec3& p : ring) p = points();
        const Lattice lattice = integer_lattice({15, 14, 13});
        Mesh first;
        add_polygon(first, {ring});
        const BitVolume expected = voxelized(first.view(), lattice);
        CHECK(difference(expected, oracle(first.view(), lattice)) == "");
        for (std::size_t start = 0; start < ring.size(); ++start) {
            std::rotate(ring.begin(), ring.begin() + 1, ring.end());
            Mesh again;
            add_polygon(again, {ring});
            CHECK(difference(voxelized(again.view(), lattice), expected) == "");
            std::reverse(ring.begin(), ring.end());
            Mesh reversed;
            add_polygon(reversed, {ring});
            CHECK(difference(voxelized(reversed.view(), lattice), expected) == "");
            std::reverse(ring.begin(), ring.end());
        }
    }
}

TEST_CASE("two solids that list their common bent polygon differently leave no gap") {
    const std::vector<glm::dvec3> shared{
        {0.3, 0.2, 7.1}, {9.7, 0.4, 4.3}, {13.2, 8.9, 8.8}, {6.1, 13.4, 3.3}, {0.6, 9.2, 6.6}};
    const auto cup = [](std::vector<glm::dvec3> lid, std::size_t start, double level) {
        std::rotate(lid.begin(), lid.begin() + static_cast<std::ptrdiff_t>(start), lid.end());
        Mesh mesh;
        add_polygon(mesh, {lid});
        std::vector<glm::dvec3> floor;
        for (const glm::dvec3& p : lid) floor.emplace_back(p.x, p.y, level);
        add_polygon(mesh, {floor});
        for (std::size_t i = 0; i < lid.size(); ++i) {
            const std::size_t j = (i + 1) % lid.size();
            add_polygon(mesh, {{lid[i], lid[j], floor[j], floor[i]}});
        }
        return mesh;
    };
    const Lattice lattice = integer_lattice({14, 14, 16});
    const BitVolume whole = voxelized(
        cup({{0.3, 0.2, 14.5}, {9.7, 0.4, 14.5}, {13.2, 8.9, 14.5}, {6.1, 13.4, 14.5}, {0.6, 9.2, 14.5}}, 0, 0.5)
            .view(),
        lattice);
    for (std::size_t start = 0; start < shared.size(); ++start) {
        BitVolume sum = voxelized(cup(shared, 0, 0.5).view(), lattice);
        const BitVolume upper = voxelized(cup(shared, start, 14.5).view(), lattice);
        for (std::size_t i = 0; i < sum.view().words.size(); ++i) {
            CHECK((sum.view().words[i] & upper.view().words[i]) == 0);
            sum.view().words[i] ^= upper.view().words[i];
        }
        CHECK(difference(sum, whole) == "");
    }
}

TEST_CASE("a face of two separate parts counts both") {
    const PlanRings parts{{{0.5, 0.5}, {4.5, 0.5}, {4.5, 4.5}, {0.5, 4.5}}, {{6.5, 1.5}, {9.5, 2.5}, {7.5, 8.5}}};
    const glm::uvec3 n{11, 10, 4};
    CHECK(difference(voxelized(prism(parts, 0.5, 2.5).view(), integer_lattice(n)), even_odd_prism(parts, 1, 3, n)) ==
          "");
}

TEST_CASE("rings of fewer than three vertices and faces without rings change nothing") {
    Mesh mesh = prism(kConcave, 1.5, 6.5);
    const Lattice lattice = integer_lattice({17, 15, 9});
    const BitVolume expected = voxelized(mesh.view(), lattice);
    add_polygon(mesh, {{}});
    add_polygon(mesh, {{{3, 3, 3}}});
    add_polygon(mesh, {{{3, 3, 3}, {9, 9, 9}}});
    add_polygon(mesh, {});
    CHECK(difference(voxelized(mesh.view(), lattice), expected) == "");
}

TEST_CASE("a part of the face table is a view of some faces") {
    Mesh mesh = prism(kConcave, 1.5, 6.5);
    const std::size_t first_solid = mesh.face_starts.size() - 1;
    const Mesh second = prism(kWithHoles, 0.5, 3.5);
    for (std::size_t f = 0; f < second.view().face_count(); ++f) {
        Rings rings;
        for (std::size_t r = second.view().face_begin(f); r < second.view().face_end(f); ++r) {
            rings.emplace_back();
            for (const std::uint32_t i : second.view().ring(r)) rings.back().push_back(second.positions[i]);
        }
        add_polygon(mesh, rings);
    }
    const Lattice lattice = integer_lattice({17, 15, 9});
    MeshView part = mesh.view();
    part.face_starts = part.face_starts.subspan(first_solid);
    CHECK(difference(voxelized(part, lattice), voxelized(second.view(), lattice)) == "");
}
