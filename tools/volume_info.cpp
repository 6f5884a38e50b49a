// What a volume file holds, for `xorvox info`.
#include <algorithm>
#include <cstdio>
#include <set>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "tools/console.h"
#include "tools/volume_info.h"
#include "tools/volume_input.h"
#include "voxelizer/io/file_name.h"
#include "voxelizer/volume_place.h"

namespace xorvox::tools {
namespace {

struct Facts {
    glm::dvec3 spacing{0.0};
    glm::dvec3 lower{0.0};
    glm::dvec3 upper{0.0};
    ValueRange range;
    std::size_t labels = 0;  ///< Other than 0.
    std::size_t inside = 0;  ///< Of the first frame.
};

Facts facts_of(const VolumeInput& input) {
    Facts facts;
    const SampledVolume& first = input.sequence.frames.front();
    for (int axis = 0; axis < 3; ++axis) facts.spacing[axis] = glm::length(glm::dvec3(first.to_mm[axis]));
    const auto corners = box_corners(input.sequence.frames);
    facts.lower = facts.upper = corners.front();
    for (const glm::dvec3& corner : corners) {
        facts.lower = glm::min(facts.lower, corner);
        facts.upper = glm::max(facts.upper, corner);
    }
    facts.range = value_range(input.sequence);
    if (first.kind == VolumeKind::Labels) {
        std::set<float> labels;
        for (const SampledVolume& volume : input.sequence.frames) {
            float last = 0.0f;  // Labels come in runs.
            for (const float value : volume.values) {
                if (value != last && value != 0.0f) labels.insert(value);
                last = value;
            }
        }
        facts.labels = labels.size();
    }
    for (std::size_t n = 0; n < first.voxel_count(); ++n) {
        if (is_inside(first, n, input.threshold)) ++facts.inside;
    }
    return facts;
}

void print_json(const std::string& path, const VolumeInput& input, const Facts& f) {
    const SampledVolume& first = input.sequence.frames.front();
    fmt::print(
        "{{\"volume\": {}, \"kind\": \"{}\", \"size\": [{}, {}, {}], \"spacing\": [{}, {}, {}], \"min\": [{}, {}, {}], "
        "\"max\": [{}, {}, {}], \"frames\": {}, \"inside\": {}",
        json_string(path), kind_name(first.kind), first.nx, first.ny, first.nz, f.spacing.x, f.spacing.y, f.spacing.z,
        f.lower.x, f.lower.y, f.lower.z, f.upper.x, f.upper.y, f.upper.z, input.sequence.frames.size(), f.inside);
    if (first.kind == VolumeKind::Scalar) {
        fmt::print(", \"least\": {}, \"most\": {}, \"threshold\": {}", f.range.least, f.range.most, input.threshold);
    }
    if (first.kind == VolumeKind::Labels) {
        fmt::print(", \"labels\": {}, \"palette\": {}", f.labels, first.palette.size());
    }
    fmt::print("}}\n");
}

void print_text(const std::string& path, const VolumeInput& input, const Facts& f) {
    const SampledVolume& first = input.sequence.frames.front();
    const glm::dvec3 size = f.upper - f.lower;
    const auto line = [](const char* name, const std::string& text) { fmt::print("  {:<20}{}\n", name, text); };
    fmt::print("{}\n", io::printable_name(path));
    line("kind", kind_name(first.kind));
    line("voxels", fmt::format("{} × {} × {} = {}", first.nx, first.ny, first.nz, thousands(first.voxel_count())));
    line("frames", thousands(input.sequence.frames.size()));
    line("spacing", fmt::format("{:.6g} × {:.6g} × {:.6g} mm", f.spacing.x, f.spacing.y, f.spacing.z));
    line("size", fmt::format("{:.6g} × {:.6g} × {:.6g} mm", size.x, size.y, size.z));
    line("box", fmt::format("{:.6g}, {:.6g}, {:.6g} to {:.6g}, {:.6g}, {:.6g}", f.lower.x, f.lower.y, f.lower.z,
                            f.upper.x, f.upper.y, f.upper.z));
    if (first.kind == VolumeKind::Scalar) {
        line("values", fmt::format("{:.6g} to {:.6g}", f.range.least, f.range.most));
        line("threshold",
             fmt::format("{:.6g}{}", input.threshold, input.threshold_found ? ", found by Otsu's method" : ""));
    }
    if (first.kind == VolumeKind::Labels) {
        line("labels",
             fmt::format("{}, {}", thousands(f.labels), first.palette.empty() ? "without colours" : "with a palette"));
    }
    line("inside", fmt::format("{} voxels{}", thousands(f.inside),
                               input.sequence.frames.size() > 1 ? " of the first frame" : ""));
}

}  // namespace

Expected<void> volume_info(const std::string& path, const VolumeOptions& options, bool json) {
    Expected<VolumeInput> input = [&] {
        const Progress progress("reading " + path);
        return read_volume_input({&path, 1}, options);
    }();
    if (!input) return tl::unexpected(std::move(input.error()));
    (json ? print_json : print_text)(path, *input, facts_of(*input));
    return {};
}

}  // namespace xorvox::tools
