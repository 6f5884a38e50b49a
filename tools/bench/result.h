// BenchResult: what `xorvox bench voxelize` measures, and the forms in which it is told.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "sim/image.h"
#include "voxelizer/solid_voxelizer.h"

namespace xorvox::tools {

/// The three passes of voxelizer's floor (tools/floor.h): medians of the same race, in milliseconds.
struct FloorTimes {
    double clear_ms = 0;
    double xor_ms = 0;
    double read_ms = 0;

    double sum_ms() const { return clear_ms + xor_ms + read_ms; }
};

/// One model, size, method and number of threads. Times are medians.
struct BenchResult {
    std::string model;  ///< See Model (tools/bench/input.h).
    std::size_t triangles = 0;
    std::uint32_t size = 0;  ///< Samples a side.
    std::string method;      ///< "column", "simplicial" or "reference".
    std::string kernel;      ///< Of "column"; empty else.
    unsigned threads = 1;
    std::size_t runs = 0;
    double ms = 0;      ///< By the clock on the wall.
    double cpu_ms = 0;  ///< Of the processors, all threads together.
    SolidTimes phases;  ///< Of "column"; zeros else.
    FloorTimes floor;
    std::size_t crossings = 0;  ///< See SolidReport; 0 for "simplicial", which has none.
    std::size_t set = 0;        ///< Voxels inside.
    std::size_t surface = 0;    ///< Those of them with a neighbour, across a face, that is not inside.

    double floor_ratio() const { return ms / std::max(floor.sum_ms(), 1e-6); }
};

/// Lines of a table for a person, its heading and a result; models have a column of `model_width` letters.
std::string bench_heading(std::size_t model_width);
std::string bench_line(const BenchResult& result, std::size_t model_width);

/// One JSON array of objects, all with the same keys; those that a method does not have are null.
std::string bench_json(std::span<const BenchResult> results);

/// What the keys mean, and their units, in lines for a person.
std::string bench_json_fields();

/// The rows and columns of Tables 2 to 4 of Rueda, Ogáyar, Segura, Feito: "Fast and Simple Hardware Accelerated
/// Voxelizations Using Simplicial Coverings", section 6, as Markdown: the seconds that are printed there beside those
/// of the models that stand in, on one thread; "-" for what was not measured, and no row for a model without results.
/// When none has any, a line that says so.
std::string paper_tables(std::span<const BenchResult> results);

/// Three panels with logarithmic axes: time against size, a line for each model, method and number of threads; time
/// against triangles, a line for each size; time against surface voxels, a line for each model, the last two for the
/// first method and number of threads only. Grey lines show growth in proportion. There must be results.
sim::Image bench_chart(std::span<const BenchResult> results);

}  // namespace xorvox::tools
