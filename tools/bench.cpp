#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/bench/floor.h"
#include "tools/bench/input.h"
#include "tools/bench/methods.h"
#include "tools/bench/race.h"
#include "tools/bench/result.h"
#include "tools/bench/surface.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/kernel_choice.h"
#include "tools/placement.h"
#include "voxelizer/fit.h"
#include "voxelizer/io/atomic_file.h"
#include "voxelizer/io/file_name.h"

namespace xorvox::tools {
namespace {

constexpr Pace kUsualPace;
constexpr Pace kQuickPace{.least_runs = 3, .most_runs = 100, .budget_ms = 30.0};

/// What the options mean.
struct Plan {
    std::vector<std::uint32_t> sizes;
    std::vector<std::string> methods;
    std::vector<std::uint32_t> threads;
    Kernel kernel = best_kernel();
    Pace pace;
};

Expected<std::vector<std::string>> parse_methods(const std::string& text) {
    std::vector<std::string> methods;
    for (const std::string& method : split(text)) {
        if (std::ranges::find(method_names(), method) == method_names().end()) {
            return fail(fmt::format("--methods has '{}'; there are {}", method, fmt::join(method_names(), ", ")));
        }
        if (std::ranges::find(methods, method) == methods.end()) methods.push_back(method);
    }
    return methods;
}

Expected<Plan> parse(const BenchOptions& options) {
    auto sizes = parse_numbers("--sizes", options.sizes, kMaxLatticeSide);
    if (!sizes) return tl::unexpected(sizes.error());
    auto methods = parse_methods(options.methods);
    if (!methods) return tl::unexpected(methods.error());
    auto threads = parse_numbers("--threads", options.threads, kMaxSolidThreads);
    if (!threads) return tl::unexpected(threads.error());
    const auto kernel = choose_kernel(options.kernel);
    if (!kernel) return tl::unexpected(kernel.error());
    return Plan{std::move(*sizes), std::move(*methods), std::move(*threads), *kernel,
                options.quick ? kQuickPace : kUsualPace};
}

/// A method and its number of threads, in a race.
struct Entry {
    std::string method;
    unsigned threads = 1;
};

std::vector<Entry> entries_of(const Plan& plan) {
    std::vector<Entry> entries;
    for (const std::string& method : plan.methods) {
        for (const unsigned threads : has_threads(method) ? plan.threads : std::vector<std::uint32_t>{1}) {
            entries.push_back({method, threads});
        }
    }
    return entries;
}

/// The outcomes of a job's runs.
struct Record {
    Job job;
    std::vector<JobOutcome> outcomes;
};

SolidTimes median_times(std::span<const JobOutcome> outcomes) {
    const auto median_of = [outcomes](double SolidTimes::*phase) {
        std::vector<double> phases_ms;
        for (const JobOutcome& outcome : outcomes) phases_ms.push_back(outcome.times.*phase);
        return median(std::move(phases_ms));
    };
    return {median_of(&SolidTimes::snap_ms), median_of(&SolidTimes::cross_ms), median_of(&SolidTimes::finish_ms)};
}

/// Letters of the longest name, or of the word that stands above them.
std::size_t width_of_names(const std::vector<Model>& models) {
    std::size_t width = std::string_view("model").size();
    for (const Model& model : models) {
        const auto starts_letter = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };  // of UTF-8
        width = std::max(width, static_cast<std::size_t>(std::ranges::count_if(model.name, starts_letter)));
    }
    return width;
}

/// Refuses sizes for which there is no memory, before the first of them is measured.
Expected<void> check_sizes(const std::vector<Model>& models, const Plan& plan) {
    constexpr std::uint64_t kVertexBytes = 16;
    const std::uint64_t size = std::ranges::max(plan.sizes);
    std::size_t vertices = 0;
    for (const Model& model : models) vertices = std::max(vertices, model.mesh.positions.size());
    const std::uint64_t jobs = entries_of(plan).size();
    return check_memory(size * size * size / 8 + jobs * (SolidOptions().event_bytes + kVertexBytes * vertices),
                        fmt::format("a grid of {0} × {0} × {0} voxels", size));
}

/// The race of all entries, and of the floor, for one model and size.
Expected<std::vector<BenchResult>> measure(const Model& model, std::uint32_t size, const Plan& plan) {
    const Lattice lattice = *fit_cube(model.box, size);
    const MeshView mesh = model.mesh.view();
    const std::vector<Entry> entries = entries_of(plan);
    BitVolume volume(lattice);
    std::uint64_t seen = 0;
    std::vector<Runner> runners;
    // The mesh first: whoever comes after the volume's passes finds it as cold as these leave it.
    runners.emplace_back([&] { seen += read_corners(mesh); });
    runners.emplace_back([&] { clear(volume.view()); });
    runners.emplace_back([&] { xor_layers(volume.view()); });
    const std::size_t floor_runners = runners.size();

    std::vector<BenchResult> results;
    std::vector<Record> records;
    for (const Entry& entry : entries) {
        const SolidOptions solid{.kernel = plan.kernel, .threads = entry.threads};
        Record& record = records.emplace_back(Record{make_job(entry.method, solid, mesh, lattice, volume.view()), {}});
        if (const JobOutcome outcome = record.job(); outcome.status != Status::Ok) {
            return fail(fmt::format("{}: {} at {} a side answered {}", model.path, entry.method, size,
                                    to_string(outcome.status)));
        }
        results.push_back({.model = model.name,
                           .triangles = model.triangles,
                           .size = size,
                           .method = entry.method,
                           .kernel = entry.method == "column" ? to_string(plan.kernel) : "",
                           .threads = entry.threads,
                           .set = volume.count(),
                           .surface = count_surface(volume.view())});
    }
    for (Record& record : records) {
        runners.emplace_back([&record] { record.outcomes.push_back(record.job()); });
    }
    race(runners, plan.pace);

    const FloorTimes floor{
        .clear_ms = runners[1].median_ms(), .xor_ms = runners[2].median_ms(), .read_ms = runners[0].median_ms()};
    for (std::size_t i = 0; i < results.size(); ++i) {
        const Runner& runner = runners[floor_runners + i];
        results[i].runs = runner.runs_ms.size();
        results[i].ms = runner.median_ms();
        results[i].cpu_ms = runner.median_cpu_ms();
        results[i].phases = median_times(std::span(records[i].outcomes).last(results[i].runs));
        results[i].floor = floor;
        results[i].crossings = records[i].outcomes.back().crossings;
    }
    return results;
}

/// One thread that takes longer than it computes has shared its processor.
void warn_if_busy(std::span<const BenchResult> results) {
    const auto is_late = [](const BenchResult& r) { return r.threads == 1 && r.cpu_ms < 0.9 * r.ms; };
    const auto late = std::ranges::count_if(results, is_late);
    if (late == 0) return;
    warn(fmt::format("other programs ran at the same time: {} of {} medians are too long by more than a tenth", late,
                     results.size()));
}

}  // namespace

Expected<void> bench_voxelize(const BenchOptions& options) {
    const Expected<Plan> plan = parse(options);
    if (!plan) return tl::unexpected(plan.error());
    std::optional<io::AtomicFile> plot;
    if (!options.plot.empty()) {
        if (io::extension_of(options.plot) != ".png") {
            return fail(fmt::format("--plot {}: the chart is a PNG; give it a name that ends in .png", options.plot));
        }
        Expected<io::AtomicFile> file = io::AtomicFile::create(options.plot);
        if (!file) return tl::unexpected(file.error());
        plot = std::move(*file);
    }
    const Expected<std::vector<Model>> models = read_models(options.meshes);
    if (!models) return tl::unexpected(models.error());
    if (const auto fits = check_sizes(*models, *plan); !fits) return fits;

    std::vector<BenchResult> results;
    const std::size_t model_width = width_of_names(*models);
    if (!options.json) fmt::print("{}", bench_heading(model_width));
    for (const Model& model : *models) {
        for (const std::uint32_t size : plan->sizes) {
            Expected<std::vector<BenchResult>> measured;
            {
                const Progress progress(fmt::format("{} at {}", model.name, size));
                measured = measure(model, size, *plan);
            }
            if (!measured) return tl::unexpected(measured.error());
            for (const BenchResult& result : *measured) {
                if (!options.json) fmt::print("{}", bench_line(result, model_width));
                results.push_back(result);
            }
            std::fflush(stdout);
        }
    }
    if (plot) {
        const std::vector<std::byte> png = sim::encode_png(bench_chart(results));
        const std::string_view bytes(reinterpret_cast<const char*>(png.data()), png.size());
        if (const auto written = plot->write(bytes); !written) return written;
        if (const auto committed = plot->commit(); !committed) return committed;
    }
    warn_if_busy(results);
    if (options.tables) fmt::print("\n{}", paper_tables(results));
    if (options.json) fmt::print("{}", bench_json(results));
    return {};
}

}  // namespace xorvox::tools
