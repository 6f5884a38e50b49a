#include "tools/mesh_content.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "voxelizer/voxelize.h"

namespace xorvox::tools {
namespace {

SolidOptions solid_options(unsigned threads) {
    SolidOptions options;
    options.threads = threads;
    return options;
}

}  // namespace

Expected<MeshContent> MeshContent::make(std::vector<NamedMesh> meshes, const DisplayDescription& display,
                                        Turning turning, double seconds_each, unsigned threads) {
    std::vector<glm::dvec3> points;
    for (const NamedMesh& mesh : meshes) {
        points.insert(points.end(), mesh.mesh.positions.begin(), mesh.mesh.positions.end());
    }
    const Expected<Placement> placement = fit_to_display(points, display, meshes.front().source, turning);
    if (!placement) return tl::unexpected(placement.error());
    return MeshContent(std::move(meshes), *placement, seconds_each, threads);
}

MeshContent::MeshContent(std::vector<NamedMesh> meshes, const Placement& placement, double seconds_each,
                         unsigned threads)
    : meshes_(std::move(meshes)),
      seconds_each_(meshes_.size() > 1 ? seconds_each : 0.0),
      current_(meshes_.size()),
      voxelizer_(solid_options(threads)) {
    for (NamedMesh& mesh : meshes_) {
        for (glm::dvec3& position : mesh.mesh.positions) position = placement.place(position);
    }
}

double MeshContent::duration_seconds() const {
    return seconds_each_ * static_cast<double>(meshes_.size());
}

Expected<void> MeshContent::set_lattice(const Lattice& lattice) {
    lattice_ = lattice;
    if (const Status status = voxelizer_.set_lattice(lattice); status != Status::Ok) return fail_as(status, {});
    return {};
}

Expected<void> MeshContent::draw(double seconds, const glm::dmat4& pose, BitVolumeView voxels) {
    const double duration = duration_seconds();
    const std::size_t number =
        duration > 0.0 ? static_cast<std::size_t>(std::fmod(seconds, duration) / seconds_each_) : 0;
    const Mesh& mesh = meshes_[std::min(number, meshes_.size() - 1)].mesh;
    SolidReport report;
    if (current_ != number) {
        current_ = number;
        if (const Status status = voxelizer_.set_mesh(mesh.view(), &report); status != Status::Ok) {
            return fail_as(status, report);
        }
    }
    if (pose == glm::dmat4(1.0)) {
        positions_ = mesh.positions;
    } else {
        positions_.resize(mesh.positions.size());
        std::ranges::transform(mesh.positions, positions_.begin(),
                               [&pose](const glm::dvec3& p) { return glm::dvec3(pose * glm::dvec4(p, 1.0)); });
    }
    Status status = voxelizer_.set_positions(positions_);
    if (status == Status::Ok) status = voxelizer_.solid(voxels, &report);
    return status == Status::Ok ? Expected<void>() : fail_as(status, report);
}

Expected<void> MeshContent::fail_as(Status status, const SolidReport& report) const {
    const NamedMesh& mesh = meshes_[std::min(current_, meshes_.size() - 1)];
    MeshView moved = mesh.mesh.view();
    if (positions_.size() == moved.positions.size()) moved.positions = positions_;
    return fail(mesh.source + ": " + describe_failure(status, moved, lattice_, report).message);
}

}  // namespace xorvox::tools
