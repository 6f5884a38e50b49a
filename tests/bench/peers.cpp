// Measures SolidVoxelizer, one thread, against other libraries on the same grids, in turns; and tells which of the
// project's aims are met. Times are those of the processor: where other programs run, a library that takes a second is
// interrupted many times and one that takes a millisecond is not.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "tests/bench/arguments.h"
#include "tests/bench/peer.h"
#include "tools/bench/floor.h"
#include "tools/bench/methods.h"
#include "tools/bench/race.h"
#include "tools/console.h"
#include "voxelizer/fit.h"

namespace {

using namespace xorvox;
using namespace xorvox::bench;
using namespace xorvox::tools;

/// Slow peers run three times.
constexpr Pace kPace{.least_runs = 3, .most_runs = 1000, .budget_ms = 1000.0};

/// What is to be reached; see docs/performance.md.
struct Aim {
    std::string_view model;
    std::uint32_t size;
    double vtk_over_ours;                   ///< At least.
    std::optional<double> ours_over_floor;  ///< At most.
};
constexpr Aim kAims[] = {
    {"dragon871k", 64, 300.0, {}},    {"dragon871k", 256, 450.0, {}}, {"dragon871k", 512, 600.0, 5.0},
    {"dragon871k", 1024, 450.0, 3.0}, {"bunny70k", 64, 200.0, {}},    {"bunny70k", 256, 150.0, {}},
    {"bunny70k", 512, 140.0, 5.0},    {"bunny70k", 1024, 65.0, 2.5},
};

struct PeerResult {
    std::string name;
    double ms = 0;
    std::size_t runs = 0;
    std::size_t different = 0;  ///< Voxels that are not as ours.
};

struct Comparison {
    std::string model;
    std::uint32_t size = 0;
    double ms = 0;
    std::size_t runs = 0;
    double floor_ms = 0;
    std::size_t set = 0;
    std::vector<PeerResult> peers;
};

std::vector<Peer> make_peers(const MeshView& mesh, const Lattice& lattice) {
    std::vector<Peer> peers;
#if XORVOX_HAS_VTK
    peers.push_back(make_vtk_peer(mesh, lattice));
#endif
#if XORVOX_HAS_OPENVDB
    peers.push_back(make_openvdb_peer(mesh, lattice));
#endif
    return peers;
}

std::size_t count_different(const BitVolume& a, const BitVolume& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.view().words.size(); ++i) {
        count += static_cast<std::size_t>(std::popcount(a.view().words[i] ^ b.view().words[i]));
    }
    return count;
}

Comparison compare(const Model& model, std::uint32_t size) {
    const Lattice lattice = *fit_cube(model.box, size);
    const MeshView mesh = model.mesh.view();
    BitVolume volume(lattice);
    const Job ours = make_job("column", {}, mesh, lattice, volume.view());
    const std::vector<Peer> peers = make_peers(mesh, lattice);
    std::uint64_t seen = 0;

    std::vector<Runner> runners;
    runners.emplace_back([&] { seen += read_corners(mesh); });
    runners.emplace_back([&] { clear(volume.view()); });
    runners.emplace_back([&] { xor_layers(volume.view()); });
    for (const Peer& peer : peers) runners.emplace_back(peer.run);
    runners.emplace_back([&] { (void)ours(); });
    race(runners, kPace);

    Comparison comparison{model.name, size};
    for (std::size_t i = 0; i < 3; ++i) comparison.floor_ms += runners[i].median_cpu_ms();
    comparison.ms = runners.back().median_cpu_ms();
    comparison.runs = runners.back().runs_ms.size();
    comparison.set = volume.count();
    for (std::size_t i = 0; i < peers.size(); ++i) {
        const Runner& runner = runners[3 + i];
        comparison.peers.push_back(
            {peers[i].name, runner.median_cpu_ms(), runner.runs_ms.size(), count_different(volume, peers[i].voxels())});
    }
    return comparison;
}

std::string verdict(bool met) {
    return met ? "met" : "MISSED";
}

void print_text(const Comparison& c) {
    fmt::print("{:<12} {:>5}  column {:>9.3f} ms ({} runs), {} voxels, {:.1f} × the floor of {:.3f} ms\n", c.model,
               c.size, c.ms, c.runs, thousands(c.set), c.ms / c.floor_ms, c.floor_ms);
    for (const PeerResult& peer : c.peers) {
        fmt::print("{:<12} {:>5}  {:<7} {:>8.1f} ms ({} runs), {:.0f} × ours, {} voxels differ\n", "", "", peer.name,
                   peer.ms, peer.runs, peer.ms / c.ms, thousands(peer.different));
    }
    const auto* const aim =
        std::ranges::find_if(kAims, [&](const Aim& a) { return a.model == c.model && a.size == c.size; });
    if (aim == std::end(kAims)) return;
    for (const PeerResult& peer : c.peers) {
        if (peer.name != "VTK") continue;
        const double ratio = peer.ms / c.ms;
        fmt::print("{:<18}  VTK ÷ ours {:.0f}, aim at least {:.0f}: {}\n", "", ratio, aim->vtk_over_ours,
                   verdict(ratio >= aim->vtk_over_ours));
    }
    if (aim->ours_over_floor) {
        const double ratio = c.ms / c.floor_ms;
        fmt::print("{:<18}  ours ÷ floor {:.2f}, aim at most {:.1f}: {}\n", "", ratio, *aim->ours_over_floor,
                   verdict(ratio <= *aim->ours_over_floor));
    }
}

std::string json(const Comparison& c) {
    std::string out = fmt::format(
        "  {{\"model\": {}, \"size\": {}, \"ms\": {}, \"runs\": {}, \"floor_ms\": {}, \"floor_ratio\": {}, \"set\": "
        "{}, "
        "\"peers\": [",
        json_string(c.model), c.size, c.ms, c.runs, c.floor_ms, c.ms / c.floor_ms, c.set);
    const char* separator = "";
    for (const PeerResult& peer : c.peers) {
        out += fmt::format("{}{{\"name\": {}, \"ms\": {}, \"runs\": {}, \"ratio\": {}, \"different\": {}}}", separator,
                           json_string(peer.name), peer.ms, peer.runs, peer.ms / c.ms, peer.different);
        separator = ", ";
    }
    return out + "]}";
}

}  // namespace

int main(int argc, char** argv) {
    const Expected<Arguments> arguments = parse_arguments(argc, argv, "64,256,512,1024", true);
    if (!arguments) {
        complain(arguments.error().message);
        return 2;
    }
    if (arguments->help) {
        fmt::print("{}\n", arguments->usage);
        return 0;
    }
    const char* separator = "[\n";
    for (const Model& model : arguments->models) {
        if (model.triangles * 3 != model.mesh.view().used_indices().size()) {
            complain(model.path + ": has polygons, and the peers take triangles");
            return 2;
        }
        for (const std::uint32_t size : arguments->sizes) {
            const Comparison comparison = compare(model, size);
            if (arguments->json) {
                fmt::print("{}{}", separator, json(comparison));
                separator = ",\n";
            } else {
                print_text(comparison);
            }
            std::fflush(stdout);
        }
    }
    if (arguments->json) fmt::print("\n]\n");
    return 0;
}
