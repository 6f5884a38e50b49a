// Meshes and lattices from bytes: all voxelizers of solids and a brute-force oracle must give the same bits.
//
//   lattice   nx ny nz, a byte of pitch and kind; then the numbers of a table lattice, a byte each
//   apex      a byte of sweep and kind, a point
//   engine    a byte each of kernel, threads, memory, slab and region's six numbers
//   solids    rings of points and a tip, to the end: the cone from the tip over a polygon with all its rings
//
// A polygon counts as the fan of its rings, whose boundary mod 2 is its edges, so that the cone with its base is closed
// mod 2 whatever the points are: a triangle makes a tetrahedron. Points are on samples, between them, at the ends of
// the snapping grid and beyond, or those of before.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "tests/unit/voxelizer/oracle.h"
#include "tests/unit/voxelizer/simplicial_calls.h"
#include "voxelizer/simplicial.h"
#include "voxelizer/snap.h"
#include "voxelizer/solid.h"
#include "voxelizer/solid_voxelizer.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

constexpr std::size_t kMostTests = 5'000;  // Of samples against triangles, about, to keep the oracle fast.

void require(bool holds) {
    if (!holds) std::abort();
}

class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

    bool is_empty() const { return rest_.empty(); }
    std::uint8_t next() {
        if (rest_.empty()) return 0;
        const std::uint8_t byte = rest_.front();
        rest_ = rest_.subspan(1);
        return byte;
    }
    std::uint32_t below(std::uint32_t n) { return next() % n; }
    double small() { return static_cast<std::int8_t>(next()); }

private:
    std::span<const std::uint8_t> rest_;
};

/// A lattice with the memory of its tables.
struct TestLattice {
    std::vector<glm::dvec2> plan;
    std::vector<double> z0;
    std::vector<double> z;
    Lattice view;

    explicit TestLattice(Bytes& bytes) {
        constexpr std::uint32_t kWidths[]{1, 2, 3, 5, 8, 9, 31, 32, 33, 63, 64, 65, 66, 127, 128, 129};
        view.nx = kWidths[bytes.below(std::size(kWidths))];
        view.ny = 1 + bytes.below(6);
        view.nz = 1 + bytes.below(9);
        const std::uint32_t kind = bytes.next();
        if (kind % 4 == 3) {
            make_table(bytes);
            return;
        }
        if (kind % 2 == 1) view.pitch = {0.1, 3.0, 7.0};
        if (kind >= 128) std::swap(view.nx, view.nz);
        view.origin = -0.5 * view.pitch;
    }
    TestLattice(const TestLattice&) = delete;
    TestLattice& operator=(const TestLattice&) = delete;

private:
    void make_table(Bytes& bytes) {
        view.nx = 1 + view.nx % 9;
        for (std::size_t i = 0; i < view.column_count(); ++i) {
            const double x = bytes.small() * 0.25;
            plan.emplace_back(x, bytes.small() * 0.25);
            z0.push_back(bytes.small() * 0.125);
        }
        for (std::uint32_t k = 0; k < view.nz; ++k) {
            z.push_back((z.empty() ? 0.0 : z.back()) + 0.25 * (1 + bytes.below(8)));
        }
        view.plan = plan;
        view.z0 = z0;
        view.z = z;
    }
};

class Points {
public:
    Points(Bytes& bytes, const Lattice& lattice) : bytes_(bytes), grid_(snap_grid(lattice)), pitch_(lattice.pitch) {}

    glm::dvec3 next() {
        const glm::dvec3 unit = grid_.length / static_cast<double>(1u << grid_.shift);
        glm::dvec3 p;
        switch (const std::uint32_t kind = bytes_.below(16)) {
            case 0:  // One of before.
            case 1: return seen_.empty() ? glm::dvec3(0.0) : seen_[bytes_.next() % seen_.size()];
            case 2:  // To the ends of the snapping grid, and a little further.
                for (int i = 0; i < 3; ++i) p[i] = grid_.origin[i] + bytes_.small() / 127.999 * unit[i] * kSnapLimit;
                break;
            case 3:  // Around a sample, by units of the snapping grid.
                for (int i = 0; i < 3; ++i) {
                    const double nearby = bytes_.small();
                    p[i] = std::floor(nearby / 8.0) * pitch_[i] +
                           (nearby - 8.0 * std::floor(nearby / 8.0) - 4.0) * unit[i];
                }
                break;
            case 4:  // Anywhere between samples.
                for (int i = 0; i < 3; ++i) {
                    const double whole = bytes_.small();
                    p[i] = (whole + bytes_.next() / 256.0) * 0.25 * pitch_[i];
                }
                break;
            default:  // On samples, or half-way between.
                for (int i = 0; i < 3; ++i) {
                    const double half_steps = bytes_.small();
                    p[i] = (kind < 8 ? half_steps * 0.5 : std::fmod(half_steps, 10.0)) * pitch_[i];
                }
        }
        seen_.push_back(p);
        return p;
    }

private:
    Bytes& bytes_;
    SnapGrid grid_;
    glm::dvec3 pitch_;
    std::vector<glm::dvec3> seen_;
};

/// Polygons with a table of rings and one of faces.
struct TestMesh : Mesh {
    std::size_t triangles = 0;

    TestMesh(Bytes& bytes, Points& points, std::size_t most_triangles) {
        ring_starts.push_back(0);
        face_starts.push_back(0);
        while (!bytes.is_empty() && triangles < most_triangles) add_cone(bytes, points);
    }

private:
    void add_cone(Bytes& bytes, Points& points) {
        const std::uint32_t shape = bytes.next();
        std::vector<std::vector<std::uint32_t>> rings(1 + (shape >= 192));
        for (auto& ring : rings) {
            const std::size_t corners = shape < 128 ? 3 : 1 + shape % 7;
            for (std::size_t i = 0; i < corners; ++i) ring.push_back(add_vertex(points.next()));
        }
        const std::uint32_t tip = add_vertex(points.next());
        add_face(rings);
        for (const auto& ring : rings) {
            for (std::size_t i = 0; i < ring.size(); ++i) add_face({{ring[i], ring[(i + 1) % ring.size()], tip}});
        }
    }
    std::uint32_t add_vertex(const glm::dvec3& p) {
        positions.push_back(p);
        return static_cast<std::uint32_t>(positions.size() - 1);
    }
    void add_face(const std::vector<std::vector<std::uint32_t>>& rings) {
        for (const auto& ring : rings) {
            indices.insert(indices.end(), ring.begin(), ring.end());
            ring_starts.push_back(static_cast<std::uint32_t>(indices.size()));
            triangles += ring.size();
        }
        face_starts.push_back(static_cast<std::uint32_t>(ring_starts.size() - 1));
    }
};

Status solid(const MeshView& mesh, const Lattice& lattice, BitVolume& out, SolidReport& report) {
    struct alignas(16) Block {
        std::byte bytes[16];
    };
    std::vector<Block> scratch(solid_scratch_bytes(mesh, lattice) / sizeof(Block) + 1);
    return voxelize_solid(mesh, lattice, std::as_writable_bytes(std::span(scratch)), out.view(), &report);
}

/// The simplicial covering of any mesh: its bits, unless the apex is beyond the grid, are the parities of its sums.
Status simplicial(const MeshView& mesh, const Lattice& lattice, const SimplicialOptions& options, BitVolume& out,
                  SimplicialReport& report) {
    SimplicialScratch scratch(mesh);
    const Status status = voxelize_simplicial(mesh, lattice, options, scratch.bytes(), out.view(), &report);
    std::vector<std::int16_t> sums(lattice.sample_count());
    SimplicialReport sums_report;
    require(sum_inclusions(mesh, lattice, options, scratch.bytes(), sums, &sums_report) == status);
    require(sums_report.fault == report.fault && sums_report.covered == report.covered);
    if (status != Status::Ok) return status;
    std::size_t sample = 0;
    for (std::uint32_t z = 0; z < lattice.nz; ++z) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < lattice.nx; ++x) require((sums[sample++] % 2 != 0) == out.test(x, y, z));
        }
    }
    return status;
}

/// What must hold for the covering, given the bits and the status of voxelize_solid().
void check_simplicial(const MeshView& mesh, const Lattice& lattice, const SimplicialOptions& options, bool is_closed,
                      Status expected_status, const BitVolume& expected) {
    BitVolume bits(lattice);
    SimplicialReport report;
    const Status status = simplicial(mesh, lattice, options, bits, report);
    if (!lattice.is_regular()) return require(status == Status::Unsupported);  // For want of rows.
    if (status == Status::OutOfRange && report.fault == SimplicialFault::Apex) return;
    require(status == expected_status);
    if (status != Status::Ok) return;
    if (is_closed) require(bits == expected);
    for (const Axis other : {Axis::X, Axis::Y, Axis::Z}) {
        BitVolume swept(lattice);
        require(simplicial(mesh, lattice, {.apex = options.apex, .sweep = other}, swept, report) == Status::Ok);
        require(swept == bits);
    }
}

/// A way of using the fast voxelizer.
struct Engine {
    SolidOptions options;
    std::uint32_t slab_layers = 1;
    Region region;

    Engine(Bytes& bytes, const Lattice& lattice) {
        const auto kernels = available_kernels();
        options.kernel = kernels[bytes.next() % kernels.size()];
        options.threads = bytes.below(3) + 1;
        options.event_bytes = bytes.below(2) == 0 ? 1 : std::size_t{1} << 16;
        slab_layers = bytes.next() + 1u;
        const glm::uvec3 shape = whole(lattice).size;
        for (int axis = 0; axis < 3; ++axis) {
            region.begin[axis] = bytes.below(shape[axis]);
            region.size[axis] = 1 + bytes.below(shape[axis] - region.begin[axis]);
        }
    }
};

/// What must hold for the fast voxelizer, however it is used: the whole, a region, slabs and lists.
void check_fast(const MeshView& mesh, const Lattice& lattice, const Engine& use, Status expected_status,
                const BitVolume& expected) {
    SolidVoxelizer engine(use.options);
    require(engine.set_mesh(mesh) == Status::Ok);
    require(engine.set_lattice(lattice) == Status::Ok);
    BitVolume bits(lattice);
    require(engine.solid(bits.view()) == expected_status);
    if (expected_status != Status::Ok) return;
    require(bits == expected);

    const Region& region = use.region;
    BitVolume part(region.size.x, region.size.y, region.size.z);
    require(engine.solid(region, part.view()) == Status::Ok);
    for (std::uint32_t k = 0; k < region.size.z; ++k) {
        for (std::uint32_t y = 0; y < region.size.y; ++y) {
            for (std::uint32_t x = 0; x < region.size.x; ++x) {
                require(part.test(x, y, k) ==
                        expected.test(region.begin.x + x, region.begin.y + y, region.begin.z + k));
            }
        }
    }
    const std::size_t layer_words = volume_words(lattice.nx, lattice.ny, 1);
    const auto same = [&](ConstBitVolumeView slab, std::uint32_t z) {
        return std::equal(slab.words.begin(), slab.words.end(),
                          expected.view().words.begin() + static_cast<std::ptrdiff_t>(z * layer_words));
    };
    require(engine.slabs(use.slab_layers, same) == Status::Ok);
    CrossingLists lists;
    require(engine.crossings(whole(lattice), lists) == Status::Ok);
    to_bits(lists, bits.view());
    require(bits == expected);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    const TestLattice lattice(bytes);
    require(validate(lattice.view) == Status::Ok);
    Points points(bytes, lattice.view);

    const std::uint32_t choice = bytes.next();
    SimplicialOptions options{.apex = {}, .sweep = static_cast<Axis>(choice % 3)};
    if (choice >= 64) options.apex = points.next();
    const bool is_closed = choice < 224;
    const Engine engine(bytes, lattice.view);
    TestMesh mesh(bytes, points, kMostTests / lattice.view.sample_count() + 4);
    if (!is_closed && mesh.face_starts.size() > 1) mesh.face_starts.pop_back();

    BitVolume bits(lattice.view);
    SolidReport report;
    const Status status = solid(mesh.view(), lattice.view, bits, report);
    require(status == Status::Ok || status == Status::OutOfRange);
    if (status == Status::Ok) require(bits == oracle(mesh.view(), lattice.view));

    // Every other voxelizer of solids answers to the same bits and status here.
    check_simplicial(mesh.view(), lattice.view, options, is_closed, status, bits);
    check_fast(mesh.view(), lattice.view, engine, status, bits);
    return 0;
}
