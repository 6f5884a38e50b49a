#include "sim/rebuild.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "driver/display/lattice.h"

namespace xorvox::sim {
namespace {

constexpr double kSamePlace = 1e-6;  ///< In pitches. Far above rounding, far below what a display can tell apart.
constexpr std::uint32_t kNoGroup = std::numeric_limits<std::uint32_t>::max();

double smallest_pitch_mm(const DisplayDescription& display) {
    double pitch =
        display.kind == DisplayKind::StackedPlanes ? display.plane_pitch_mm : std::numeric_limits<double>::infinity();
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        pitch = std::min({pitch, display.panels[p].column_pitch_mm, display.panels[p].row_pitch_mm});
    }
    return pitch;
}

std::vector<glm::dvec2> plan_of(const Lattice& lattice) {
    assert(lattice.z0.empty());  // Columns start at one height, so the nearest column has the nearest sample.
    std::vector<glm::dvec2> plan;
    plan.reserve(lattice.column_count());
    for (std::uint32_t y = 0; y < lattice.ny; ++y) {
        for (std::uint32_t x = 0; x < lattice.nx; ++x) plan.emplace_back(sample_position(lattice, x, y, 0));
    }
    return plan;
}

std::vector<double> heights_of(const Lattice& lattice) {
    std::vector<double> heights;
    heights.reserve(lattice.nz);
    for (std::uint32_t k = 0; k < lattice.nz; ++k) heights.push_back(sample_position(lattice, 0, 0, k).z);
    return heights;
}

}  // namespace

DisplaySamples::DisplaySamples(const DisplayDescription& display)
    : plan_mm_(plan_of(DisplayLattice(display).view())),
      z_mm_(heights_of(DisplayLattice(display).view())),
      reach_mm_(smallest_pitch_mm(display) / 4.0),
      tree_(plan_mm_),
      group_of_(plan_mm_.size(), kNoGroup),
      group_begin_{0} {
    const double same_place_mm = kSamePlace * smallest_pitch_mm(display);
    columns_.reserve(plan_mm_.size());
    for (std::size_t column = 0; column < plan_mm_.size(); ++column) {
        if (group_of_[column] != kNoGroup) continue;
        for (const std::uint32_t other : tree_.within(plan_mm_[column], same_place_mm)) {
            if (group_of_[other] != kNoGroup) continue;
            group_of_[other] = static_cast<std::uint32_t>(group_count());
            columns_.push_back(other);
        }
        group_begin_.push_back(columns_.size());
    }
}

DisplaySamples::Nearest DisplaySamples::nearest(const glm::dvec3& place_mm) const {
    const PlanTree::Nearest found = tree_.nearest({place_mm.x, place_mm.y});
    auto above = std::lower_bound(z_mm_.begin(), z_mm_.end(), place_mm.z);
    if (above == z_mm_.end() || (above != z_mm_.begin() && place_mm.z - *(above - 1) < *above - place_mm.z)) --above;
    return {found.index, static_cast<std::uint32_t>(above - z_mm_.begin()),
            std::hypot(found.distance, *above - place_mm.z)};
}

Rebuilt DisplaySamples::nothing() const {
    return {std::vector<std::uint32_t>(size()), std::vector<std::uint64_t>(size()), 0};
}

void DisplaySamples::count(Rebuilt& rebuilt, std::uint32_t column, std::size_t k, std::uint32_t code) const {
    for (const std::uint32_t member : columns_of(group_of(column))) {
        const std::size_t sample = k * column_count() + member;
        ++rebuilt.visits[sample];
        rebuilt.code_total[sample] += code;
    }
}

Rebuilt DisplaySamples::rebuild(const LightField& field) const {
    Rebuilt rebuilt = nothing();
    for (const Flash& flash : field.flashes) {
        const Nearest found = nearest(flash.place_mm);
        if (found.distance_mm <= reach_mm_) {
            count(rebuilt, found.column, found.k, flash.code);
        } else {
            ++rebuilt.outside;
        }
    }
    return rebuilt;
}

Rebuilt DisplaySamples::faithful(std::span<const std::uint32_t> codes) const {
    assert(codes.size() == size());
    Rebuilt rebuilt = nothing();
    for (std::size_t sample = 0; sample < codes.size(); ++sample) {
        if (codes[sample] == 0) continue;
        count(rebuilt, static_cast<std::uint32_t>(sample % column_count()), sample / column_count(), codes[sample]);
    }
    return rebuilt;
}

Rebuilt rebuild(const DisplayDescription& display, const LightField& field) {
    return DisplaySamples(display).rebuild(field);
}

}  // namespace xorvox::sim
