#include "tools/volume_input.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "driver/host/volume_color.h"
#include "voxelizer/io/file_name.h"
#include "voxelizer/io/volume_reader.h"
#include "voxelizer/resample.h"

namespace xorvox::tools {
namespace {

Expected<void> check_options(const SampledVolume& first, const VolumeOptions& options, const std::string& name) {
    if (first.kind == VolumeKind::Scalar) return {};
    const char* const given = options.threshold ? "--threshold" : options.transfer ? "--transfer" : nullptr;
    if (given == nullptr) return {};
    return fail(fmt::format("{} is for volumes of values, and {} has {}; leave it away", given, name,
                            first.kind == VolumeKind::Binary   ? "only inside and outside"
                            : first.kind == VolumeKind::Labels ? "labels"
                                                               : "colours"));
}

Expected<void> choose_frame(VolumeSequence& sequence, std::uint32_t frame, const std::string& name) {
    if (frame >= sequence.frames.size()) {
        return fail(fmt::format(
            "--volume is {}, and {} has {}; they count from 0", frame, name,
            sequence.frames.size() == 1 ? "one volume" : fmt::format("{} volumes", sequence.frames.size())));
    }
    SampledVolume chosen = std::move(sequence.frames[frame]);
    sequence.frames.clear();
    sequence.frames.push_back(std::move(chosen));
    return {};
}

}  // namespace

Expected<VolumeInput> read_volume_input(std::span<const std::string> paths, const VolumeOptions& options) {
    VolumeInput input;
    std::vector<SampledVolume>& frames = input.sequence.frames;
    for (const std::string& path : paths) {
        auto sequence = io::read_volumes(path);
        if (!sequence) return tl::unexpected(std::move(sequence.error()));
        const std::string name = io::printable_name(path);
        if (options.frame) {
            if (auto ok = choose_frame(*sequence, *options.frame, name); !ok)
                return tl::unexpected(std::move(ok.error()));
        }
        if (auto ok = check_options(sequence->frames.front(), options, name); !ok)
            return tl::unexpected(std::move(ok.error()));
        std::ranges::move(sequence->frames, std::back_inserter(frames));
    }
    std::vector<std::span<const float>> values;
    for (const SampledVolume& volume : frames) {
        if (volume.kind == VolumeKind::Scalar) values.emplace_back(volume.values);
    }
    if (values.empty()) return input;
    input.threshold_found = !options.threshold;
    input.threshold = options.threshold ? *options.threshold : otsu_threshold(values);
    input.transfer = options.transfer ? *options.transfer
                                      : host::default_transfer(input.threshold, value_range(input.sequence).most);
    return input;
}

std::string describe_threshold(const VolumeInput& input) {
    if (!input.threshold_found) return {};
    return fmt::format("threshold {:.6g}, found by Otsu's method; --threshold sets another", input.threshold);
}

const char* kind_name(VolumeKind kind) {
    switch (kind) {
        case VolumeKind::Binary: return "binary";
        case VolumeKind::Scalar: return "scalar";
        case VolumeKind::Labels: return "labels";
        case VolumeKind::Colors: break;
    }
    return "colors";
}

ValueRange value_range(const VolumeSequence& sequence) {
    ValueRange range;
    bool any = false;
    for (const SampledVolume& volume : sequence.frames) {
        if (volume.kind != VolumeKind::Scalar) continue;
        const auto [least, most] = std::ranges::minmax_element(volume.values);
        range.least = any ? std::min(range.least, double{*least}) : double{*least};
        range.most = any ? std::max(range.most, double{*most}) : double{*most};
        any = true;
    }
    return range;
}

std::vector<glm::dvec3> box_corners(std::span<const SampledVolume> frames) {
    std::vector<glm::dvec3> corners;
    for (const SampledVolume& volume : frames) {
        for (unsigned corner = 0; corner < 8; ++corner) {
            const auto end = [corner](unsigned axis, std::uint32_t side) {
                return (corner >> axis) & 1 ? side - 0.5 : -0.5;
            };
            corners.emplace_back(volume.to_mm *
                                 glm::dvec4(end(0, volume.nx), end(1, volume.ny), end(2, volume.nz), 1.0));
        }
    }
    return corners;
}

glm::dmat4 display_to_volume(const SampledVolume& volume, const glm::dmat4& placed) {
    return glm::inverse(placed * volume.to_mm);
}

}  // namespace xorvox::tools
