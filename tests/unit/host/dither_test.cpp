#include "driver/host/dither.h"

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "driver/host/slices.h"
#include "tests/catch.h"
#include "tests/displays.h"
#include "tests/unit/host/light_reference.h"

using namespace xorvox;
using namespace xorvox::host;

namespace {

class Flat final : public ColorField {
public:
    explicit Flat(glm::vec3 color) : color_(color) {}
    void evaluate(std::span<const glm::vec3>, std::span<glm::vec3> colors) const override {
        for (glm::vec3& color : colors) color = color_;
    }

private:
    glm::vec3 color_;
};

/// Colours that rise from black to white along all axes.
class Rising final : public ColorField {
public:
    static glm::vec3 color(const glm::vec3& p) { return {p.x, p.y * p.y, 0.5f * (p.x + p.z)}; }
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override {
        for (std::size_t i = 0; i < points.size(); ++i) colors[i] = color(points[i]);
    }
};

BitVolume all_set(const Lattice& lattice) {
    BitVolume volume(lattice);
    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < lattice.nx; ++x) volume.view().flip(x, y, k);
        }
    }
    return volume;
}

/// The distance in light between the two levels next to `light`.
double step_at(const DisplayDescription& display, double light, int channel) {
    const test::Level at = test::level_of(display, ~0u, channel);
    for (std::uint32_t level = 0; level < at.most; ++level) {
        const double low = test::response(display.light, static_cast<double>(level) / at.most);
        const double high = test::response(display.light, (level + 1.0) / at.most);
        if (light <= high) return high - low;
    }
    return 0.0;
}

constexpr double kSlack = 1e-5;

}  // namespace

TEST_CASE("64 samples in a line, and one sample in 64 frames, meet every threshold once") {
    const auto thresholds_along = [](const auto& at) {
        std::set<float> met;
        for (std::uint32_t i = 0; i < kDitherPeriod; ++i) met.insert(dither_threshold(at(i)));
        REQUIRE(*met.begin() > 0.0f);
        REQUIRE(*met.rbegin() < 1.0f);
        return met.size();
    };
    CHECK(thresholds_along([](std::uint32_t i) { return dither_index(5, 1, 2, i, 7); }) == kDitherPeriod);
    CHECK(thresholds_along([](std::uint32_t i) { return dither_index(5, 1, i, 3, 7); }) == kDitherPeriod);
    CHECK(thresholds_along([](std::uint32_t i) { return dither_index(i, 1, 2, 3, 7); }) == kDitherPeriod);
    CHECK(thresholds_along([](std::uint32_t i) { return dither_index(5, 1, 2, 3, 1000 + i); }) == kDitherPeriod);
    CHECK(dither_index(5, 1, 2, 9, 7) == (dither_index(5, 1, 2, 0, 7) + 9 * kDitherColumnStep) % kDitherPeriod);
    CHECK(dither_index(0, 0, 0, 0, 0xffff'ffff) == (dither_index(0, 0, 0, 0, 0) + 64 - 39) % kDitherPeriod);
}

TEST_CASE("ordered dithering: the mean over neighbours is the light wanted, in every format and response") {
    DisplayDescription display;
    display.cycles_per_second = 60.0;
    display.slices = 4;
    display.panels[0] = {.columns = 64, .rows = 4};
    const glm::vec3 color(0.31f, 0.62f, 0.043f);
    for (const Light& light : test::kResponses) {
        display.light = light;
        for (const PixelFormat format : kPixelFormats) {
            display.format = format;
            CAPTURE(std::string(to_string(format)), static_cast<int>(light.response), light.gamma);
            const FramePainter painter(display, {.dither = Dither::Ordered});
            std::vector<std::byte> frame(frame_bytes(display));
            const BitVolume volume = all_set(painter.lattice().view());
            REQUIRE(painter.paint(volume.view(), Flat(color), frame) == Status::Ok);
            for (int c = 0; c < static_cast<int>(channel_count(format)); ++c) {
                std::array<double, 16> sums{};  // of each row
                test::for_each_pixel(display, frame, [&](auto slice, auto, auto row, auto, std::uint32_t code) {
                    sums[slice * 4 + row] += test::light_of(display, code, c);
                });
                const double wanted = test::wanted(display, color, c);
                for (const double sum : sums) {
                    CHECK(std::abs(sum / 64.0 - wanted) <= step_at(display, wanted, c) / 128.0 + kSlack);
                }
            }
            // The frame's number does not matter.
            std::vector<std::byte> later(frame.size());
            REQUIRE(painter.paint(volume.view(), Flat(color), later, 17) == Status::Ok);
            CHECK((later == frame));
        }
    }
}

TEST_CASE("temporal dithering: the mean over 64 frames is the light wanted, at every sample of every display") {
    for (DisplayDescription display : test::odd_displays()) {
        if (display.kind == DisplayKind::RotatingPanel && display.slices > 12) display.slices = 5;
        const std::size_t which = display.slices % kPixelFormats.size();
        display.format = kPixelFormats[which];
        display.light = test::kResponses[display.panels[0].columns % test::kResponses.size()];
        CAPTURE(std::string(display.name.view()), std::string(to_string(display.format)));
        const FramePainter painter(display, {.dither = Dither::Temporal, .brightness = 0.8f, .white = {1, 0.9f, 0.7f}});
        const Lattice lattice = painter.lattice().view();
        const BitVolume volume = all_set(lattice);
        const int channels = static_cast<int>(channel_count(display.format));
        std::vector<glm::dvec3> sums(frame_pixels(display), glm::dvec3(0.0));
        std::vector<int> lit(sums.size());
        std::vector<std::byte> frame(frame_bytes(display));
        for (std::uint32_t number = 100; number < 100 + kDitherPeriod; ++number) {
            REQUIRE(painter.paint(volume.view(), Rising(), frame, number) == Status::Ok);
            std::size_t pixel = 0;
            test::for_each_pixel(display, frame, [&](auto, auto, auto, auto, std::uint32_t code) {
                for (int c = 0; c < channels; ++c) sums[pixel][c] += test::light_of(display, code, c);
                lit[pixel++] += code != 0 ? 1 : 0;
            });
        }
        const DisplayExtent room = extent(display);
        std::size_t pixel = 0;
        test::for_each_pixel(display, frame, [&](auto slice, auto p, auto row, auto column, std::uint32_t) {
            const glm::dvec3 place = test::drawn(display, slice, p, row, column);
            const glm::vec3 point((place - room.lower) / (room.upper - room.lower));
            const glm::dvec3 light = glm::dvec3(Rising::color(point)) * 0.8 * glm::dvec3(1, 0.9, 0.7);
            bool is_seen = false;
            for (int c = 0; c < channels; ++c) {
                const double wanted = test::wanted(display, light, c);
                const double step = step_at(display, wanted, c);
                REQUIRE(std::abs(sums[pixel][c] / 64.0 - wanted) <= step / 128.0 + kSlack);
                is_seen =
                    is_seen || wanted > test::light_of(display, ~0u, c) * 1e-9 + step_at(display, 0.0, c) * 1.01 / 128;
            }
            if (is_seen) REQUIRE(lit[pixel] > 0);
            ++pixel;
        });
    }
}

TEST_CASE("temporal dithering spreads the frames in which a sample is lit") {
    DisplayDescription display;
    display.cycles_per_second = 60.0;
    display.slices = 1;
    display.panels[0] = {.columns = 1, .rows = 1};
    const FramePainter painter(display, {.dither = Dither::Temporal});
    const BitVolume volume = all_set(painter.lattice().view());
    std::vector<std::byte> frame(frame_bytes(display));
    // A quarter of the light: in any 8 frames 1 to 3 are lit.
    for (std::uint32_t first = 0; first < kDitherPeriod; ++first) {
        int lit = 0;
        for (std::uint32_t number = first; number < first + 8; ++number) {
            REQUIRE(painter.paint(volume.view(), Flat(glm::vec3(0.25f)), frame, number) == Status::Ok);
            lit += frame[0] != std::byte{0} ? 1 : 0;
        }
        CHECK(lit >= 1);
        CHECK(lit <= 3);
    }
}
