#include "driver/host/light_gain.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "driver/display/lattice.h"
#include "driver/display/trigonometry.h"
#include "driver/host/calibration.h"

namespace xorvox::host {
namespace {

/// Of the pixels of a slice.
std::size_t slice_pixels(const DisplayDescription& display) {
    return frame_pixels(display) / display.slices;
}

/// An LED's place on its panel as it is mounted: along the panel from the foot of the axis, away from the axis along
/// the panel's normal, and up.
struct Mounted {
    double along;
    double out;
    double z;
};

/// A rotating panel's face.
struct Face {
    double half_width_mm;
    double half_height_mm;
    glm::dvec2 tilt;  ///< Its cosine and sine.

    explicit Face(const Panel& panel)
        : half_width_mm(0.5 * upright_columns(panel) * upright_column_pitch_mm(panel)),
          half_height_mm(0.5 * upright_rows(panel) * upright_row_pitch_mm(panel)),
          tilt(display::direction(panel.tilt_deg / 360.0)) {}
};

Mounted mounted(const Panel& panel, const Face& face, std::uint32_t column, std::uint32_t row) {
    const UprightPixel pixel = upright_pixel(panel, column, row);
    const double a = (pixel.column + 0.5) * upright_column_pitch_mm(panel) - face.half_width_mm;
    const double b = (pixel.row + 0.5) * upright_row_pitch_mm(panel) - face.half_height_mm;
    const double skew = column % 2 == 1 ? panel.skew_mm : 0.0;
    return {panel.shift_mm + a, panel.offset_mm + skew + b * face.tilt.y, panel.lift_mm + b * face.tilt.x};
}

/// Volume that an LED stands for, but for a factor that is the same everywhere: a strip `pitch` wide at `along`,
/// turning.
double swept_space(double along, double pitch) {
    const double half = 0.5 * pitch;
    // A strip over the foot of the axis sweeps on both sides of it.
    return std::abs(along) >= half ? std::abs(along) * pitch : along * along + half * half;
}

/// Halves of panels that pass the circle through `led` in a turn, itself included.
int passes(const DisplayDescription& display, std::span<const Face> faces, std::uint32_t own, const Mounted& led) {
    constexpr double kSlack = 1e-9;
    const auto reaches = [&](std::uint32_t p, double along) {
        return std::abs(along - display.panels[p].shift_mm) <= faces[p].half_width_mm + kSlack;
    };
    int count = 1 + (led.along != 0.0 && reaches(own, -led.along) ? 1 : 0);
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const double b = (led.z - panel.lift_mm) / faces[p].tilt.x;
        if (p == own || std::abs(b) > faces[p].half_height_mm + kSlack) continue;
        const double out = panel.offset_mm + 0.5 * panel.skew_mm + b * faces[p].tilt.y;
        const double square = led.along * led.along + led.out * led.out - out * out;
        if (square < 0.0) continue;
        const double along = std::sqrt(square);
        count += (reaches(p, along) ? 1 : 0) + (reaches(p, -along) ? 1 : 0);
    }
    return count;
}

/// Divides by the largest.
std::vector<float> largest_is_1(const std::vector<double>& spaces) {
    const double most = *std::ranges::max_element(spaces);
    std::vector<float> gains;
    gains.reserve(spaces.size());
    for (const double space : spaces) gains.push_back(static_cast<float>(space / most));
    return gains;
}

/// The space of each plane: what lies between the middles to its neighbours.
std::vector<double> plane_spaces(std::span<const double> heights) {
    std::vector<double> spaces;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const double below = i > 0 ? heights[i] - heights[i - 1] : heights[1] - heights[0];
        const double above = i + 1 < heights.size() ? heights[i + 1] - heights[i] : below;
        spaces.push_back(0.5 * (below + above));
    }
    return spaces;
}

}  // namespace

std::vector<float> even_slice_gains(const DisplayDescription& display) {
    std::vector<double> spaces(display.slices, 1.0);
    if (display.kind == DisplayKind::StackedPlanes && display.plane_heights_mm.size() > 1) {
        spaces = plane_spaces(display.plane_heights_mm);
    }
    if (display.kind == DisplayKind::SweptPlane) {
        for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
            const double slices = display.slices;
            spaces[slice] =
                swept_height_mm(display.motion, (slice + 1) / slices) - swept_height_mm(display.motion, slice / slices);
        }
    }
    return largest_is_1(spaces);
}

std::vector<float> even_pixel_gains(const DisplayDescription& display) {
    if (display.kind != DisplayKind::RotatingPanel) return {};
    std::vector<Face> faces;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) faces.emplace_back(display.panels[p]);
    std::vector<double> spaces;
    spaces.reserve(slice_pixels(display));
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const double pitches = faces[p].tilt.x * upright_row_pitch_mm(panel);
        for (std::uint32_t row = 0; row < panel.rows; ++row) {
            for (std::uint32_t column = 0; column < panel.columns; ++column) {
                const Mounted led = mounted(panel, faces[p], column, row);
                spaces.push_back(swept_space(led.along, upright_column_pitch_mm(panel)) * pitches /
                                 passes(display, faces, p, led));
            }
        }
    }
    return largest_is_1(spaces);
}

SampleGains::SampleGains(const DisplayDescription& display, const LightSettings& settings) {
    if (settings.mode == LightMode::Even) {
        slices_ = even_slice_gains(display);
        const std::vector<float> pixels = even_pixel_gains(display);
        if (!pixels.empty()) {
            tables_.emplace_back();
            tables_.front().reserve(pixels.size());
            for (const float gain : pixels) tables_.front().emplace_back(gain);
        }
    }
    if (settings.calibration == nullptr) return;
    const std::size_t pixels = slice_pixels(display);
    if (display.kind == DisplayKind::StackedPlanes && tables_.size() <= 1) tables_.resize(display.slices);
    if (tables_.empty()) tables_.emplace_back();
    for (const Calibration::Led& led : settings.calibration->leds()) {
        auto& table = tables_[display.kind == DisplayKind::StackedPlanes ? led.unit : 0];
        if (table.empty()) table.assign(pixels, glm::vec3(1.0f));
        table[led.pixel] *= led.gain;
    }
}

}  // namespace xorvox::host
