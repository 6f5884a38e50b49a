#include "sim/rebuild.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace xorvox::sim {
namespace {

constexpr double kSamePlace = 1e-6;  ///< Of the smallest distance: far above rounding, far below what parts differ by.
constexpr double kSamePoint = 1e-9;  ///< Of the size of a set of points, whose smallest distance is to be found.
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double smallest_distance_mm(const DisplayDescription& display, const Lattice& lattice) {
    const Panel& first = display.panels[0];
    if (display.kind == DisplayKind::FreePoints) {
        std::vector<glm::dvec3> places;
        places.reserve(display.points.size());
        double size = 0.0;
        for (const PointMm& point : display.points) {
            places.emplace_back(point.x, point.y, point.z);
            size = std::max(size, glm::distance(places.back(), places.front()));
        }
        const double distance = smallest_distance(places, kSamePoint * size);
        return distance < kInfinity ? distance : first.column_pitch_mm;
    }
    double distance = lattice.is_regular() ? lattice.pitch.z : kInfinity;
    for (std::size_t k = 1; k < lattice.z.size(); ++k) distance = std::min(distance, lattice.z[k] - lattice.z[k - 1]);
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        distance = std::min({distance, display.panels[p].column_pitch_mm, display.panels[p].row_pitch_mm});
    }
    return distance;
}

/// One entry a place, by sample number.
void gather(std::vector<SeenPlace>& places) {
    const auto lower = [](const SeenPlace& a, const SeenPlace& b) { return a.sample < b.sample; };
    if (!std::ranges::is_sorted(places, lower)) std::ranges::sort(places, lower);
    std::size_t kept = 0;
    for (const SeenPlace& place : places) {
        if (kept > 0 && places[kept - 1].sample == place.sample) {
            places[kept - 1].visits += place.visits;
            places[kept - 1].code_total += place.code_total;
        } else {
            places[kept++] = place;
        }
    }
    places.resize(kept);
}

}  // namespace

DisplaySamples::DisplaySamples(const DisplayDescription& display)
    : owner_(display),
      lattice_(owner_.view()),
      reach_mm_(smallest_distance_mm(display, lattice_) / 4.0),
      grid_(4.0 * reach_mm_, lattice_.is_regular() ? 0 : lattice_.column_count()) {
    if (!lattice_.is_regular()) make_groups();
}

void DisplaySamples::make_groups() {
    const double same_mm = 4.0 * reach_mm_ * kSamePlace;
    group_of_.reserve(lattice_.column_count());
    groups_.reserve(lattice_.column_count());
    for (std::uint32_t y = 0; y < lattice_.ny; ++y) {
        for (std::uint32_t x = 0; x < lattice_.nx; ++x) {
            const auto column = static_cast<std::uint32_t>(group_of_.size());
            const glm::dvec3 place = in_grid(sample_position(lattice_, x, y, 0));
            const double z0 = lattice_.z0.empty() ? 0.0 : lattice_.z0[column];
            auto group = static_cast<std::uint32_t>(groups_.size());
            grid_.near(place, same_mm, [&](std::uint32_t found, double) {
                assert(std::abs(groups_[found].z0 - z0) <= same_mm);
                group = found;
            });
            if (group == groups_.size()) {
                grid_.add(place);
                groups_.push_back({z0, column});
            }
            group_of_.push_back(group);
        }
    }
    groups_.shrink_to_fit();
}

/// The sample of a column at z0 = 0 that is nearest to `z`.
std::uint32_t DisplaySamples::nearest_k(double z) const {
    const std::span<const double> table = lattice_.z;
    if (table.size() == 1) return 0;
    // Mostly the table is even.
    const double last = static_cast<double>(table.size() - 1);
    const double step = (table.back() - table.front()) / last;
    const auto guess = static_cast<std::size_t>(std::clamp((z - table.front()) / step + 0.5, 0.0, last));
    if (std::abs(table[guess] - z) < reach_mm_) return static_cast<std::uint32_t>(guess);
    auto above = std::ranges::lower_bound(table, z);
    if (above == table.end() || (above != table.begin() && z - *(above - 1) < *above - z)) --above;
    return static_cast<std::uint32_t>(above - table.begin());
}

std::uint64_t DisplaySamples::place_of(std::uint64_t sample) const {
    if (lattice_.is_regular()) return sample;
    const auto column = static_cast<std::size_t>(sample % lattice_.column_count());
    return sample - column + groups_[group_of_[column]].column;
}

std::optional<std::uint64_t> DisplaySamples::place_near_regular(const glm::dvec3& place_mm) const {
    const glm::dvec3 last(lattice_.nx - 1, lattice_.ny - 1, lattice_.nz - 1);
    const glm::dvec3 steps = (place_mm - lattice_.origin) / lattice_.pitch;
    const glm::dvec3 nearest = glm::clamp(glm::floor(steps), glm::dvec3(0.0), last);
    const auto x = static_cast<std::uint32_t>(nearest.x);
    const auto y = static_cast<std::uint32_t>(nearest.y);
    const auto k = static_cast<std::uint32_t>(nearest.z);
    if (glm::distance(sample_position(lattice_, x, y, k), place_mm) > reach_mm_) return std::nullopt;
    return (std::uint64_t{k} * lattice_.ny + y) * lattice_.nx + x;
}

std::optional<std::uint64_t> DisplaySamples::place_near(const glm::dvec3& place_mm) const {
    if (lattice_.is_regular()) return place_near_regular(place_mm);
    double least = reach_mm_;
    std::optional<std::uint64_t> nearest;
    grid_.near(in_grid(place_mm), reach_mm_, [&](std::uint32_t group, double distance) {
        if (distance > least) return;
        const std::uint32_t k = nearest_k(place_mm.z - groups_[group].z0);
        // Of a column of one sample, `distance` is all of it.
        if (lattice_.nz > 1) distance = std::hypot(distance, groups_[group].z0 + lattice_.z[k] - place_mm.z);
        if (distance > least) return;
        least = distance;
        nearest = std::uint64_t{k} * lattice_.column_count() + groups_[group].column;
    });
    return nearest;
}

Rebuilt DisplaySamples::rebuild(const LightField& field) const {
    Rebuilt rebuilt;
    rebuilt.places.reserve(field.flashes.size());
    for (const Flash& flash : field.flashes) {
        if (const auto place = place_near(flash.place_mm)) {
            rebuilt.places.push_back({*place, flash.code, 1});
        } else {
            ++rebuilt.outside;
        }
    }
    gather(rebuilt.places);
    return rebuilt;
}

Rebuilt DisplaySamples::faithful(std::span<const SampleCode> codes) const {
    Rebuilt rebuilt;
    rebuilt.places.reserve(codes.size());
    for (const SampleCode& lit : codes) {
        assert(lit.sample < size() && lit.code != 0);
        rebuilt.places.push_back({place_of(lit.sample), lit.code, 1});
    }
    gather(rebuilt.places);
    return rebuilt;
}

}  // namespace xorvox::sim
