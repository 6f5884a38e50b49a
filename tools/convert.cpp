// convert: a volume of any format into bits of any format.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <new>
#include <optional>
#include <thread>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "tools/commands.h"
#include "tools/console.h"
#include "tools/placement.h"
#include "tools/stop.h"
#include "tools/volume_input.h"
#include "voxelizer/bit_volume.h"
#include "voxelizer/io/file_name.h"
#include "voxelizer/io/volume_file.h"
#include "voxelizer/resample.h"
#include "voxelizer/volume_place.h"

namespace xorvox::tools {
namespace {

/// How many times as many voxels straightening may make, beyond those that any volume may become.
constexpr double kMostGrowth = 64.0;
constexpr double kAlwaysStraightened = 1 << 24;

/// Which axis of space each axis of a volume lies along, where it lies along one.
std::optional<std::array<int, 3>> axes_along_space(const SampledVolume& volume) {
    constexpr double kAskew = 1e-6;  // Of a voxel a voxel.
    std::array<int, 3> axes{};
    std::array<bool, 3> taken{};
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 step(volume.to_mm[axis]);
        const glm::dvec3 size = glm::abs(step);
        int along = 0;
        if (size.y > size[along]) along = 1;
        if (size.z > size[along]) along = 2;
        for (int other = 0; other < 3; ++other) {
            if (other != along && size[other] > kAskew * size[along]) return std::nullopt;
        }
        if (taken[static_cast<std::size_t>(along)]) return std::nullopt;
        taken[static_cast<std::size_t>(along)] = true;
        axes[static_cast<std::size_t>(axis)] = along;
    }
    return axes;
}

/// The box of the volume, in mm.
Box box_of(const SampledVolume& volume) {
    const auto corners = box_corners({&volume, 1});
    Box box{corners.front(), corners.front()};
    for (const glm::dvec3& corner : corners) {
        box.lower = glm::min(box.lower, corner);
        box.upper = glm::max(box.upper, corner);
    }
    return box;
}

/// Voxel by voxel: the axes only change their order and direction.
Expected<BitVolume> reorder(const SampledVolume& volume, double threshold, const std::array<int, 3>& axes,
                            Lattice& lattice) {
    const glm::uvec3 sides(volume.nx, volume.ny, volume.nz);
    glm::uvec3 size(0);
    glm::bvec3 backward(false);
    for (int axis = 0; axis < 3; ++axis) {
        const int along = axes[static_cast<std::size_t>(axis)];
        const double step = volume.to_mm[axis][along];
        size[along] = sides[axis];
        backward[axis] = step < 0.0;
        lattice.pitch[along] = std::abs(step);
        const double first = volume.to_mm[3][along] + (step < 0.0 ? step * (sides[axis] - 1) : 0.0);
        lattice.origin[along] = first - std::abs(step) / 2.0;
    }
    lattice.nx = size.x;
    lattice.ny = size.y;
    lattice.nz = size.z;
    BitVolume bits(lattice);
    const BitVolumeView view = bits.view();
    std::size_t n = 0;
    glm::uvec3 at(0);
    for (at.z = 0; at.z < sides.z; ++at.z) {
        for (at.y = 0; at.y < sides.y; ++at.y) {
            for (at.x = 0; at.x < sides.x; ++at.x, ++n) {
                if (!is_inside(volume, n, threshold)) continue;
                glm::uvec3 to(0);
                for (int axis = 0; axis < 3; ++axis) {
                    to[axes[static_cast<std::size_t>(axis)]] = backward[axis] ? sides[axis] - 1 - at[axis] : at[axis];
                }
                view.flip(to.x, to.y, to.z);
            }
        }
    }
    return bits;
}

/// On a grid along the axes of space, as fine as the volume is at its finest. A long voxel that lies askew would make a
/// small file a huge one.
Expected<BitVolume> straighten(const SampledVolume& volume, double threshold, Lattice& lattice) {
    const Box box = box_of(volume);
    double pitch = glm::length(glm::dvec3(volume.to_mm[0]));
    for (int axis = 1; axis < 3; ++axis) pitch = std::min(pitch, glm::length(glm::dvec3(volume.to_mm[axis])));
    const glm::dvec3 sides = glm::ceil((box.upper - box.lower) / pitch);
    if (std::max({sides.x, sides.y, sides.z}) > kMaxLatticeSide) {
        return fail(
            fmt::format("the volume lies askew, and straightened it has {} × {} × {} voxels; at most {} a side "
                        "are written",
                        sides.x, sides.y, sides.z, kMaxLatticeSide));
    }
    const double most = std::max(kMostGrowth * static_cast<double>(volume.voxel_count()), kAlwaysStraightened);
    if (sides.x * sides.y * sides.z > most) {
        return fail(
            fmt::format("the volume lies askew, and straightened its {} × {} × {} voxels become {} × {} × {}; "
                        "resample it with the program that made it",
                        volume.nx, volume.ny, volume.nz, sides.x, sides.y, sides.z));
    }
    lattice.nx = static_cast<std::uint32_t>(sides.x);
    lattice.ny = static_cast<std::uint32_t>(sides.y);
    lattice.nz = static_cast<std::uint32_t>(sides.z);
    lattice.pitch = glm::dvec3(pitch);
    lattice.origin = (box.lower + box.upper - sides * pitch) / 2.0;
    const std::uint64_t bytes = sizeof(std::uint64_t) * volume_words(lattice.nx, lattice.ny, lattice.nz);
    if (const auto fits = check_memory(bytes, "the volume, which lies askew,"); !fits) {
        return tl::unexpected(fits.error());
    }
    BitVolume bits(lattice);
    const unsigned threads = std::clamp(std::thread::hardware_concurrency(), 1u, 64u);
    const StopRequests stop;
    const Status status =
        resample(volume, threshold, glm::inverse(volume.to_mm), lattice, bits.view(), threads, stop.token());
    if (status == Status::Cancelled) return fail("stopped; nothing was written");
    if (status != Status::Ok) return fail("the volume cannot be resampled");
    return bits;
}

}  // namespace

Expected<void> convert(const ConvertOptions& options) {
    const io::VolumeWriteOptions how{.gzip = options.gzip};
    if (const auto known = io::check_volume_path(options.output, how); !known) return known;
    Expected<VolumeInput> input = [&] {
        const Progress progress("reading " + options.input);
        return read_volume_input({&options.input, 1}, options.volume);
    }();
    if (!input) return tl::unexpected(std::move(input.error()));
    if (const std::size_t frames = input->sequence.frames.size(); frames > 1) {
        return fail(fmt::format("{} has {} frames; choose one by --volume 0 to {}", io::printable_name(options.input),
                                frames, frames - 1));
    }
    const SampledVolume& volume = input->sequence.frames.front();
    if (std::max({volume.nx, volume.ny, volume.nz}) > kMaxLatticeSide) {
        return fail(fmt::format("{}: {} × {} × {} voxels; at most {} a side are written",
                                io::printable_name(options.input), volume.nx, volume.ny, volume.nz, kMaxLatticeSide));
    }
    const auto axes = axes_along_space(volume);
    Lattice lattice;
    const auto bits =
        axes ? reorder(volume, input->threshold, *axes, lattice) : straighten(volume, input->threshold, lattice);
    if (!bits) return fail(io::printable_name(options.input) + ": " + bits.error().message);
    {
        const StopRequests stop;
        const Progress progress("writing " + options.output);
        if (auto ok = io::write_volume(options.output, bits->view(), lattice, stop.token(), how); !ok) return ok;
    }
    if (options.json) {
        fmt::print("{{\"input\": {}, \"output\": {}, \"grid\": [{}, {}, {}], \"set\": {}, \"straightened\": {}",
                   json_string(options.input), json_string(options.output), lattice.nx, lattice.ny, lattice.nz,
                   bits->count(), !axes);
        if (volume.kind == VolumeKind::Scalar) fmt::print(", \"threshold\": {}", input->threshold);
        fmt::print("}}\n");
        return {};
    }
    if (const std::string found = describe_threshold(*input); !found.empty()) fmt::print("{}\n", found);
    fmt::print("{}: {} of {} × {} × {} voxels set{}\n", io::printable_name(options.output), thousands(bits->count()),
               lattice.nx, lattice.ny, lattice.nz, axes ? "" : "; the volume lay askew and was straightened");
    return {};
}

}  // namespace xorvox::tools
