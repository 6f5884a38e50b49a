#include "voxelizer/simplicial.h"

#include <algorithm>
#include <limits>

#include "voxelizer/faces.h"
#include "voxelizer/int128.h"
#include "voxelizer/scratch.h"
#include "voxelizer/tetrahedron.h"

namespace xorvox {
namespace {

ScanGrid scan_grid(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, std::uint32_t shift, Axis sweep) {
    ScanGrid grid{.count = {nx, ny, nz}, .shift = shift};
    switch (sweep) {
        case Axis::X: grid.slice_axis = 0, grid.row_axis = 2, grid.column_axis = 1; break;
        case Axis::Y: grid.slice_axis = 1, grid.row_axis = 2, grid.column_axis = 0; break;
        case Axis::Z: grid.slice_axis = 2, grid.row_axis = 1, grid.column_axis = 0; break;
    }
    return grid;
}

struct Sample {
    std::uint32_t x;
    std::uint32_t y;
    std::uint32_t z;
};

constexpr Sample sample_of(Axis sweep, std::uint32_t slice, std::uint32_t row, std::uint32_t column) {
    switch (sweep) {
        case Axis::X: return {slice, column, row};
        case Axis::Y: return {column, slice, row};
        case Axis::Z: break;
    }
    return {column, row, slice};
}

/// Flips bits begin … end-1 of a row; begin < end.
void flip_run(std::span<std::uint64_t> row, std::uint32_t begin, std::uint32_t end) {
    constexpr std::uint64_t kAll = ~std::uint64_t{0};
    const std::size_t last = (end - 1) / 64;
    std::size_t word = begin / 64;
    std::uint64_t mask = kAll << (begin % 64);
    for (; word < last; ++word) {
        row[word] ^= mask;
        mask = kAll;
    }
    row[word] ^= mask & (kAll >> (63 - (end - 1) % 64));
}

/// The mean of the faces' corners. There are too few of them in any memory for the sums to overflow: below 2^33.
glm::ivec3 centroid(const MeshView& mesh, SnappedVertices vertices) {
    const auto corners = mesh.used_indices();
    if (corners.empty()) return glm::ivec3(0);
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::int64_t z = 0;
    for (const std::uint32_t index : corners) {
        x += vertices[index].x;
        y += vertices[index].y;
        z += vertices[index].z;
    }
    const auto count = static_cast<std::int64_t>(corners.size());
    const auto mean = [count](std::int64_t sum) {
        return static_cast<std::int32_t>(floor_divide(sum + count / 2, count));
    };
    return {mean(x), mean(y), mean(z)};
}

Status check_lattice(const Lattice& lattice, SimplicialFault& fault) {
    const Status status = validate(lattice);
    if (status == Status::OutOfRange) fault = SimplicialFault::Lattice;
    if (status != Status::Ok) return status;
    return lattice.is_regular() ? Status::Ok : Status::Unsupported;
}

/// A mesh on the snapping grid, and the apex.
struct Prepared {
    SnappedVertices vertices;
    glm::ivec3 apex{0};
};

/// Everything after the checks of lattice and output that can fail without touching the output.
Status prepare(const MeshView& mesh, const Lattice& lattice, const SimplicialOptions& options,
               std::span<std::byte> scratch, Prepared& prepared, SimplicialReport& report) {
    if (!is_aligned(scratch)) return Status::InvalidArgument;
    if (const Status status = validate(mesh, &report.bad_index); status != Status::Ok) return status;
    if (scratch.size() < simplicial_scratch_bytes(mesh)) return Status::OutOfMemory;

    const SnapGrid grid = snap_grid(lattice);
    if (options.apex && !snap(grid, *options.apex, prepared.apex)) {
        report.fault = SimplicialFault::Apex;
        return Status::OutOfRange;
    }
    Scratch memory(scratch);
    const auto vertices = memory.take<glm::ivec3>(mesh.positions.size());
    if (!snap_vertices(mesh, grid, vertices, report.bad_vertex)) {
        report.fault = SimplicialFault::Vertex;
        return Status::OutOfRange;
    }
    prepared.vertices = vertices;
    if (!options.apex) prepared.apex = centroid(mesh, vertices);
    report.apex = prepared.apex;
    return Status::Ok;
}

/// Adds `sign` to a run of counters; false, at once, when one of them would leave its range.
bool add_to_run(std::int16_t* counter, std::size_t step, std::uint32_t length, int sign) {
    using Limits = std::numeric_limits<std::int16_t>;
    const std::int16_t limit = sign > 0 ? Limits::max() : Limits::min();
    for (std::uint32_t i = 0; i < length; ++i, counter += step) {
        if (*counter == limit) return false;
        *counter = static_cast<std::int16_t>(*counter + sign);
    }
    return true;
}

}  // namespace

std::size_t simplicial_scratch_bytes(const MeshView& mesh) {
    return Scratch::bytes<glm::ivec3>(mesh.positions.size());
}

Status SimplicialCovering::start(const Lattice& lattice, const glm::dvec3& apex, Axis sweep, BitVolumeView volume) {
    SimplicialFault ignored{};
    if (const Status status = check_lattice(lattice, ignored); status != Status::Ok) return status;
    glm::ivec3 snapped{0};
    if (!snap(snap_grid(lattice), apex, snapped)) return Status::OutOfRange;
    return start_snapped(lattice, snapped, sweep, volume);
}

Status SimplicialCovering::start_snapped(const Lattice& lattice, const glm::ivec3& apex, Axis sweep,
                                         BitVolumeView volume) {
    SimplicialFault ignored{};
    if (const Status status = check_lattice(lattice, ignored); status != Status::Ok) return status;
    if (!fits(volume, lattice)) return Status::InvalidArgument;
    grid_ = snap_grid(lattice);
    apex_ = apex;
    sweep_ = sweep;
    volume_ = volume;
    tetrahedra_ = 0;
    covered_ = 0;
    for (std::uint64_t& word : volume.words) word = 0;
    return Status::Ok;
}

Status SimplicialCovering::add(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    glm::ivec3 corners[3];
    if (!snap(grid_, a, corners[0]) || !snap(grid_, b, corners[1]) || !snap(grid_, c, corners[2])) {
        return Status::OutOfRange;
    }
    add_snapped(corners[0], corners[1], corners[2]);
    return Status::Ok;
}

void SimplicialCovering::add_snapped(const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c) {
    Tetrahedron tetrahedron;
    const ScanGrid grid = scan_grid(volume_.nx, volume_.ny, volume_.nz, grid_.shift, sweep_);
    if (!tetrahedron.set(grid, apex_, a, b, c)) return;
    ++tetrahedra_;
    tetrahedron.scan([this](std::uint32_t slice, std::uint32_t row, std::uint32_t begin, std::uint32_t end) {
        covered_ += end - begin;
        const Sample first = sample_of(sweep_, slice, row, begin);
        if (sweep_ != Axis::X) return flip_run(volume_.row(first.y, first.z), begin, end);
        for (std::uint32_t y = begin; y < end; ++y) volume_.flip(first.x, y, first.z);
    });
}

Status voxelize_simplicial(const MeshView& mesh, const Lattice& lattice, const SimplicialOptions& options,
                           std::span<std::byte> scratch, BitVolumeView out, SimplicialReport* report) {
    SimplicialReport ignored;
    SimplicialReport& found = report == nullptr ? ignored : *report;
    found = {};
    if (const Status status = check_lattice(lattice, found.fault); status != Status::Ok) return status;
    if (!fits(out, lattice)) return Status::InvalidArgument;
    Prepared prepared;
    if (const Status status = prepare(mesh, lattice, options, scratch, prepared, found); status != Status::Ok) {
        return status;
    }
    SimplicialCovering covering;
    if (const Status status = covering.start_snapped(lattice, prepared.apex, options.sweep, out);
        status != Status::Ok) {
        return status;
    }
    for (std::size_t face = 0; face < mesh.face_count(); ++face) {
        fan(mesh, face, prepared.vertices,
            [&](const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c) { covering.add_snapped(a, b, c); });
    }
    found.tetrahedra = covering.tetrahedra();
    found.covered = covering.covered();
    return Status::Ok;
}

Status sum_inclusions(const MeshView& mesh, const Lattice& lattice, const SimplicialOptions& options,
                      std::span<std::byte> scratch, std::span<std::int16_t> sums, SimplicialReport* report) {
    SimplicialReport ignored;
    SimplicialReport& found = report == nullptr ? ignored : *report;
    found = {};
    if (const Status status = check_lattice(lattice, found.fault); status != Status::Ok) return status;
    // In 64 bits, because on a microcontroller the product may exceed SIZE_MAX.
    if (sums.size() != std::uint64_t{lattice.nx} * lattice.ny * lattice.nz) return Status::InvalidArgument;
    Prepared prepared;
    if (const Status status = prepare(mesh, lattice, options, scratch, prepared, found); status != Status::Ok) {
        return status;
    }
    std::fill(sums.begin(), sums.end(), std::int16_t{0});
    const ScanGrid grid = scan_grid(lattice.nx, lattice.ny, lattice.nz, snap_grid(lattice).shift, options.sweep);
    const std::size_t step = options.sweep == Axis::X ? lattice.nx : 1;
    Tetrahedron tetrahedron;
    bool in_range = true;
    const auto add = [&](const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c) {
        if (!in_range || !tetrahedron.set(grid, prepared.apex, a, b, c)) return;
        ++found.tetrahedra;
        tetrahedron.scan([&](std::uint32_t slice, std::uint32_t row, std::uint32_t begin, std::uint32_t end) {
            found.covered += end - begin;
            const Sample first = sample_of(options.sweep, slice, row, begin);
            const std::size_t at = (std::size_t{first.z} * lattice.ny + first.y) * lattice.nx + first.x;
            in_range = in_range && add_to_run(&sums[at], step, end - begin, tetrahedron.sign());
        });
    };
    for (std::size_t face = 0; face < mesh.face_count() && in_range; ++face) fan(mesh, face, prepared.vertices, add);
    if (in_range) return Status::Ok;
    std::fill(sums.begin(), sums.end(), std::int16_t{0});
    found = {.fault = SimplicialFault::Counter};
    return Status::OutOfRange;
}

InclusionReport inspect_inclusions(std::span<const std::int16_t> sums) {
    InclusionReport report;
    for (const std::int16_t sum : sums) {
        report.outside += sum == 0;
        report.inside += sum == 1;
        report.negative += sum < 0;
        report.multiple += sum > 1;
        report.lowest = std::min(report.lowest, sum);
        report.highest = std::max(report.highest, sum);
    }
    return report;
}

Status positive_inclusions(std::span<const std::int16_t> sums, BitVolumeView out) {
    if (sums.size() != std::uint64_t{out.nx} * out.ny * out.nz ||
        out.words.size() != std::uint64_t{row_words(out.nx)} * out.ny * out.nz) {
        return Status::InvalidArgument;
    }
    for (std::uint64_t& word : out.words) word = 0;
    std::size_t sample = 0;
    for (std::uint32_t z = 0; z < out.nz; ++z) {
        for (std::uint32_t y = 0; y < out.ny; ++y) {
            const auto row = out.row(y, z);
            for (std::uint32_t x = 0; x < out.nx; ++x, ++sample) {
                if (sums[sample] > 0) row[x / 64] |= std::uint64_t{1} << (x % 64);
            }
        }
    }
    return Status::Ok;
}

}  // namespace xorvox
