#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "driver/display/toml.h"
#include "driver/host/slice_map.h"
#include "driver/host/wire_order.h"
#include "tests/catch.h"
#include "tests/displays.h"

using namespace xorvox;
using namespace xorvox::host;

namespace {

BitVolume random_volume(const Lattice& lattice) {
    BitVolume volume(lattice);
    std::mt19937 random(11);
    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < lattice.nx; ++x) {
                if (random() % 2 == 0) volume.view().flip(x, y, k);
            }
        }
    }
    return volume;
}

/// The panel that lights sample x of a row.
std::uint32_t panel_of(const DisplayDescription& display, std::uint32_t x) {
    if (display.kind != DisplayKind::RotatingPanel) return 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const std::uint32_t own =
            is_upright(display) ? upright_columns(panel) : std::uint32_t{panel.columns} * panel.rows;
        if (x < own) return p;
        x -= own;
    }
    return kMaxPanels;
}

template <class Visit>
void for_each_sample(const Lattice& lattice, Visit visit) {
    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < lattice.nx; ++x) visit(x, y, k);
        }
    }
}

/// Of a great display some rows are as good as all.
DisplayDescription some_rows(DisplayDescription display) {
    if (frame_pixels(display) < 10'000'000) return display;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) display.panels[p].rows = 16;
    return display;
}

/// Of the samples of one panel in one voxel, uniform mode lights exactly one.
void check_uniform(const DisplayDescription& display) {
    const DisplayLattice lattice(display);
    const Lattice view = lattice.view();
    const SliceMap map(display, lattice);
    std::vector<std::uint8_t> seen(map.grid().sample_count() * display.panel_count);
    std::size_t lit_twice = 0;
    for_each_sample(view, [&](std::uint32_t x, std::uint32_t y, std::uint32_t k) {
        std::uint8_t& state = seen[map.voxel(x, y, k) * display.panel_count + panel_of(display, x)];
        state |= 1u;
        if (!map.is_lit(x, y, k)) return;
        if ((state & 2u) != 0) ++lit_twice;
        state |= 2u;
    });
    CHECK(lit_twice == 0);
    CHECK(std::ranges::none_of(seen, [](std::uint8_t state) { return state == 1; }));
}

}  // namespace

TEST_CASE("uniform mode lights each voxel that a panel passes exactly once, on every kind of display") {
    for (const DisplayDescription& display : test::odd_displays()) {
        INFO(std::string(display.name.view()));
        check_uniform(display);
    }
}

TEST_CASE("uniform mode lights each voxel that a panel passes exactly once, on every preset") {
    for (const Preset& preset : presets()) {
        INFO(preset.name);
        check_uniform(some_rows(load_display(std::string(preset.name)).value()));
    }
}

TEST_CASE("of the samples in a voxel, the one nearest to its centre in plan is lit") {
    const DisplayDescription display = test::upright_rotor(false, false, 0);
    const DisplayLattice lattice(display);
    const Lattice view = lattice.view();
    const SliceMap map(display, lattice);
    const auto off = [&](std::uint32_t x, std::uint32_t y) {
        const std::size_t voxel = map.voxel(x, y, 0);
        const glm::dvec3 centre = sample_position(map.grid(), static_cast<std::uint32_t>(voxel % map.grid().nx),
                                                  static_cast<std::uint32_t>(voxel / map.grid().nx % map.grid().ny), 0);
        const glm::dvec3 place = sample_position(view, x, y, 0);
        return std::hypot(place.x - centre.x, place.y - centre.y);
    };
    std::map<std::pair<std::size_t, std::uint32_t>, double> lit;
    const auto key = [&](std::uint32_t x, std::uint32_t y) {
        return std::pair(map.voxel(x, y, 0), panel_of(display, x));
    };
    for (std::uint32_t y = 0; y < view.ny; ++y) {
        for (std::uint32_t x = 0; x < view.nx; ++x) {
            if (map.is_lit(x, y, 0)) lit[key(x, y)] = off(x, y);
        }
    }
    std::size_t dark = 0;
    for (std::uint32_t y = 0; y < view.ny; ++y) {
        for (std::uint32_t x = 0; x < view.nx; ++x) {
            REQUIRE(lit.at(key(x, y)) <= off(x, y));
            if (!map.is_lit(x, y, 0)) ++dark;
        }
    }
    CHECK(dark > view.column_count() / 10);
}

TEST_CASE("a sample takes the bit of the voxel that it stands in") {
    for (const DisplayDescription& display : test::odd_displays()) {
        INFO(std::string(display.name.view()));
        const DisplayLattice lattice(display);
        const Lattice view = lattice.view();
        const SliceMap map(display, lattice);
        const Lattice& grid = map.grid();
        const BitVolume volume = random_volume(grid);
        BitVolume samples(view);
        REQUIRE(map.sample(volume.view(), samples.view()) == Status::Ok);
        for_each_sample(view, [&](std::uint32_t x, std::uint32_t y, std::uint32_t k) {
            const glm::dvec3 place = sample_position(view, x, y, k);
            const std::size_t voxel = map.voxel(x, y, k);
            const auto vx = static_cast<std::uint32_t>(voxel % grid.nx);
            const auto vy = static_cast<std::uint32_t>(voxel / grid.nx % grid.ny);
            const auto vz = static_cast<std::uint32_t>(voxel / grid.nx / grid.ny);
            const glm::dvec3 centre = sample_position(grid, vx, vy, vz);
            for (int axis = 0; axis < 3; ++axis) {
                REQUIRE(std::abs(place[axis] - centre[axis]) <= 0.5000001 * grid.pitch[axis]);
            }
            REQUIRE(samples.test(x, y, k) == volume.test(vx, vy, vz));
        });
    }
}

TEST_CASE("thinning clears what uniform mode does not light, and nothing else") {
    for (const DisplayDescription& display : test::odd_displays()) {
        INFO(std::string(display.name.view()));
        const DisplayLattice lattice(display);
        const SliceMap map(display, lattice);
        const BitVolume before = random_volume(lattice.view());
        BitVolume after = before;
        REQUIRE(map.thin(after.view()) == Status::Ok);
        for_each_sample(lattice.view(), [&](std::uint32_t x, std::uint32_t y, std::uint32_t k) {
            REQUIRE(after.test(x, y, k) == (before.test(x, y, k) && map.is_lit(x, y, k)));
        });
    }
}

TEST_CASE("every pixel of a frame is another sample, and every sample is a pixel") {
    const auto check = [](const DisplayDescription& display) {
        INFO(std::string(display.name.view()));
        const DisplayLattice lattice(display);
        const Lattice view = lattice.view();
        const WireOrder order(display, lattice);
        std::vector<bool> seen(view.sample_count());
        std::size_t wrong = 0;  // Outside, or seen before: millions of assertions would take minutes.
        for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
            for (std::uint32_t p = 0; p < display.panel_count; ++p) {
                for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                    for (std::uint32_t column = 0; column < display.panels[p].columns; ++column) {
                        const Sample s = order.sample(slice, p, row, column);
                        const std::size_t number = (std::size_t{s.k} * view.ny + s.y) * view.nx + s.x;
                        if (number >= seen.size() || seen[number]) {
                            ++wrong;
                        } else {
                            seen[number] = true;
                        }
                    }
                }
            }
        }
        CHECK(wrong == 0);
        CHECK(frame_pixels(display) == seen.size());
    };
    for (const DisplayDescription& display : test::odd_displays()) check(display);
    for (const Preset& preset : presets()) check(some_rows(load_display(std::string(preset.name)).value()));
}

TEST_CASE("stacks and planes that sweep evenly are their own Cartesian volume: nothing is lost or lit twice") {
    for (const DisplayDescription& display : test::odd_displays()) {
        const DisplayLattice lattice(display);
        if (!lattice.view().is_regular()) continue;
        INFO(std::string(display.name.view()));
        const SliceMap map(display, lattice);
        const BitVolume volume = random_volume(map.grid());
        BitVolume samples(lattice.view());
        REQUIRE(map.sample(volume.view(), samples.view()) == Status::Ok);
        CHECK((samples == volume));
        for (const LightMode mode : {LightMode::Bright, LightMode::Uniform}) {
            const SliceCoverage coverage = map.coverage(mode);
            CHECK(coverage.covered == frame_pixels(display));
            CHECK(coverage.reachable == coverage.voxels);
            CHECK(coverage.most_visits == 1);
        }
    }
}

TEST_CASE("coverage counts what a walk over all samples counts") {
    for (const DisplayDescription& display : test::odd_displays()) {
        INFO(std::string(display.name.view()));
        const DisplayLattice lattice(display);
        const Lattice view = lattice.view();
        const SliceMap map(display, lattice);
        const Lattice& grid = map.grid();
        const double radius = extent(display).radius_mm;
        for (const LightMode mode : {LightMode::Bright, LightMode::Uniform}) {
            std::vector<std::uint32_t> visits(grid.sample_count());
            for_each_sample(view, [&](std::uint32_t x, std::uint32_t y, std::uint32_t k) {
                if (mode == LightMode::Bright || map.is_lit(x, y, k)) ++visits[map.voxel(x, y, k)];
            });
            SliceCoverage expected{.voxels = grid.sample_count(), .least_visits = 1u << 31};
            for_each_sample(grid, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
                const glm::dvec3 place = sample_position(grid, x, y, z);
                if (radius > 0.0 && std::hypot(place.x, place.y) > radius) return;
                ++expected.reachable;
                const std::uint32_t n = visits[(std::size_t{z} * grid.ny + y) * grid.nx + x];
                expected.covered += n > 0 ? 1 : 0;
                expected.visits += n;
                if (n > 0) expected.least_visits = std::min(expected.least_visits, n);
                expected.most_visits = std::max(expected.most_visits, n);
            });
            const SliceCoverage found = map.coverage(mode);
            CHECK(found.voxels == expected.voxels);
            CHECK(found.reachable == expected.reachable);
            CHECK(found.covered == expected.covered);
            CHECK(found.visits == expected.visits);
            CHECK(found.least_visits == expected.least_visits);
            CHECK(found.most_visits == expected.most_visits);
        }
    }
}

TEST_CASE("a helix whose Cartesian volume would be too large has one with fewer voxels, and stays within it") {
    DisplayDescription display = test::flat_display("tall-helix", DisplayKind::Helix, 4096);
    display.panels[0] = {.columns = 520, .rows = 520};
    display.motion.stroke_mm = 100.0;
    const DisplayLattice lattice(display);
    const SliceMap map(display, lattice);
    REQUIRE(map.grid().nz < display.slices);
    REQUIRE(map.grid().sample_count() <= std::size_t{1} << 30);
    for (std::uint32_t k = 0; k < display.slices; ++k) {
        for (const std::uint32_t x : {0u, 259u, 519u}) REQUIRE(map.voxel(x, x, k) < map.grid().sample_count());
    }
    CHECK(map.voxel(3, 3, 4095) / map.grid().column_count() == map.grid().nz - 1);
}

TEST_CASE("two points far apart are counted without a table of the space between them") {
    static constexpr std::array<PointMm, 2> kFar{{{0, 0, 0}, {1000, 1000, 1000}}};
    DisplayDescription display = test::flat_display("far", DisplayKind::FreePoints, 1);
    display.panels[0] = {.columns = 2, .rows = 1, .column_pitch_mm = 0.5, .row_pitch_mm = 0.5};
    display.points = kFar;
    const DisplayLattice lattice(display);
    const SliceCoverage coverage = SliceMap(display, lattice).coverage(LightMode::Uniform);
    CHECK(coverage.voxels > 900'000'000);
    CHECK(coverage.covered == 2);
    CHECK(coverage.visits == 2);
}

TEST_CASE("a slice map refuses volumes of another shape") {
    const DisplayDescription display = test::upright_rotor(false, false, 0);
    const DisplayLattice lattice(display);
    const SliceMap map(display, lattice);
    BitVolume samples(lattice.view());
    const BitVolume volume(map.grid());
    CHECK(map.sample(samples.view(), samples.view()) == Status::InvalidArgument);
    BitVolume other(map.grid());
    CHECK(map.sample(volume.view(), other.view()) == Status::InvalidArgument);
    CHECK(map.thin(other.view()) == Status::InvalidArgument);
}
