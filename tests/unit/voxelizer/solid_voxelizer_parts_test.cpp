// SolidVoxelizer: parts of a lattice, slabs, batches, lists, moving meshes.

#include <algorithm>

#include "engines.h"
#include "meshes.h"
#include "oracle.h"
#include "tables.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

const std::vector<Region> kRegions{{{0, 0, 0}, {1, 1, 1}},    {{5, 6, 7}, {20, 9, 40}},  {{39, 37, 79}, {1, 1, 1}},
                                   {{0, 0, 30}, {40, 38, 3}}, {{17, 0, 0}, {2, 38, 80}}, {{1, 2, 3}, {39, 36, 77}}};

/// A regular lattice and one of tables, both 40 × 38 × 80, with a mesh that reaches beyond them.
struct Scene {
    Mesh mesh;
    Tables tables = random_tables(4, 40, 38, 80, 60);

    Scene() {
        IntegerPoints points(12, glm::ivec3(-10), glm::ivec3(70, 70, 100));
        mesh = tetrahedra(points, 50);
        IntegerPoints between(13, glm::ivec3(0), glm::ivec3(40000, 38000, 80000));
        const Mesh fine = tetrahedra(between, 30, glm::dvec3(1e-3));
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), fine.positions.begin(), fine.positions.end());
        for (const std::uint32_t index : fine.indices) mesh.indices.push_back(base + index);
    }
    std::vector<Lattice> lattices() const { return {integer_lattice({40, 38, 80}), tables.view()}; }
};

}  // namespace

TEST_CASE("a region has the bits of the same samples of the whole lattice") {
    const Scene scene;
    for (const Lattice& lattice : scene.lattices()) {
        const BitVolume all = reference(scene.mesh.view(), lattice);
        for (const SolidOptions& options : all_engines()) {
            SolidVoxelizer engine = engine_for(scene.mesh.view(), lattice, options);
            for (const Region& region : kRegions) {
                INFO(name_of(options) << ", region from " << region.begin.x << ", " << region.begin.y);
                BitVolume part(region.size.x, region.size.y, region.size.z);
                REQUIRE(engine.solid(region, part.view()) == Status::Ok);
                CHECK(difference(part, part_of(all, region)) == "");
            }
            BitVolume again(lattice);
            REQUIRE(engine.solid(again.view()) == Status::Ok);
            CHECK(difference(again, all) == "");
        }
    }
}

TEST_CASE("slabs, one after the other, are the whole lattice") {
    const Scene scene;
    for (const Lattice& lattice : scene.lattices()) {
        const BitVolume all = reference(scene.mesh.view(), lattice);
        for (const SolidOptions& options : all_engines()) {
            SolidVoxelizer engine = engine_for(scene.mesh.view(), lattice, options);
            for (const std::uint32_t layers : {1u, 7u, 64u, 80u, 1000u}) {
                INFO(name_of(options) << ", " << layers << " layers");
                std::uint32_t next = 0;
                bool equal = true;
                const Status status = engine.slabs(layers, [&](ConstBitVolumeView slab, std::uint32_t z) {
                    equal &= z == next && slab.nz == std::min(layers, lattice.nz - z);
                    next += slab.nz;
                    const auto whole = all.view().words.subspan(z * volume_words(lattice.nx, lattice.ny, 1));
                    equal &= std::equal(slab.words.begin(), slab.words.end(), whole.begin());
                    return true;
                });
                CHECK(status == Status::Ok);
                CHECK(next == lattice.nz);
                CHECK(equal);
            }
        }
    }
}

TEST_CASE("slabs stop when their taker says so") {
    const Scene scene;
    SolidVoxelizer engine = engine_for(scene.mesh.view(), scene.lattices()[0]);
    int taken = 0;
    CHECK(engine.slabs(10, [&](ConstBitVolumeView, std::uint32_t) { return ++taken < 3; }) == Status::Cancelled);
    CHECK(taken == 3);
}

TEST_CASE("a mesh in batches, down to single triangles, has the bits of the whole") {
    const Scene scene;
    for (const Lattice& lattice : scene.lattices()) {
        const BitVolume all = reference(scene.mesh.view(), lattice);
        for (const SolidOptions& options : all_engines()) {
            INFO(name_of(options));
            for (const std::size_t triangles : {1u, 13u, 1000u}) {
                SolidVoxelizer engine(options);
                REQUIRE(engine.set_lattice(lattice) == Status::Ok);
                // Each batch has positions of its own, which are gone with the next one.
                std::vector<glm::dvec3> positions;
                std::vector<std::uint32_t> indices;
                std::size_t at = 0;
                const MeshBatches next = [&](MeshView& batch) {
                    positions.clear();
                    indices.clear();
                    for (; at < scene.mesh.indices.size() && indices.size() < 3 * triangles; ++at) {
                        indices.push_back(static_cast<std::uint32_t>(positions.size()));
                        positions.push_back(scene.mesh.positions[scene.mesh.indices[at]]);
                    }
                    batch.positions = positions;
                    batch.indices = indices;
                    return !indices.empty();
                };
                BitVolume got(lattice);
                REQUIRE(engine.solid(next, whole(lattice), got.view()) == Status::Ok);
                CHECK(difference(got, all) == "");
            }
        }
    }
}

TEST_CASE("batches leave the mesh that was set as it is") {
    const Scene scene;
    const Lattice lattice = scene.lattices()[0];
    SolidVoxelizer engine = engine_for(scene.mesh.view(), lattice);
    const Mesh box = box_mesh(glm::dvec3(3.0), glm::dvec3(9.0));
    bool given = false;
    const MeshBatches next = [&](MeshView& batch) {
        batch = box.view();
        return !std::exchange(given, true);
    };
    BitVolume got(lattice);
    REQUIRE(engine.solid(next, whole(lattice), got.view()) == Status::Ok);
    CHECK(got.count() == 6 * 6 * 6);
    REQUIRE(engine.solid(got.view()) == Status::Ok);
    CHECK(difference(got, reference(scene.mesh.view(), lattice)) == "");
}

TEST_CASE("crossing lists are sorted, and give the bits and their number") {
    const Scene scene;
    for (const Lattice& lattice : scene.lattices()) {
        const BitVolume all = reference(scene.mesh.view(), lattice);
        for (SolidOptions options : all_engines()) {
            for (const std::size_t event_bytes : {std::size_t{1}, std::size_t{16} << 20}) {
                options.event_bytes = event_bytes;
                INFO(name_of(options));
                SolidVoxelizer engine = engine_for(scene.mesh.view(), lattice, options);
                for (const Region& region : {whole(lattice), kRegions[1]}) {
                    CrossingLists lists;
                    SolidReport report;
                    REQUIRE(engine.crossings(region, lists, &report) == Status::Ok);
                    CHECK(report.crossings == lists.first_above.size());
                    bool sorted = true;
                    for (std::uint32_t y = 0; y < lists.ny; ++y) {
                        for (std::uint32_t x = 0; x < lists.nx; ++x) {
                            const auto column = lists.column(x, y);
                            sorted &= std::is_sorted(column.begin(), column.end());
                        }
                    }
                    CHECK(sorted);
                    BitVolume got(region.size.x, region.size.y, region.size.z);
                    to_bits(lists, got.view());
                    CHECK(difference(got, part_of(all, region)) == "");
                    CHECK(count_inside(lists) == got.count());
                }
            }
        }
    }
}

TEST_CASE("a mesh that moves has the bits of its new place") {
    const Scene scene;
    for (const Lattice& lattice : scene.lattices()) {
        for (const SolidOptions& options : all_engines()) {
            INFO(name_of(options));
            SolidVoxelizer engine = engine_for(scene.mesh.view(), lattice, options);
            Mesh moved = scene.mesh;
            BitVolume got(lattice);
            for (int step = 0; step < 3; ++step) {
                for (glm::dvec3& p : moved.positions) p = p * 0.9 + glm::dvec3(1.0, 2.0, -0.5);
                REQUIRE(engine.set_positions(moved.positions) == Status::Ok);
                REQUIRE(engine.solid(got.view()) == Status::Ok);
                CHECK(difference(got, reference(moved.view(), lattice)) == "");
            }
        }
    }
}

TEST_CASE("one mesh is voxelized at many resolutions, back and forth between lattices") {
    const Scene scene;
    SolidVoxelizer engine;
    REQUIRE(engine.set_mesh(scene.mesh.view()) == Status::Ok);
    for (const std::uint32_t n : {16u, 32u, 30u, 100u, 16u}) {
        const Lattice regular = integer_lattice({n, n, n}, glm::dvec3(60.0 / n));
        BitVolume got(regular);
        REQUIRE(engine.set_lattice(regular) == Status::Ok);
        REQUIRE(engine.solid(got.view()) == Status::Ok);
        CHECK(difference(got, reference(scene.mesh.view(), regular)) == "");

        const Lattice table = scene.lattices()[1];
        BitVolume other(table);
        REQUIRE(engine.set_lattice(table) == Status::Ok);
        REQUIRE(engine.solid(other.view()) == Status::Ok);
        CHECK(difference(other, reference(scene.mesh.view(), table)) == "");
    }
}
