#include <string>

#include <fmt/format.h>

#include "tools/bench/result.h"
#include "tools/console.h"

namespace xorvox::tools {
namespace {

constexpr const char* kLine =
    "{:<{}}  {:>5}  {:<10}  {:<6}  {:>7}  {:>9}  {:>9}  {:>9}  {:>9}  {:>9}  {:>7}  {:>11}  {:>8}  {:>13}\n";

/// Four digits that matter, none of them in an exponent.
std::string digits(double ms) {
    return fmt::format("{:.{}f}", ms, ms < 0.01 ? 5 : ms < 0.1 ? 4 : ms < 100.0 ? 3 : 1);
}

double ns_a_crossing(const BenchResult& r) {
    return r.crossings == 0 ? 0.0 : r.ms * 1e6 / static_cast<double>(r.crossings);
}

}  // namespace

std::string bench_heading(std::size_t model_width) {
    return fmt::format(kLine, "model", model_width, "size", "method", "kernel", "threads", "ms", "snap ms", "cross ms",
                       "finish ms", "floor ms", "÷ floor", "crossings", "ns each", "voxels set");
}

std::string bench_line(const BenchResult& r, std::size_t model_width) {
    const bool phases = !r.kernel.empty();
    const auto phase = [phases](double ms) { return phases ? digits(ms) : std::string("-"); };
    return fmt::format(kLine, r.model, model_width, r.size, r.method, phases ? r.kernel : "-", r.threads, digits(r.ms),
                       phase(r.phases.snap_ms), phase(r.phases.cross_ms), phase(r.phases.finish_ms),
                       digits(r.floor.sum_ms()), fmt::format("{:.1f}", r.floor_ratio()),
                       r.crossings == 0 ? "-" : thousands(r.crossings),
                       r.crossings == 0 ? "-" : fmt::format("{:.2f}", ns_a_crossing(r)), thousands(r.set));
}

std::string bench_json(std::span<const BenchResult> results) {
    std::string out = "[";
    const char* separator = "\n";
    for (const BenchResult& r : results) {
        const bool column = !r.kernel.empty();
        const auto phase = [column](double ms) { return column ? fmt::format("{}", ms) : std::string("null"); };
        out += fmt::format(
            "{}  {{\"model\": {}, \"triangles\": {}, \"size\": {}, \"method\": {}, \"kernel\": {}, \"threads\": {}, "
            "\"runs\": {}, \"ms\": {}, \"cpu_ms\": {}, \"snap_ms\": {}, \"cross_ms\": {}, \"finish_ms\": {}, "
            "\"floor_ms\": {}, "
            "\"floor_clear_ms\": {}, \"floor_xor_ms\": {}, \"floor_read_ms\": {}, \"floor_ratio\": {}, "
            "\"crossings\": {}, \"surface\": {}, \"set\": {}}}",
            separator, json_string(r.model), r.triangles, r.size, json_string(r.method),
            column ? json_string(r.kernel) : "null", r.threads, r.runs, r.ms, r.cpu_ms, phase(r.phases.snap_ms),
            phase(r.phases.cross_ms), phase(r.phases.finish_ms), r.floor.sum_ms(), r.floor.clear_ms, r.floor.xor_ms,
            r.floor.read_ms, r.floor_ratio(),
            r.method == "simplicial" ? std::string("null") : std::to_string(r.crossings), r.surface, r.set);
        separator = ",\n";
    }
    return out + "\n]\n";
}

std::string bench_json_fields() {
    return "The fields of --json, an object for each model, size, method and number of threads. Times are medians:\n"
           "  model, triangles, size (samples a side), method, kernel (null but for column), threads\n"
           "  runs            how many were timed\n"
           "  ms              milliseconds from mesh to bits, by the clock\n"
           "  cpu_ms          milliseconds of all processors together\n"
           "  snap_ms, cross_ms, finish_ms\n"
           "                  milliseconds of the phases: vertices to integers, triangles to crossings, crossings to\n"
           "                  bits (null but for column)\n"
           "  floor_ms        milliseconds of the floor, the sum of floor_clear_ms (volume), floor_xor_ms (layers)\n"
           "                  and floor_read_ms (corners)\n"
           "  floor_ratio     ms / floor_ms\n"
           "  crossings       of columns and faces (null for simplicial)\n"
           "  set, surface    voxels inside, and those of them with a neighbour that is not";
}

}  // namespace xorvox::tools
