#include "driver/host/slice_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace xorvox::host {
namespace {

constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
constexpr double kMaxGridVoxels = 1u << 30;

/// The distances at which the display's pixels stand along x, y and z.
glm::dvec3 pitches_mm(const DisplayDescription& display, const DisplayExtent& room) {
    const Panel& first = display.panels[0];
    if (display.kind == DisplayKind::FreePoints) return glm::dvec3(first.column_pitch_mm);
    if (display.kind != DisplayKind::RotatingPanel) {
        return {first.column_pitch_mm, first.row_pitch_mm, (room.upper.z - room.lower.z) / display.slices};
    }
    double along = upright_column_pitch_mm(first);
    double up = upright_row_pitch_mm(first);
    for (std::uint32_t p = 1; p < display.panel_count; ++p) {
        along = std::min(along, upright_column_pitch_mm(display.panels[p]));
        up = std::min(up, upright_row_pitch_mm(display.panels[p]));
    }
    return {along, along, up};
}

/// The voxel, of `count` along one axis, that `place` stands in; the nearest one where rounding leads out of the grid.
std::uint32_t index_at(double place, double origin, double pitch, std::uint32_t count) {
    const double index = std::floor((place - origin) / pitch);
    return static_cast<std::uint32_t>(std::clamp(index, 0.0, count - 1.0));
}

/// Distance of `place` from the middle of voxel `index`.
double off_centre(double place, double origin, double pitch, std::uint32_t index) {
    return std::abs(place - (origin + (index + 0.5) * pitch));
}

/// The panel of each entry of a row of the lattice.
std::vector<std::uint8_t> panels_of_row(const DisplayDescription& display, std::uint32_t nx) {
    std::vector<std::uint8_t> panels;
    if (display.kind != DisplayKind::RotatingPanel) return std::vector<std::uint8_t>(nx, 0);
    const bool upright = is_upright(display);
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const std::size_t count = upright ? upright_columns(panel) : std::size_t{panel.columns} * panel.rows;
        panels.insert(panels.end(), count, static_cast<std::uint8_t>(p));
    }
    return panels;
}

}  // namespace

Lattice cartesian_grid(const DisplayDescription& display) {
    const DisplayExtent room = extent(display);
    const glm::dvec3 size = room.upper - room.lower;
    glm::dvec3 counts = glm::clamp(glm::round(size / pitches_mm(display, room)), 1.0, double{kMaxLatticeSide});
    // Free points may be few and far apart.
    const double voxels = counts.x * counts.y * counts.z;
    if (voxels > kMaxGridVoxels) counts = glm::max(glm::floor(counts * std::cbrt(kMaxGridVoxels / voxels)), 1.0);
    Lattice grid;
    grid.nx = static_cast<std::uint32_t>(counts.x);
    grid.ny = static_cast<std::uint32_t>(counts.y);
    grid.nz = static_cast<std::uint32_t>(counts.z);
    grid.origin = room.lower;
    grid.pitch = size / counts;
    return grid;
}

SliceMap::SliceMap(const DisplayDescription& display, const DisplayLattice& lattice)
    : display_lattice_(lattice), grid_(cartesian_grid(display)), radius_mm_(extent(display).radius_mm) {
    const Lattice view = lattice.view();
    if (view.is_regular()) {
        grid_ = view;
        identical_ = true;
        return;
    }
    map_columns(view, display);
    choose_heights(view);
    choose_columns(view, display);
}

std::uint32_t SliceMap::height(double z_mm) const {
    return index_at(z_mm, grid_.origin.z, grid_.pitch.z, grid_.nz);
}

std::uint32_t SliceMap::height(std::size_t column, std::uint32_t k) const {
    return has_own_heights() ? height(bases_[column] + display_lattice_.view().z[k]) : heights_[k];
}

void SliceMap::map_columns(const Lattice& lattice, const DisplayDescription& display) {
    columns_.reserve(lattice.column_count());
    for (const glm::dvec2& place : lattice.plan) {
        const std::uint32_t x = index_at(place.x, grid_.origin.x, grid_.pitch.x, grid_.nx);
        const std::uint32_t y = index_at(place.y, grid_.origin.y, grid_.pitch.y, grid_.ny);
        columns_.push_back(y * grid_.nx + x);
    }
    bases_.assign(lattice.z0.begin(), lattice.z0.end());
    // On a helix every column begins in the lowest step of height; it is k that says which, not the rounding of its
    // base.
    if (display.kind == DisplayKind::Helix) bases_.clear();
    if (has_own_heights()) return;
    heights_.reserve(lattice.nz);
    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        heights_.push_back(display.kind == DisplayKind::Helix
                               ? static_cast<std::uint32_t>(std::uint64_t{k} * grid_.nz / lattice.nz)
                               : height(lattice.z[k]));
    }
}

/// Of the heights in one voxel, the nearest to its middle.
void SliceMap::choose_heights(const Lattice& lattice) {
    lit_heights_.assign(lattice.nz, 1);
    if (has_own_heights()) return;
    std::vector<std::uint32_t> chosen(grid_.nz, kNobody);
    const auto off = [&](std::uint32_t k) {
        return off_centre(lattice.z[k], grid_.origin.z, grid_.pitch.z, heights_[k]);
    };
    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        std::uint32_t& best = chosen[heights_[k]];
        if (best != kNobody && off(best) <= off(k)) {
            lit_heights_[k] = 0;
            continue;
        }
        if (best != kNobody) lit_heights_[best] = 0;
        best = k;
    }
}

/// Of the columns of one panel in one column of voxels, the nearest to its middle. Where a column is one sample, it is
/// the voxel that counts.
void SliceMap::choose_columns(const Lattice& lattice, const DisplayDescription& display) {
    const std::vector<std::uint8_t> panels = panels_of_row(display, lattice.nx);
    const std::size_t words = row_words(lattice.nx);
    const std::size_t layer = std::size_t{grid_.nx} * grid_.ny;
    lit_.assign(words * lattice.ny, 0);

    const auto place_of = [&](std::uint32_t column) {
        return has_own_heights() ? height(column, 0) * layer + columns_[column] : columns_[column];
    };
    const auto off = [&](std::uint32_t column) {
        const std::uint32_t x = columns_[column] % grid_.nx;
        const std::uint32_t y = columns_[column] / grid_.nx;
        const double dx = off_centre(lattice.plan[column].x, grid_.origin.x, grid_.pitch.x, x);
        const double dy = off_centre(lattice.plan[column].y, grid_.origin.y, grid_.pitch.y, y);
        return glm::dvec2(dx * dx + dy * dy, has_own_heights()
                                                 ? off_centre(bases_[column] + lattice.z[0], grid_.origin.z,
                                                              grid_.pitch.z, height(column, 0))
                                                 : 0.0);
    };
    const auto nearer = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };

    // Free points and unrestful rotors may have far more voxels than samples: sorted, not looked up.
    struct Candidate {
        std::size_t place;
        std::uint32_t column;
        std::uint8_t panel;
    };
    std::vector<Candidate> candidates;
    candidates.reserve(columns_.size());
    for (std::uint32_t column = 0; column < columns_.size(); ++column) {
        candidates.push_back({place_of(column), column, panels[column % lattice.nx]});
    }
    std::ranges::sort(candidates, [](const Candidate& a, const Candidate& b) {
        if (a.place != b.place) return a.place < b.place;
        return a.panel != b.panel ? a.panel < b.panel : a.column < b.column;
    });
    for (std::size_t i = 0; i < candidates.size();) {
        std::uint32_t best = candidates[i].column;
        std::size_t j = i + 1;
        for (; j < candidates.size() && candidates[j].place == candidates[i].place &&
               candidates[j].panel == candidates[i].panel;
             ++j) {
            if (nearer(off(candidates[j].column), off(best))) best = candidates[j].column;
        }
        const std::uint32_t x = best % lattice.nx;
        lit_[best / lattice.nx * words + x / 64] |= std::uint64_t{1} << (x % 64);
        i = j;
    }
}

bool SliceMap::has_shape(ConstBitVolumeView volume, const Lattice& lattice) const {
    return volume.nx == lattice.nx && volume.ny == lattice.ny && volume.nz == lattice.nz &&
           volume.words.size() == volume_words(lattice.nx, lattice.ny, lattice.nz);
}

std::size_t SliceMap::voxel(std::uint32_t x, std::uint32_t y, std::uint32_t k) const {
    if (identical_) return x + grid_.nx * (y + std::size_t{grid_.ny} * k);
    const std::size_t column = std::size_t{y} * display_lattice_.view().nx + x;
    return columns_[column] + std::size_t{grid_.nx} * grid_.ny * height(column, k);
}

bool SliceMap::is_lit(std::uint32_t x, std::uint32_t y, std::uint32_t k) const {
    if (identical_) return true;
    return lit_heights_[k] != 0 && is_lit_column(x, y);
}

bool SliceMap::is_lit_column(std::uint32_t x, std::uint32_t y) const {
    const std::size_t words = row_words(display_lattice_.view().nx);
    return (lit_[y * words + x / 64] >> (x % 64) & 1u) != 0;
}

Status SliceMap::sample(ConstBitVolumeView volume, BitVolumeView samples) const {
    const Lattice lattice = display_lattice_.view();
    if (!has_shape(volume, grid_) || !has_shape(samples, lattice)) return Status::InvalidArgument;
    if (identical_) {
        std::ranges::copy(volume.words, samples.words.begin());
        return Status::Ok;
    }
    const std::size_t words = row_words(lattice.nx);
    const std::size_t row_bits = row_words(grid_.nx) * 64;
    // Where in a layer of the volume the bit of each column is.
    std::vector<std::uint32_t> bits(columns_.size());
    for (std::size_t column = 0; column < columns_.size(); ++column) {
        bits[column] = static_cast<std::uint32_t>(columns_[column] / grid_.nx * row_bits + columns_[column] % grid_.nx);
    }
    const std::size_t layer_words = row_words(grid_.nx) * grid_.ny;
    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            const auto out = samples.row(y, k);
            const std::size_t first = std::size_t{y} * lattice.nx;
            for (std::size_t w = 0; w < words; ++w) {
                const std::size_t begin = first + w * 64;
                const std::uint32_t count =
                    std::min<std::uint32_t>(64, lattice.nx - static_cast<std::uint32_t>(w) * 64);
                std::uint64_t word = 0;
                if (has_own_heights()) {
                    for (std::uint32_t i = 0; i < count; ++i) {
                        const auto layer = volume.words.subspan(height(begin + i, k) * layer_words, layer_words);
                        word |= (layer[bits[begin + i] / 64] >> (bits[begin + i] % 64) & 1u) << i;
                    }
                } else {
                    const std::uint64_t* const layer = volume.words.data() + heights_[k] * layer_words;
                    const std::uint32_t* const bit = bits.data() + begin;
                    for (std::uint32_t i = 0; i < count; ++i) {
                        word |= (layer[bit[i] / 64] >> (bit[i] % 64) & 1u) << i;
                    }
                }
                out[w] = word;
            }
        }
    }
    return Status::Ok;
}

Status SliceMap::thin(BitVolumeView samples) const {
    const Lattice lattice = display_lattice_.view();
    if (!has_shape(samples, lattice)) return Status::InvalidArgument;
    if (identical_) return Status::Ok;
    const std::size_t layer_words = lit_.size();
    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        const auto layer = samples.words.subspan(k * layer_words, layer_words);
        const std::uint64_t keep = lit_heights_[k] != 0 ? ~std::uint64_t{0} : 0;
        for (std::size_t i = 0; i < layer_words; ++i) layer[i] &= lit_[i] & keep;
    }
    return Status::Ok;
}

/// Whether the middle of a column of voxels is within the cylinder.
bool SliceMap::is_reachable(std::uint32_t x, std::uint32_t y) const {
    if (radius_mm_ == 0.0) return true;
    const glm::dvec2 middle(grid_.origin.x + (x + 0.5) * grid_.pitch.x, grid_.origin.y + (y + 0.5) * grid_.pitch.y);
    return glm::length(middle) <= radius_mm_;
}

SliceCoverage SliceMap::coverage(LightMode mode) const {
    SliceCoverage result;
    result.voxels = grid_.sample_count();
    if (identical_) {
        result.reachable = result.covered = result.visits = result.voxels;
        result.least_visits = result.most_visits = 1;
        return result;
    }
    for (std::uint32_t y = 0; y < grid_.ny; ++y) {
        for (std::uint32_t x = 0; x < grid_.nx; ++x) result.reachable += is_reachable(x, y) ? grid_.nz : 0;
    }
    const Lattice lattice = display_lattice_.view();
    const bool uniform = mode == LightMode::Uniform;
    const std::size_t layer = std::size_t{grid_.nx} * grid_.ny;
    // What is visited: voxels, or, where all columns have the same heights, columns of voxels; a mention a visit.
    std::vector<std::size_t> visited;
    std::size_t column = 0;
    for (std::uint32_t y = 0; y < lattice.ny; ++y) {
        for (std::uint32_t x = 0; x < lattice.nx; ++x, ++column) {
            if (uniform && !is_lit_column(x, y)) continue;
            const std::uint32_t place = columns_[column];
            if (!is_reachable(place % grid_.nx, place / grid_.nx)) continue;
            visited.push_back(place + (has_own_heights() ? layer * height(column, 0) : 0));
        }
    }
    std::ranges::sort(visited);
    // How many heights are visited so often.
    std::map<std::uint32_t, std::size_t> heights_by_visits{{1, 1}};
    if (!has_own_heights()) {
        std::vector<std::uint32_t> of_height(grid_.nz);
        for (std::uint32_t k = 0; k < lattice.nz; ++k) of_height[heights_[k]] += uniform ? lit_heights_[k] : 1u;
        heights_by_visits.clear();
        for (const std::uint32_t visits : of_height) {
            if (visits > 0) ++heights_by_visits[visits];
        }
    }
    result.least_visits = kNobody;
    for (std::size_t i = 0; i < visited.size();) {
        std::size_t j = i;
        while (j < visited.size() && visited[j] == visited[i]) ++j;
        for (const auto& [of_height, heights] : heights_by_visits) {
            const std::uint32_t visits = static_cast<std::uint32_t>(j - i) * of_height;
            result.covered += heights;
            result.visits += std::uint64_t{visits} * heights;
            result.least_visits = std::min(result.least_visits, visits);
            result.most_visits = std::max(result.most_visits, visits);
        }
        i = j;
    }
    if (result.covered == 0) result.least_visits = 0;
    return result;
}

}  // namespace xorvox::host
