// Measures what `xorvox bench` does not: the phases of every kernel, the other ways of asking a SolidVoxelizer, and
// table lattices; all in turns, so that the ratios hold on a noisy machine.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tests/bench/arguments.h"
#include "tools/bench/methods.h"
#include "tools/bench/race.h"
#include "tools/console.h"
#include "voxelizer/fit.h"

namespace {

using namespace xorvox;
using namespace xorvox::bench;
using namespace xorvox::tools;

constexpr Pace kPace;
/// A table lattice may take so many times as long for a crossing as a regular one.
constexpr double kTableAim = 3.0;
/// Two threads are to be so many times as fast as one.
constexpr double kThreadsAim = 1.7;

void expect_ok(Status status) {
    if (status == Status::Ok) return;
    complain(fmt::format("a voxelizer answered {}", to_string(status)));
    std::exit(1);
}

double median_of(const std::vector<JobOutcome>& outcomes, double SolidTimes::*phase) {
    std::vector<double> phases_ms;
    for (const JobOutcome& outcome : outcomes) phases_ms.push_back(outcome.times.*phase);
    return median(std::move(phases_ms));
}

void measure_kernels(const Model& model, const Lattice& lattice) {
    BitVolume volume(lattice);
    std::vector<std::vector<JobOutcome>> outcomes(available_kernels().size());
    std::vector<Runner> runners;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const SolidOptions options{.kernel = available_kernels()[i]};
        const Job job = make_job("column", options, model.mesh.view(), lattice, volume.view());
        runners.emplace_back([job, &found = outcomes[i]] {
            found.push_back(job());
            expect_ok(found.back().status);
        });
    }
    race(runners, kPace);
    fmt::print("  {:<24} {:>9} {:>9} {:>9} {:>9}  {}\n", "kernel", "ms", "snap", "cross", "finish", "scalar ÷ it");
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        fmt::print("  {:<24} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f}  {:.2f}\n", to_string(available_kernels()[i]),
                   runners[i].median_ms(), median_of(outcomes[i], &SolidTimes::snap_ms),
                   median_of(outcomes[i], &SolidTimes::cross_ms), median_of(outcomes[i], &SolidTimes::finish_ms),
                   runners[0].median_ms() / runners[i].median_ms());
    }
}

/// Computes for some milliseconds, without memory.
void spin(int rounds) {
    std::uint64_t state = 1;
    for (int i = 0; i < 1'000'000 * rounds; ++i) state = state * 6364136223846793005u + 1442695040888963407u;
    static std::atomic<std::uint64_t> seen;
    seen = state;
}

/// The same by two threads, half each.
void spin_by_two(int rounds) {
    const std::jthread other([rounds] { spin(rounds / 2); });
    spin(rounds / 2);
}

/// A way of asking, and how long it took.
struct Way {
    std::string name;
    std::function<void()> work;
};

void measure_ways(const Model& model, const Lattice& lattice) {
    const MeshView mesh = model.mesh.view();
    BitVolume volume(lattice);
    const std::uint32_t part = std::max(1u, lattice.nx / 8);
    const Region middle{glm::uvec3((lattice.nx - part) / 2), glm::uvec3(part)};
    BitVolume part_volume(part, part, part);
    CrossingLists lists;
    SolidVoxelizer one;
    SolidVoxelizer two({.threads = 2});
    for (SolidVoxelizer* const voxelizer : {&one, &two}) {
        expect_ok(voxelizer->set_mesh(mesh));
        expect_ok(voxelizer->set_lattice(lattice));
    }
    const auto move = [&] { expect_ok(one.set_positions(mesh.positions)); };
    const std::vector<Way> ways{
        {"from the mesh",
         [&] {
             expect_ok(one.set_mesh(mesh));
             expect_ok(one.solid(volume.view()));
         }},
        {"2 threads",
         [&] {
             expect_ok(two.set_mesh(mesh));
             expect_ok(two.solid(volume.view()));
         }},
        {"new positions",
         [&] {
             move();
             expect_ok(one.solid(volume.view()));
         }},
        {"nothing new", [&] { expect_ok(one.solid(volume.view())); }},
        {"1/8 a side, nothing new", [&] { expect_ok(one.solid(middle, part_volume.view())); }},
        {"crossing lists",
         [&] {
             move();
             expect_ok(one.crossings(whole(lattice), lists));
         }},
        {"slabs of 64 layers",
         [&] {
             move();
             expect_ok(one.slabs(64, [](ConstBitVolumeView, std::uint32_t) { return true; }));
         }},
    };
    std::vector<Runner> runners;
    for (const Way& way : ways) runners.emplace_back(way.work);
    constexpr int kSpinRounds = 4;
    runners.emplace_back([] { spin(kSpinRounds); });
    runners.emplace_back([] { spin_by_two(kSpinRounds); });
    race(runners, kPace);
    const double usual_ms = runners[0].median_ms();
    fmt::print("  {:<24} {:>9}  {}\n", "way", "ms", "÷ the first");
    for (std::size_t i = 0; i < ways.size(); ++i) {
        fmt::print("  {:<24} {:>9.3f}  {:.3f}\n", ways[i].name, runners[i].median_ms(),
                   runners[i].median_ms() / usual_ms);
    }
    const double gain = usual_ms / runners[1].median_ms();
    const double possible = runners[ways.size()].median_ms() / runners[ways.size() + 1].median_ms();
    fmt::print(
        "  two threads are {:.2f} × as fast as one; aim (dragon871k at 512 and 1024) {}: {}; here and now two that "
        "only "
        "compute are {:.2f} × as fast\n",
        gain, kThreadsAim, gain >= kThreadsAim ? "met" : "MISSED", possible);
}

/// A lattice that owns its tables.
struct Tables {
    std::string name;
    std::vector<glm::dvec2> plan;
    std::vector<double> z0;
    std::vector<double> z;

    Lattice lattice(std::uint32_t side) const {
        return {.nx = side, .ny = side, .nz = side, .plan = plan, .z0 = z0, .z = z};
    }
};

std::vector<double> heights(const Lattice& regular) {
    std::vector<double> z;
    for (std::uint32_t k = 0; k < regular.nz; ++k) z.push_back(sample_position(regular, 0, 0, k).z);
    return z;
}

/// The samples of a regular lattice, as tables.
Tables same_points(const Lattice& regular) {
    Tables tables{"table, the same points", {}, {}, heights(regular)};
    for (std::uint32_t y = 0; y < regular.ny; ++y) {
        for (std::uint32_t x = 0; x < regular.nx; ++x) tables.plan.emplace_back(sample_position(regular, x, y, 0));
    }
    return tables;
}

/// A panel that turns in the same cube, as many columns and slices as the cube has samples a side; `rise` layers a
/// turn, as on a helix.
Tables rotor(std::string name, const Lattice& regular, double rise) {
    Tables tables{std::move(name), {}, {}, heights(regular)};
    const glm::dvec2 half = 0.5 * glm::dvec2(regular.nx, regular.ny) * glm::dvec2(regular.pitch);
    for (std::uint32_t slice = 0; slice < regular.ny; ++slice) {
        const double turn = static_cast<double>(slice) / regular.ny;
        const double angle = 2.0 * std::numbers::pi * turn;
        for (std::uint32_t column = 0; column < regular.nx; ++column) {
            const double radius = (column + 0.5) / regular.nx;
            tables.plan.push_back(glm::dvec2(regular.origin) + half +
                                  half * radius * glm::dvec2(std::cos(angle), std::sin(angle)));
            if (rise != 0.0) tables.z0.push_back(rise * turn * regular.pitch.z);
        }
    }
    return tables;
}

void measure_tables(const Model& model, const Lattice& regular) {
    const MeshView mesh = model.mesh.view();
    const Tables tables[] = {same_points(regular), rotor("rotating panel", regular, 0.0), rotor("helix", regular, 8.0)};
    std::vector<Lattice> lattices{regular};
    std::vector<std::string> names{"regular"};
    for (const Tables& one : tables) {
        lattices.push_back(one.lattice(regular.nx));
        names.push_back(one.name);
    }
    BitVolume volume(regular);
    std::vector<SolidVoxelizer> voxelizers(lattices.size());
    std::vector<std::size_t> crossings(lattices.size());
    std::vector<Runner> runners;
    for (std::size_t i = 0; i < lattices.size(); ++i) {
        expect_ok(voxelizers[i].set_mesh(mesh));
        expect_ok(voxelizers[i].set_lattice(lattices[i]));
        runners.emplace_back([&, i] {
            SolidReport report;
            expect_ok(voxelizers[i].set_positions(mesh.positions));
            expect_ok(voxelizers[i].solid(volume.view(), &report));
            crossings[i] = report.crossings;
        });
    }
    race(runners, kPace);
    const auto ns_each = [&](std::size_t i) {
        return runners[i].median_ms() * 1e6 / static_cast<double>(std::max<std::size_t>(1, crossings[i]));
    };
    fmt::print("  {:<24} {:>9} {:>12} {:>9}  {}\n", "lattice", "ms", "crossings", "ns each", "÷ regular");
    for (std::size_t i = 0; i < lattices.size(); ++i) {
        const double ratio = ns_each(i) / ns_each(0);
        fmt::print("  {:<24} {:>9.3f} {:>12} {:>9.2f}  {:.2f}{}\n", names[i], runners[i].median_ms(),
                   thousands(crossings[i]), ns_each(i), ratio,
                   i == 0               ? ""
                   : ratio <= kTableAim ? fmt::format(", aim at most {}: met", kTableAim)
                                        : fmt::format(", aim at most {}: MISSED", kTableAim));
    }
}

}  // namespace

int main(int argc, char** argv) {
    const Expected<Arguments> arguments = parse_arguments(argc, argv, "64,256,512,1024", false);
    if (!arguments) {
        complain(arguments.error().message);
        return 2;
    }
    if (arguments->help) {
        fmt::print("{}\n", arguments->usage);
        return 0;
    }
    for (const Model& model : arguments->models) {
        for (const std::uint32_t size : arguments->sizes) {
            const Lattice lattice = *fit_cube(model.box, size);
            fmt::print("{}, {} triangles, at {}\n", model.name, thousands(model.triangles), size);
            measure_kernels(model, lattice);
            measure_ways(model, lattice);
            measure_tables(model, lattice);
            std::fflush(stdout);
        }
    }
    return 0;
}
