// What an exposure saw, as flashes.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "sim/exposure.h"
#include "sim/seats.h"

namespace xorvox::sim {
namespace {

/// A row of LEDs in one slice of the display's way.
using Stretch = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;

/// The light of a row in one stretch, and where in it that was on average.
struct Sum {
    std::vector<glm::vec3> light;
    double weight = 0.0;
    double moment = 0.0;
    std::uint32_t slice = 0;

    void add(const ExposedRow& row, double at) {
        light.resize(row.light.size(), glm::vec3(0.0f));
        double all = 0.0;
        for (std::size_t i = 0; i < light.size(); ++i) {
            light[i] += row.light[i];
            all += double{row.light[i].x} + double{row.light[i].y} + double{row.light[i].z};
        }
        weight += all;
        moment += all * at;
    }
};

class Flashes {
public:
    explicit Flashes(const Exposure& exposure) : exposure_(exposure), steps_(exposure.display().slices) {
        const DisplayDescription& display = exposure.display();
        if (display.kind == DisplayKind::RotatingPanel && display.sweep_deg < 270.0) steps_ *= 2;
        field_.pixels = PixelLight(display);
    }

    LightField make() {
        std::map<Stretch, std::uint32_t> visits;
        exposure_.for_each_row([&](const ExposedRow& row) { ++visits[stretch_of(row)]; });
        std::map<Stretch, Sum> sums;
        exposure_.for_each_row([&](const ExposedRow& row) {
            const Stretch stretch = stretch_of(row);
            if (visits[stretch] == 1) return push(row.panel, row.row, row.at, row.slice, row.light);
            Sum& sum = sums[stretch];
            if (sum.light.empty()) sum.slice = row.slice;
            // Where the way begins anew, places count from the stretch that they are summed in.
            sum.add(row, row.at - std::floor(row.at) + std::get<0>(stretch));
        });
        for (const auto& [stretch, sum] : sums) {
            push(std::get<1>(stretch), std::get<2>(stretch), sum.moment / sum.weight, sum.slice, sum.light);
        }
        return std::move(field_);
    }

private:
    Stretch stretch_of(const ExposedRow& row) const {
        const double turns = std::floor(std::floor(row.at) / steps_);
        return {static_cast<std::uint32_t>(std::floor(row.at) - turns * steps_), row.panel, row.row};
    }

    void push(std::uint32_t panel, std::uint32_t row, double at, std::uint32_t slice,
              std::span<const glm::vec3> light) {
        const Seats seats(exposure_.built(), panel, at, exposure_.faults());
        for (std::uint32_t column = 0; column < light.size(); ++column) {
            if (light[column] == glm::vec3(0.0f)) continue;
            field_.flashes.push_back({seats.place_mm(row, column), 0, slice});
            field_.measured.push_back(light[column]);
        }
    }

    const Exposure& exposure_;
    std::uint32_t steps_;  ///< Slices of the way after which it begins anew.
    LightField field_;
};

}  // namespace

LightField Exposure::light() const {
    return Flashes(*this).make();
}

}  // namespace xorvox::sim
