#include "sim/uniformity.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "driver/display/lattice.h"
#include "sim/pixel_light.h"
#include "sim/pixel_rows.h"
#include "sim/seats.h"

namespace xorvox::sim {
namespace {

/// The part of the volume that cells with enough samples must hold. Two cells a side are alike on a rotor, so that
/// three that tell less are better.
double volume_to_tell(std::uint32_t cells_a_side) {
    return cells_a_side > 3 ? 0.9 : 0.5;
}

/// By code, or of rgb888 by level, 256 for each channel.
std::vector<float> luminance_table(const DisplayDescription& display) {
    const PixelLight pixels(display);
    const glm::vec3 weights(0.2126f, 0.7152f, 0.0722f);  // IEC 61966-2-1.
    const bool by_level = display.format == PixelFormat::Rgb888;
    std::vector<float> table(by_level ? 3 * 256 : std::size_t{1} << bits_per_pixel(display.format));
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        const std::uint32_t code = by_level ? (i % 256) << (8 * (i / 256)) : i;
        table[i] = glm::dot(weights, pixels.of(code));
    }
    return table;
}

/// The space of each pixel of a slice, but for the thickness of the slice.
std::vector<double> pixel_volumes(const DisplayDescription& display, const SampleVolumes& volumes) {
    std::vector<double> all;
    std::size_t first = 0;  // Of the panel, in the lattice's x.
    const bool upright = display.kind == DisplayKind::RotatingPanel && is_upright(display);
    const Faults none;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const Seats seats(display, p, std::uint32_t{0}, none);
        for (std::uint32_t row = 0; row < panel.rows; ++row) {
            for (std::uint32_t column = 0; column < panel.columns; ++column) {
                const std::size_t x = upright ? first + upright_pixel(panel, column, row).column : all.size();
                all.push_back(volumes.at_x(x) / passes_at(display, seats.place_mm(row, column)));
            }
        }
        first += upright_columns(panel);
    }
    return all;
}

/// Whether rows and columns go along different axes of the box, so that the cells of all rows of a slice are alike, but
/// for one step.
bool rows_are_alike(const DisplayDescription& display, const Panel& panel) {
    switch (display.kind) {
        case DisplayKind::StackedPlanes:
        case DisplayKind::SweptPlane: return true;
        case DisplayKind::RotatingPanel:
            return panel.tilt_deg == 0.0 && (panel.skew_mm == 0.0 || panel.turned % 2 == 0);
        case DisplayKind::Helix:
        case DisplayKind::FreePoints: break;
    }
    return false;
}

}  // namespace

double Uniformity::ratio() const {
    if (most == least) return 1.0;
    return least > 0.0 ? most / least : std::numeric_limits<double>::infinity();
}

UniformityMeter::UniformityMeter(const DisplayDescription& display)
    : display_(display), luminance_(luminance_table(display)) {
    const DisplayExtent box = extent(display);
    lower_mm_ = box.lower;
    size_mm_ = box.upper - box.lower;
    const SampleVolumes volumes = sample_volumes(display);
    volume_ = pixel_volumes(display, volumes);
    thickness_ = volumes.by_k;
    for (std::uint32_t side = kMostCellsASide; side > 0; --side) {
        divide(side);
        if (side == 1 || can_tell()) break;
    }
}

void UniformityMeter::divide(std::uint32_t cells_a_side) {
    cells_a_side_ = cells_a_side;
    cells_.assign(std::size_t{cells_a_side} * cells_a_side * cells_a_side, {});
    std::size_t pixel = 0;
    for_each_row_of_cells([&](std::uint32_t slice, std::uint32_t panel, std::uint32_t row, const std::uint32_t* cells) {
        if (panel == 0 && row == 0) pixel = 0;
        const double thickness = thickness_[thickness_.size() == 1 ? 0 : slice];
        for (std::uint32_t column = 0; column < display_.panels[panel].columns; ++column) {
            Cell& cell = cells_[cells[column]];
            ++cell.samples;
            cell.volume += volume_[pixel++] * thickness;
        }
    });
}

bool UniformityMeter::can_tell() const {
    double all = 0.0;
    double told = 0.0;
    for (const Cell& cell : cells_) {
        all += cell.volume;
        if (cell.samples >= kLeastCellSamples) told += cell.volume;
    }
    return told >= volume_to_tell(cells_a_side_) * all;
}

std::uint32_t UniformityMeter::cell_at(const glm::dvec3& place_mm) const {
    const double side = cells_a_side_;
    const glm::dvec3 steps = glm::clamp(glm::floor((place_mm - lower_mm_) / size_mm_ * side), 0.0, side - 1.0);
    return static_cast<std::uint32_t>((steps.z * side + steps.y) * side + steps.x);
}

glm::dvec3 UniformityMeter::middle_mm(std::size_t cell) const {
    const std::size_t side = cells_a_side_;
    const glm::dvec3 steps(cell % side, cell / side % side, cell / side / side);
    return lower_mm_ + size_mm_ * (steps + 0.5) / static_cast<double>(side);
}

template <class Visit>
void UniformityMeter::for_each_row_of_cells(const Visit& visit) const {
    const Faults none;
    std::vector<std::uint32_t> first_row;
    std::vector<std::uint32_t> cells;
    for (std::uint32_t slice = 0; slice < display_.slices; ++slice) {
        for (std::uint32_t p = 0; p < display_.panel_count; ++p) {
            const Panel& panel = display_.panels[p];
            const Seats seats(display_, p, slice, none);
            const bool alike = rows_are_alike(display_, panel);
            first_row.resize(panel.columns);
            cells.resize(panel.columns);
            for (std::uint32_t row = 0; row < panel.rows; ++row) {
                if (row == 0 || !alike) {
                    for (std::uint32_t column = 0; column < panel.columns; ++column) {
                        first_row[column] = cell_at(seats.place_mm(row, column));
                    }
                    cells = first_row;
                } else {
                    const std::uint32_t step = cell_at(seats.place_mm(row, 0)) - first_row[0];  // Modulo 2³².
                    for (std::uint32_t column = 0; column < panel.columns; ++column) {
                        cells[column] = first_row[column] + step;
                    }
                }
                visit(slice, p, row, cells.data());
            }
        }
    }
}

void UniformityMeter::add(std::span<const std::byte> page) {
    assert(page.size() == frame_bytes(display_));
    const std::uint32_t bits = bits_per_pixel(display_.format);
    const std::uint32_t shown = PixelLight(display_).shown_bits();
    const bool by_level = display_.format == PixelFormat::Rgb888;
    for_each_row_of_cells([&](std::uint32_t, std::uint32_t panel, std::uint32_t, const std::uint32_t* cells) {
        const std::size_t length = row_bytes(display_.panels[panel], display_.format);
        for_each_lit(page.first(length), display_.panels[panel].columns, bits, shown,
                     [&](std::uint32_t column, std::uint32_t code) {
                         const float luminance = by_level
                                                     ? luminance_[code & 0xff] + luminance_[256 + (code >> 8 & 0xff)] +
                                                           luminance_[512 + (code >> 16)]
                                                     : luminance_[code];
                         cells_[cells[column]].light += static_cast<double>(luminance);
                     });
        page = page.subspan(length);
    });
    ++frames_;
}

Uniformity UniformityMeter::result() const {
    Uniformity found;
    found.cells_a_side = cells_a_side_;
    double light = 0.0;
    double volume = 0.0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const Cell& cell = cells_[i];
        if (cell.samples < kLeastCellSamples) continue;
        const double density = frames_ == 0 ? 0.0 : cell.light / cell.volume / frames_;
        light += cell.light;
        volume += cell.volume;
        if (found.cells == 0 || density > found.most) {
            found.most = density;
            found.most_mm = middle_mm(i);
        }
        if (found.cells == 0 || density < found.least) {
            found.least = density;
            found.least_mm = middle_mm(i);
        }
        ++found.cells;
    }
    if (frames_ > 0 && volume > 0.0) found.mean = light / volume / frames_;
    return found;
}

}  // namespace xorvox::sim
