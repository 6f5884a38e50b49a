// SolidVoxelizer: bad input, memory, cancelling.

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include "allocations.h"
#include "engines.h"
#include "meshes.h"
#include "oracle.h"
#include "tables.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

constexpr std::uint64_t kUntouched = 0x5a5a5a5a5a5a5a5a;

BitVolume marked(const Lattice& lattice) {
    BitVolume volume(lattice);
    for (std::uint64_t& word : volume.view().words) word = kUntouched;
    return volume;
}

bool is_untouched(BitVolume& volume) {
    const auto words = volume.view().words;
    return std::all_of(words.begin(), words.end(), [](std::uint64_t word) { return word == kUntouched; });
}

/// A wavy sheet above a floor: 2·n² triangles with a vertex each for two of them.
Mesh many_triangles(std::uint32_t n) {
    Mesh mesh;
    for (std::uint32_t y = 0; y <= n; ++y) {
        for (std::uint32_t x = 0; x <= n; ++x) {
            const double fx = static_cast<double>(x) / n;
            const double fy = static_cast<double>(y) / n;
            mesh.positions.emplace_back(fx, fy, 0.5 + 0.3 * std::sin(20 * fx) * std::cos(17 * fy));
        }
    }
    for (std::uint32_t y = 0; y < n; ++y) {
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t a = y * (n + 1) + x;
            for (const std::uint32_t index : {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1}) {
                mesh.indices.push_back(index);
            }
        }
    }
    return mesh;
}

}  // namespace

TEST_CASE("wrong calls are refused and leave the output as it was") {
    const Mesh box = box_mesh(glm::dvec3(1.0), glm::dvec3(5.0));
    const Lattice lattice = integer_lattice({9, 8, 7});
    BitVolume out = marked(lattice);
    CrossingLists lists;

    SolidVoxelizer fresh;
    CHECK(fresh.solid(out.view()) == Status::InvalidArgument);
    CHECK(fresh.set_positions(box.positions) == Status::InvalidArgument);
    REQUIRE(fresh.set_lattice(lattice) == Status::Ok);
    CHECK(fresh.solid(out.view()) == Status::InvalidArgument);
    CHECK(fresh.crossings(whole(lattice), lists) == Status::InvalidArgument);

    SolidVoxelizer engine = engine_for(box.view(), lattice);
    BitVolume other(9, 8, 6);
    CHECK(engine.solid(other.view()) == Status::InvalidArgument);
    BitVolumeView cut = out.view();
    cut.words = cut.words.first(cut.words.size() - 1);
    CHECK(engine.solid(cut) == Status::InvalidArgument);
    for (const Region& region : std::vector<Region>{
             {{0, 0, 0}, {0, 8, 7}}, {{1, 0, 0}, {9, 8, 7}}, {{9, 0, 0}, {1, 1, 1}}, {{0, 0, ~0u}, {1, 1, 2}}}) {
        BitVolume part(region.size.x, region.size.y, region.size.z);
        CHECK(engine.solid(region, part.view()) == Status::InvalidArgument);
        CHECK(engine.crossings(region, lists) == Status::InvalidArgument);
    }
    CHECK(engine.slabs(0, [](ConstBitVolumeView, std::uint32_t) { return true; }) == Status::InvalidArgument);
    CHECK(engine.slabs(1, {}) == Status::InvalidArgument);
    CHECK(engine.solid(MeshBatches(), whole(lattice), out.view()) == Status::InvalidArgument);
    CHECK(engine.set_positions(std::span(box.positions).first(7)) == Status::InvalidArgument);
    CHECK(engine.set_lattice(integer_lattice({4097, 1, 1})) == Status::OutOfRange);
    CHECK(engine.set_lattice(integer_lattice({0, 1, 1})) == Status::InvalidArgument);
    CHECK(is_untouched(out));

    REQUIRE(engine.solid(out.view()) == Status::Ok);
    CHECK(out.count() == 4 * 4 * 4);
}

TEST_CASE("vertex numbers beyond the last vertex are named, and the mesh before stays") {
    const Mesh box = box_mesh(glm::dvec3(1.0), glm::dvec3(5.0));
    const Lattice lattice = integer_lattice({9, 8, 7});
    SolidVoxelizer engine = engine_for(box.view(), lattice);
    Mesh bad = box;
    bad.indices[17] = static_cast<std::uint32_t>(box.positions.size());
    SolidReport report;
    CHECK(engine.set_mesh(bad.view(), &report) == Status::InvalidArgument);
    CHECK(report.bad_index == 17);
    BitVolume out(lattice);
    REQUIRE(engine.solid(out.view()) == Status::Ok);
    CHECK(out.count() == 4 * 4 * 4);
}

TEST_CASE("every kernel names the first used vertex that is beyond the grid, and writes nothing") {
    const Mesh box = box_mesh(glm::dvec3(1.0), glm::dvec3(5.0));
    const Lattice lattice = integer_lattice({9, 8, 7});
    for (const SolidOptions& options : all_engines()) {
        INFO(name_of(options));
        for (const double far : {1e5, -1e300, std::numeric_limits<double>::infinity(), std::nan("")}) {
            for (const std::size_t which : {0u, 3u, 7u}) {
                Mesh bad = box;
                bad.positions[which].y = far;
                SolidVoxelizer engine = engine_for(bad.view(), lattice, options);
                BitVolume out = marked(lattice);
                SolidReport report;
                CHECK(engine.solid(out.view(), &report) == Status::OutOfRange);
                CHECK(report.bad_vertex == which);
                CHECK(is_untouched(out));
                const auto ignore = [](ConstBitVolumeView, std::uint32_t) { return true; };
                CHECK(engine.slabs(2, ignore, &report) == Status::OutOfRange);
                CrossingLists lists;
                CHECK(engine.crossings(whole(lattice), lists, &report) == Status::OutOfRange);
                CHECK(report.bad_vertex == which);

                // The same object goes on with a mesh that is in order.
                REQUIRE(engine.set_mesh(box.view()) == Status::Ok);
                REQUIRE(engine.solid(out.view()) == Status::Ok);
                CHECK(out.count() == 4 * 4 * 4);
            }
        }
    }
}

TEST_CASE("vertices that no face uses may be anything, for every kernel") {
    Mesh box = box_mesh(glm::dvec3(1.0), glm::dvec3(5.0));
    for (const double odd : {1e300, std::nan(""), 1e5}) box.positions.emplace_back(odd, 0.0, odd);
    const Lattice lattice = integer_lattice({9, 8, 7});
    for (const SolidOptions& options : all_engines()) {
        INFO(name_of(options));
        SolidVoxelizer engine = engine_for(box.view(), lattice, options);
        BitVolume out(lattice);
        REQUIRE(engine.solid(out.view()) == Status::Ok);
        CHECK(out.count() == 4 * 4 * 4);
    }
}

TEST_CASE("a bad batch ends a stream and is told") {
    const Mesh box = box_mesh(glm::dvec3(1.0), glm::dvec3(5.0));
    const Lattice lattice = integer_lattice({9, 8, 7});
    SolidVoxelizer engine;
    REQUIRE(engine.set_lattice(lattice) == Status::Ok);
    Mesh bad = box;
    bad.indices[4] = 99;
    int calls = 0;
    const MeshBatches next = [&](MeshView& batch) {
        batch = calls == 1 ? bad.view() : box.view();
        return ++calls < 4;
    };
    BitVolume out(lattice);
    SolidReport report;
    CHECK(engine.solid(next, whole(lattice), out.view(), &report) == Status::InvalidArgument);
    CHECK(report.bad_index == 4);
    CHECK(calls == 2);
}

TEST_CASE("a call that is stopped says so, and the next one is whole") {
    const Mesh mesh = many_triangles(200);
    const Lattice lattice{.nx = 200, .ny = 200, .nz = 200, .pitch = glm::dvec3(1.0 / 200)};
    const BitVolume expected = reference(mesh.view(), lattice);
    for (const unsigned threads : {1u, 3u}) {
        for (const double when : {0.0, 0.3, 0.72, 0.95}) {
            INFO(threads << " threads, stopped at " << when);
            std::stop_source stop;
            bool stops = true;
            double last = 0;
            SolidOptions options{.threads = threads, .stop = stop.get_token()};
            options.progress = [&](double part) {
                CHECK(part >= last);
                CHECK(part <= 1.0);
                last = part;
                if (stops && part >= when) stop.request_stop();
            };
            SolidVoxelizer engine = engine_for(mesh.view(), lattice, options);
            BitVolume out(lattice);
            CHECK(engine.solid(out.view()) == Status::Cancelled);
            CHECK(last < 1.0);
            CrossingLists lists;
            CHECK(engine.crossings(whole(lattice), lists) == Status::Cancelled);
        }
    }
    BitVolume out(lattice);
    SolidVoxelizer engine = engine_for(mesh.view(), lattice);
    REQUIRE(engine.solid(out.view()) == Status::Ok);
    CHECK(difference(out, expected) == "");
}

TEST_CASE("progress never goes back over batches") {
    const Mesh mesh = many_triangles(60);
    const Lattice lattice{.nx = 50, .ny = 50, .nz = 90, .pitch = glm::dvec3(1.0 / 90)};
    std::vector<double> told;
    SolidVoxelizer engine({.progress = [&](double part) { told.push_back(part); }});
    REQUIRE(engine.set_lattice(lattice) == Status::Ok);
    int given = 0;
    const MeshBatches next = [&](MeshView& batch) {
        batch = mesh.view();
        return ++given <= 3;
    };
    BitVolume out(lattice);
    REQUIRE(engine.solid(next, whole(lattice), out.view()) == Status::Ok);
    CHECK(std::is_sorted(told.begin(), told.end()));
    CHECK(told.back() == 1.0);
}

TEST_CASE("an exception of a caller's function passes through, and the next call is whole") {
    const Mesh mesh = many_triangles(60);
    const Mesh other = many_triangles(10);
    const Lattice lattice{.nx = 50, .ny = 50, .nz = 90, .pitch = glm::dvec3(1.0 / 90)};
    bool throws = false;
    SolidVoxelizer engine = engine_for(mesh.view(), lattice, {.progress = [&](double) {
                                           if (throws) throw std::runtime_error("enough");
                                       }});
    BitVolume out(lattice);
    REQUIRE(engine.solid(out.view()) == Status::Ok);
    throws = true;
    const MeshBatches next = [&](MeshView& batch) {
        batch = other.view();
        return true;
    };
    CHECK_THROWS_AS(static_cast<void>(engine.solid(next, whole(lattice), out.view())), std::runtime_error);
    throws = false;
    REQUIRE(engine.solid(out.view()) == Status::Ok);
    CHECK(difference(out, reference(mesh.view(), lattice)) == "");
}

TEST_CASE("progress goes up to 1, for slabs over all of them") {
    const Mesh mesh = many_triangles(50);
    const Lattice lattice{.nx = 50, .ny = 50, .nz = 50, .pitch = glm::dvec3(1.0 / 50)};
    std::vector<double> told;
    SolidVoxelizer engine = engine_for(mesh.view(), lattice, {.progress = [&](double part) { told.push_back(part); }});
    REQUIRE(engine.slabs(7, [](ConstBitVolumeView, std::uint32_t) { return true; }) == Status::Ok);
    CHECK(std::is_sorted(told.begin(), told.end()));
    CHECK(told.back() == 1.0);
    CHECK(told.size() >= 8);
}

TEST_CASE("moving meshes, regions and other lattices of the same size allocate nothing") {
    const Mesh mesh = many_triangles(100);
    const Tables tables = random_tables(3, 50, 50, 70, 100);
    const Lattice regular{.nx = 90, .ny = 90, .nz = 90, .pitch = glm::dvec3(1.0 / 90)};
    const Lattice flat{.nx = 90, .ny = 90, .nz = 40, .pitch = glm::dvec3(1.0 / 90)};
    for (const Lattice& lattice : {regular, flat, tables.view()}) {
        for (const unsigned threads : {1u, 3u}) {
            SolidVoxelizer engine = engine_for(mesh.view(), lattice, {.threads = threads});
            Mesh moved = mesh;
            BitVolume out(lattice);
            const Region region{{3, 4, 5}, {20, 21, 22}};
            BitVolume part(20, 21, 22);
            const auto everything = [&] {
                for (glm::dvec3& p : moved.positions) p.z *= 0.99;
                REQUIRE(engine.set_positions(moved.positions) == Status::Ok);
                REQUIRE(engine.solid(out.view()) == Status::Ok);
                REQUIRE(engine.solid(region, part.view()) == Status::Ok);
            };
            everything();
            everything();
            const std::size_t before = allocation_count();
            for (int i = 0; i < 3; ++i) {
                for (glm::dvec3& p : moved.positions) p.z *= 0.99;
                const Status positions = engine.set_positions(moved.positions);
                const Status all = engine.solid(out.view());
                const Status some = engine.solid(region, part.view());
                if (positions != Status::Ok || all != Status::Ok || some != Status::Ok) break;
            }
            CHECK(allocation_count() == before);
            CHECK(difference(out, reference(moved.view(), lattice)) == "");
        }
    }
}

TEST_CASE("the memory that is asked for before is enough, and at most 16 bytes a vertex and 32 MiB") {
    const Mesh mesh = many_triangles(300);
    const Tables tables = random_tables(3, 500, 100, 300, 1000);
    for (const unsigned threads : {1u, 2u}) {
        for (const std::uint32_t n : {64u, 200u, 512u, 1024u}) {
            const Lattice regular{.nx = n, .ny = n, .nz = n, .pitch = glm::dvec3(1.0 / n)};
            for (const Lattice& lattice : {regular, tables.view()}) {
                INFO(n << ", " << threads << " threads");
                BitVolume out(lattice);
                Mesh grown = mesh;
                grown.positions.emplace_back(0.0);
                const std::size_t before = allocated_bytes();
                reset_peak();
                SolidVoxelizer engine = engine_for(mesh.view(), lattice, {.threads = threads});
                REQUIRE(engine.solid(out.view()) == Status::Ok);
                // Other forms of events, and a mesh that has grown a little, take no more.
                const Region low{{0, 0, 0}, {lattice.nx, lattice.ny, std::min(50u, lattice.nz)}};
                BitVolume part(low.size.x, low.size.y, low.size.z);
                REQUIRE(engine.solid(low, part.view()) == Status::Ok);
                REQUIRE(engine.set_mesh(grown.view()) == Status::Ok);
                REQUIRE(engine.solid(out.view()) == Status::Ok);
                const std::size_t used = peak_bytes() - before;
                const std::size_t told = engine.memory_bytes(mesh.positions.size(), lattice);
                CHECK(used <= told + (32 << 10));  // Large blocks are rounded up to pages.
                CHECK(told <= 16 * mesh.positions.size() + (std::size_t{32} << 20));
            }
        }
    }
}

TEST_CASE("wherever memory runs out, the answer is OutOfMemory, nothing leaks, and the next call is whole") {
    const Mesh mesh = many_triangles(20);
    const Tables tables = random_tables(3, 20, 20, 90, 20);
    const Lattice regular{.nx = 30, .ny = 30, .nz = 90, .pitch = glm::dvec3(1.0 / 30)};
    for (const Lattice& lattice : {regular, tables.view()}) {
        const BitVolume expected = reference(mesh.view(), lattice);
        const Tables other_tables = random_tables(9, 4, 4, 4, 9);
        for (std::size_t count = 0;; ++count) {
            SolidVoxelizer engine({.threads = 1, .event_bytes = 1});
            REQUIRE(engine.set_mesh(mesh.view()) == Status::Ok);
            BitVolume out(lattice);
            CrossingLists lists;
            fail_after(count);
            Status status = engine.set_lattice(lattice);
            if (status == Status::Ok) status = engine.solid(out.view());
            if (status == Status::Ok) status = engine.crossings(whole(lattice), lists);
            if (status == Status::Ok) {
                status = engine.slabs(9, [](ConstBitVolumeView, std::uint32_t) { return true; });
            }
            const bool failed = has_failed();
            INFO("after " << count << " allocations");
            CHECK((lists.starts.size() == std::size_t{lists.nx} * lists.ny + 1 || lists.starts.empty()));
            if (lists.starts.empty()) CHECK(lists.nx == 0);
            CHECK(status == (failed ? Status::OutOfMemory : Status::Ok));
            REQUIRE(engine.set_lattice(lattice) == Status::Ok);
            REQUIRE(engine.solid(out.view()) == Status::Ok);
            CHECK(difference(out, expected) == "");
            if (!failed) break;
        }
    }
}

TEST_CASE("several voxelizers work at the same time") {
    const Mesh mesh = many_triangles(60);
    const Lattice lattice{.nx = 70, .ny = 70, .nz = 70, .pitch = glm::dvec3(1.0 / 70)};
    const BitVolume expected = reference(mesh.view(), lattice);
    std::vector<BitVolume> outs(4, BitVolume(lattice));
    {
        std::vector<std::jthread> threads;
        for (BitVolume& out : outs) {
            threads.emplace_back([&] {
                SolidVoxelizer engine = engine_for(mesh.view(), lattice, {.threads = 2});
                for (int i = 0; i < 5; ++i) (void)engine.solid(out.view());
            });
        }
    }
    for (const BitVolume& out : outs) CHECK(difference(out, expected) == "");
}
