#include "sim/exposed_voxels.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "sim/optics.h"
#include "sim/pixel_light.h"
#include "sim/pixel_rows.h"
#include "sim/rebuild.h"
#include "sim/seats.h"

namespace xorvox::sim {
namespace {

/// From a place to where light is that should be there. A helix comes by again a stroke further.
double distance_mm(const DisplayDescription& display, const glm::dvec3& declared, const glm::dvec3& found) {
    glm::dvec3 away = found - declared;
    if (display.kind == DisplayKind::Helix) away.z = std::remainder(away.z, display.motion.stroke_mm);
    return glm::length(away);
}

/// The voxels of one row, which may be lit at several places.
class VoxelRow {
public:
    VoxelRow(const Exposure& exposure, std::uint32_t slice, std::uint32_t panel, double reach_mm)
        : exposure_(exposure),
          display_(exposure.display()),
          slice_(slice),
          panel_(panel),
          reach_mm_(reach_mm),
          declared_(display_, panel, slice + 0.5, none_),
          begin_(display_, panel, static_cast<double>(slice), none_),
          end_(display_, panel, slice + 1.0, none_),
          due_(exposure.due(slice)),
          voxels_(display_.panels[panel].columns) {}

    void start(std::uint32_t row) {
        row_ = row;
        for (std::uint32_t column = 0; column < voxels_.size(); ++column) {
            voxels_[column] = {.slice = slice_, .panel = panel_, .row = row, .column = column, .due = due_};
        }
    }

    ExposedVoxel& operator[](std::size_t column) { return voxels_[column]; }

    void finish(const std::function<void(const ExposedVoxel&)>& visit) {
        for (ExposedVoxel& voxel : voxels_) {
            if (voxel.code == 0 && voxel.light == glm::vec3(0.0f)) continue;
            voxel.place_mm = declared_.place_mm(row_, voxel.column);
            visit(voxel);
        }
    }

    void add(const ExposedRow& lit) {
        const double late = stray_slices(lit);
        const Seats found(exposure_.built(), panel_, lit.at, exposure_.faults());
        for (std::uint32_t mounted = 0; mounted < lit.light.size(); ++mounted) {
            const glm::vec3& light = lit.light[mounted];
            if (light == glm::vec3(0.0f)) continue;
            const auto wired = static_cast<std::uint32_t>(lit.mirrored ? lit.light.size() - 1 - mounted : mounted);
            ExposedVoxel& voxel = voxels_[wired];
            voxel.tolerance_mm = tolerance_mm(wired);
            const glm::dvec3 seen_mm = found.place_mm(row_, mounted);
            const double stray = distance_mm(display_, declared_.place_mm(row_, wired), seen_mm);
            if (voxel.light == glm::vec3(0.0f) || stray > voxel.stray_mm) voxel.seen_mm = seen_mm;
            voxel.light += light;
            if (stray > voxel.tolerance_mm) voxel.outside += light;
            voxel.stray_mm = std::max(voxel.stray_mm, stray);
            voxel.stray_slices = std::max(voxel.stray_slices, late);
        }
    }

private:
    /// From the slice that was meant to where light is, faults counted: what turns and what is counted comes by again.
    double stray_slices(const ExposedRow& lit) const {
        const double phase = exposure_.faults().late_slices();
        if (display_.kind == DisplayKind::FreePoints) return std::abs(phase);
        const double slices = display_.slices;
        const double away = lit.at - (slice_ + 0.5) + phase;
        if (display_.kind == DisplayKind::StackedPlanes) {
            const double plane = std::floor(slice_ + 0.5 + away);
            return std::abs(plane - std::floor(plane / slices) * slices - slice_);
        }
        if (display_.kind == DisplayKind::SweptPlane) return std::abs(away);
        // Of half turns the second one is as good as the first.
        return std::abs(std::remainder(away, slices));
    }

    double tolerance_mm(std::uint32_t column) const {
        double way_mm = 0.0;
        switch (display_.kind) {
            case DisplayKind::StackedPlanes:
            case DisplayKind::FreePoints: break;
            case DisplayKind::Helix: way_mm = display_.motion.stroke_mm / display_.slices / 2.0; break;
            case DisplayKind::SweptPlane:
            case DisplayKind::RotatingPanel: {
                const glm::dvec3 middle_mm = declared_.place_mm(row_, column);
                way_mm = std::max(glm::distance(middle_mm, begin_.place_mm(row_, column)),
                                  glm::distance(middle_mm, end_.place_mm(row_, column)));
            }
        }
        return way_mm + reach_mm_;
    }

    const Exposure& exposure_;
    const DisplayDescription& display_;
    std::uint32_t slice_;
    std::uint32_t panel_;
    std::uint32_t row_ = 0;
    double reach_mm_;
    Faults none_;
    Seats declared_;
    Seats begin_;
    Seats end_;
    double due_;
    std::vector<ExposedVoxel> voxels_;
};

}  // namespace

void for_each_voxel(const Exposure& exposure, std::span<const std::byte> page, std::uint8_t brightness,
                    const std::function<void(const ExposedVoxel&)>& visit) {
    const DisplayDescription& display = exposure.display();
    assert(page.empty() || page.size() == frame_bytes(display));
    const PixelLight pixels(display);
    const double reach_mm = DisplaySamples(display).reach_mm();
    const std::uint32_t bits = bits_per_pixel(display.format);
    const float full = static_cast<float>(brightness) / 255.0f;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            VoxelRow voxels(exposure, slice, p, reach_mm);
            for (std::uint32_t row = 0; row < panel.rows; ++row) {
                voxels.start(row);
                if (!page.empty()) {
                    const std::size_t length = row_bytes(panel, display.format);
                    for_each_lit(page.first(length), panel.columns, bits, pixels.shown_bits(),
                                 [&](std::uint32_t column, std::uint32_t code) {
                                     voxels[column].code = code;
                                     voxels[column].sent = full * pixels.of(code);
                                 });
                    page = page.subspan(length);
                }
                exposure.for_each_place(slice, p, row, [&](const ExposedRow& lit) { voxels.add(lit); });
                voxels.finish(visit);
            }
        }
    }
}

}  // namespace xorvox::sim
