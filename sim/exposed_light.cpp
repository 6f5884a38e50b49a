// What an exposure saw, as flashes.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim/exposure.h"
#include "sim/seats.h"

namespace xorvox::sim {
namespace {

/// The light of a row of LEDs in one slice of the display's way, and where in it that was on average.
struct Stretch {
    double weight = 0.0;
    double moment = 0.0;
    std::uint32_t slice = 0;  ///< That the device meant.
};

class Flashes {
public:
    explicit Flashes(const Exposure& exposure)
        : exposure_(exposure), display_(exposure.display()), steps_(display_.slices) {
        if (display_.kind == DisplayKind::RotatingPanel && display_.sweep_deg < 270.0) steps_ *= 2;
        field_.pixels = PixelLight(display_);
    }

    LightField make() {
        std::size_t flashes = 0;
        for_each_row([&](std::uint32_t, std::uint32_t) {
            flashes += light_.size() - static_cast<std::size_t>(std::ranges::count(light_, glm::vec3(0.0f)));
        });
        field_.flashes.reserve(flashes);
        field_.measured.reserve(flashes);
        for_each_row([&](std::uint32_t panel, std::uint32_t row) { push(panel, row); });
        return std::move(field_);
    }

private:
    /// Gathers the light of each row of LEDs along the whole way, and calls visit(panel, row).
    template <class Visit>
    void for_each_row(const Visit& visit) {
        for (std::uint32_t panel = 0; panel < display_.panel_count; ++panel) {
            for (std::uint32_t row = 0; row < display_.panels[panel].rows; ++row) {
                stretches_.assign(steps_, {});
                light_.assign(std::size_t{steps_} * display_.panels[panel].columns, glm::vec3(0.0f));
                for (std::uint32_t slice = 0; slice < display_.slices; ++slice) {
                    exposure_.for_each_place(slice, panel, row, [&](const ExposedRow& lit) { add(lit); });
                }
                visit(panel, row);
            }
        }
    }

    void add(const ExposedRow& lit) {
        const double whole = std::floor(lit.at);
        const auto step = static_cast<std::size_t>(whole - std::floor(whole / steps_) * steps_);
        glm::vec3* const light = light_.data() + step * lit.light.size();
        double all = 0.0;
        for (std::size_t i = 0; i < lit.light.size(); ++i) {
            light[i] += lit.light[i];
            all += double{lit.light[i].x} + double{lit.light[i].y} + double{lit.light[i].z};
        }
        Stretch& stretch = stretches_[step];
        if (stretch.weight == 0.0) stretch.slice = lit.slice;
        stretch.weight += all;
        // Where the way begins anew, places count from the stretch that they are summed in.
        stretch.moment += all * (lit.at - whole + static_cast<double>(step));
    }

    void push(std::uint32_t panel, std::uint32_t row) {
        const std::size_t columns = display_.panels[panel].columns;
        for (std::size_t step = 0; step < steps_; ++step) {
            const Stretch& stretch = stretches_[step];
            if (stretch.weight == 0.0) continue;
            const Seats seats(exposure_.built(), panel, stretch.moment / stretch.weight, exposure_.faults());
            for (std::uint32_t column = 0; column < columns; ++column) {
                const glm::vec3& light = light_[step * columns + column];
                if (light == glm::vec3(0.0f)) continue;
                field_.flashes.push_back({seats.place_mm(row, column), 0, stretch.slice});
                field_.measured.push_back(light);
            }
        }
    }

    const Exposure& exposure_;
    const DisplayDescription& display_;
    std::uint32_t steps_;  ///< Slices of the way after which it begins anew.
    std::vector<Stretch> stretches_;
    std::vector<glm::vec3> light_;  ///< Of each stretch, by column.
    LightField field_;
};

}  // namespace

LightField Exposure::light() const {
    return Flashes(*this).make();
}

}  // namespace xorvox::sim
