#include "tools/volume_content.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "driver/display/lattice.h"
#include "voxelizer/resample.h"

namespace xorvox::tools {

Expected<std::unique_ptr<VolumeContent>> VolumeContent::make(VolumeInput input, const std::string& source,
                                                             const DisplayDescription& display, Turning turning,
                                                             double seconds_each, unsigned threads) {
    const std::vector<glm::dvec3> corners = box_corners(input.sequence.frames);
    const Expected<Placement> placement =
        fit_to_display([&corners](const auto& visit) { visit(corners); }, display, source, turning);
    if (!placement) return tl::unexpected(placement.error());
    std::unique_ptr<VolumeContent> content(new VolumeContent());
    for (SampledVolume& volume : input.sequence.frames) {
        content->frames_.push_back(std::make_shared<const SampledVolume>(std::move(volume)));
    }
    content->threshold_ = input.threshold;
    content->transfer_ = std::move(input.transfer);
    const DisplayExtent room = extent(display);
    content->placement_ = placement->matrix();
    content->lower_ = room.lower;
    content->upper_ = room.upper;
    content->seconds_each_ = content->frames_.size() > 1 ? seconds_each : 0.0;
    content->threads_ = threads;
    return content;
}

double VolumeContent::duration_seconds() const {
    return seconds_each_ * static_cast<double>(frames_.size());
}

Expected<void> VolumeContent::set_lattice(const Lattice& lattice) {
    lattice_ = lattice;
    return {};
}

Expected<void> VolumeContent::draw(double seconds, const glm::dmat4& pose, BitVolumeView voxels) {
    const double duration = duration_seconds();
    const auto at = duration > 0.0 ? static_cast<std::size_t>(std::fmod(seconds, duration) / seconds_each_) : 0;
    const std::size_t number = std::min(at, frames_.size() - 1);
    if (number != current_) color_.reset();
    current_ = number;
    const SampledVolume& volume = *frames_[current_];
    to_volume_ = display_to_volume(volume, pose * placement_);
    if (color_) color_->set_placement(host::box_to_volume(lower_, upper_, to_volume_));
    if (resample(volume, threshold_, to_volume_, lattice_, voxels, threads_) == Status::Ok) return {};
    return fail("the volume could not be resampled");
}

bool VolumeContent::has_own_color() const {
    return std::ranges::all_of(frames_, [](const auto& volume) { return volume->kind != VolumeKind::Binary; });
}

const host::ColorField* VolumeContent::own_color() {
    if (!color_) color_.emplace(frames_[current_], host::box_to_volume(lower_, upper_, to_volume_), transfer_);
    return &*color_;
}

}  // namespace xorvox::tools
