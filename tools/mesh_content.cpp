#include "tools/mesh_content.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "driver/display/lattice.h"
#include "voxelizer/voxelize.h"

namespace xorvox::tools {
namespace {

/// Moments of an animation that are looked at for the room it needs.
constexpr std::size_t kMoments = 64;

SolidOptions solid_options(unsigned threads) {
    SolidOptions options;
    options.threads = threads;
    return options;
}

}  // namespace

Expected<std::unique_ptr<MeshContent>> MeshContent::make(std::vector<NamedScene> scenes, std::size_t animation,
                                                         const DisplayDescription& display, Turning turning,
                                                         double seconds_each, unsigned threads) {
    std::unique_ptr<MeshContent> content(new MeshContent(std::move(scenes), threads));
    const io::Scene& only = content->scenes_.front().scene;
    if (content->scenes_.size() > 1) {
        content->seconds_each_ = seconds_each;
        content->duration_ = seconds_each * static_cast<double>(content->scenes_.size());
    } else if (only.motion != nullptr && animation < only.motion->animations().size()) {
        content->motion_ = only.motion.get();
        content->animation_ = animation;
        content->duration_ = content->motion_->animations()[animation].duration_seconds;
    }
    if (const auto placed = content->place(display, turning); !placed) return tl::unexpected(placed.error());
    return content;
}

MeshContent::MeshContent(std::vector<NamedScene> scenes, unsigned threads)
    : scenes_(std::move(scenes)), voxelizer_(solid_options(threads)) {}

Expected<void> MeshContent::place(const DisplayDescription& display, Turning turning) {
    const PointSource points = [this](const auto& visit) {
        if (motion_ == nullptr) {
            for (const NamedScene& scene : scenes_) visit(scene.scene.mesh.positions);
            return;
        }
        positions_.resize(scenes_.front().scene.mesh.positions.size());
        for (std::size_t moment = 0; moment <= kMoments; ++moment) {
            motion_->positions_at(animation_, duration_ * static_cast<double>(moment) / kMoments, positions_);
            visit(positions_);
        }
    };
    const Expected<Placement> placement = fit_to_display(points, display, scenes_.front().source, turning);
    if (!placement) return tl::unexpected(placement.error());
    placement_ = *placement;
    const DisplayExtent room = extent(display);
    lower_ = room.lower;
    upper_ = room.upper;
    return {};
}

Expected<void> MeshContent::set_lattice(const Lattice& lattice) {
    lattice_ = lattice;
    if (const Status status = voxelizer_.set_lattice(lattice); status != Status::Ok) return fail_as(status, {});
    return {};
}

Expected<void> MeshContent::choose(std::size_t number) {
    if (current_ == number) return {};
    current_ = number;
    color_.reset();
    SolidReport report;
    const Status status = voxelizer_.set_mesh(scenes_[number].scene.mesh.view(), &report);
    return status == Status::Ok ? Expected<void>() : fail_as(status, report);
}

void MeshContent::move(double seconds, const glm::dmat4& pose) {
    const Mesh& mesh = scenes_[*current_].scene.mesh;
    positions_.resize(mesh.positions.size());
    if (motion_ != nullptr) {
        motion_->positions_at(animation_, std::fmod(seconds, duration_), positions_);
    } else {
        std::ranges::copy(mesh.positions, positions_.begin());
    }
    const bool stands = pose == glm::dmat4(1.0);
    for (glm::dvec3& position : positions_) {
        position = placement_.place(position);
        if (!stands) position = glm::dvec3(pose * glm::dvec4(position, 1.0));
    }
}

Expected<void> MeshContent::draw(double seconds, const glm::dmat4& pose, BitVolumeView voxels) {
    const std::size_t number =
        scenes_.size() > 1 ? static_cast<std::size_t>(std::fmod(seconds, duration_) / seconds_each_) : 0;
    if (const auto chosen = choose(std::min(number, scenes_.size() - 1)); !chosen) return chosen;
    move(seconds, pose);
    if (color_) color_->set_positions(positions_);
    SolidReport report;
    Status status = voxelizer_.set_positions(positions_);
    if (status == Status::Ok) status = voxelizer_.solid(voxels, &report);
    return status == Status::Ok ? Expected<void>() : fail_as(status, report);
}

bool MeshContent::has_own_color() const {
    return std::ranges::all_of(scenes_, [](const NamedScene& scene) { return !scene.scene.colors.is_white(); });
}

const host::ColorField* MeshContent::own_color() {
    if (!color_) {
        const io::Scene& scene = scenes_[*current_].scene;
        MeshView shown = scene.mesh.view();
        shown.positions = positions_;
        color_.emplace(shown, scene.colors, lower_, upper_);
    }
    return &*color_;
}

Expected<void> MeshContent::fail_as(Status status, const SolidReport& report) const {
    const NamedScene& scene = scenes_[current_.value_or(0)];
    MeshView shown = scene.scene.mesh.view();
    if (positions_.size() == shown.positions.size()) shown.positions = positions_;
    return fail(scene.source + ": " + describe_failure(status, shown, lattice_, report).message);
}

}  // namespace xorvox::tools
