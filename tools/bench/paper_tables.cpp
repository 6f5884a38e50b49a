#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "tools/bench/result.h"

namespace xorvox::tools {
namespace {

constexpr std::uint32_t kSizes[] = {64, 128, 256, 512};
constexpr std::size_t kSizeCount = std::size(kSizes);

/// A row of the tables: seconds as they are printed, for each size.
struct PaperModel {
    const char* name;
    const char* triangles;
    const char* stand_in;
    double ha[kSizeCount];      ///< Slices cut on the CPU (Tables 2 and 3).
    double vp[kSizeCount];      ///< Cut in a vertex program, display lists (Tables 2 and 3).
    double sramek[kSizeCount];  ///< Šrámek's surface voxelization (Tables 2 and 3).
    double va[kSizeCount];      ///< Cut in a vertex program, vertex arrays (Table 4).
    double dl[kSizeCount];      ///< The same, display lists (Table 4).
};

constexpr PaperModel kPaper[] = {
    {"Simple",
     "25",
     "gem24",
     {0.0088, 0.0032, 0.0134, 0.0696},
     {0.0031, 0.0032, 0.0058, 0.0108},
     {0.0563, 0.6034, 4.4940, 43.9656},
     {0.0030, 0.0017, 0.0030, 0.0077},
     {0.0031, 0.0032, 0.0058, 0.0108}},
    {"Celtic Cross",
     "1,849",
     "gem1944",
     {0.0147, 0.0292, 0.0634, 0.1886},
     {0.0014, 0.0037, 0.0047, 0.0110},
     {0.0363, 0.4554, 3.7144, 46.0224},
     {0.0069, 0.0100, 0.0201, 0.0369},
     {0.0014, 0.0037, 0.0047, 0.0110}},
    {"Depot",
     "5,466",
     "spot5856",
     {0.0511, 0.1092, 0.2319, 0.5476},
     {0.0009, 0.0035, 0.0042, 0.7433},
     {0.0693, 0.5791, 3.9336, 38.6934},
     {0.0935, 0.1869, 0.3853, 0.7272},
     {0.0009, 0.0035, 0.0042, 0.7433}},
    {"Mobile Phone",
     "13,025",
     "fandisk13k",
     {0.0994, 0.1988, 0.6091, 0.9039},
     {0.0012, 0.0023, 0.8746, 1.9770},
     {0.0656, 0.4883, 3.7207, 49.0143},
     {0.2337, 0.4522, 0.8746, 1.8530},
     {0.0012, 0.0023, 0.6091, 1.9770}},
    {"Dragon",
     "100,207",
     "dragon100k",
     {1.2508, 2.3448, 4.7673, 9.2517},
     {1.7029, 4.0169, 8.6638, 18.0581},
     {0.2887, 0.7611, 4.0288, 40.4131},
     {1.6914, 3.3484, 6.6215, 13.5793},
     {1.7029, 4.0169, 8.6638, 18.0581}},
};

/// Seconds with three digits that matter.
std::string seconds(double ms) {
    const double s = ms / 1e3;
    return fmt::format("{:.{}f}", s, s < 1e-5 ? 8 : s < 1e-4 ? 7 : s < 1e-3 ? 6 : s < 1e-2 ? 5 : 4);
}

std::string ours(std::span<const BenchResult> results, const char* model, std::uint32_t size, std::string_view method) {
    const auto found = std::ranges::find_if(results, [&](const BenchResult& r) {
        return r.model == model && r.size == size && r.method == method && r.threads == 1;
    });
    return found == results.end() ? "-" : seconds(found->ms);
}

std::string printed(double s) {
    return fmt::format("{:.4f}", s);
}

using Row = std::vector<std::string>;

std::string markdown(const std::vector<Row>& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string out;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t i = 0; i < widths.size(); ++i) {
            out += i == 0 ? fmt::format("| {:<{}} |", rows[r][i], widths[i])
                          : fmt::format(" {:>{}} |", rows[r][i], widths[i]);
        }
        out += '\n';
        if (r != 0) continue;
        for (std::size_t i = 0; i < widths.size(); ++i) {
            out += i == 0 ? '|' + std::string(widths[i] + 2, '-') + '|' : std::string(widths[i] + 1, '-') + ":|";
        }
        out += '\n';
    }
    return out;
}

std::vector<std::string> measured_methods(std::span<const BenchResult> results) {
    std::vector<std::string> methods;
    for (const BenchResult& r : results) {
        if (std::ranges::find(methods, r.method) == methods.end()) methods.push_back(r.method);
    }
    return methods;
}

bool is_measured(std::span<const BenchResult> results, const PaperModel& model) {
    return std::ranges::find(results, model.stand_in, &BenchResult::model) != results.end();
}

struct PaperColumn {
    const char* name;
    const double (PaperModel::*times)[kSizeCount];
};

/// One table for the sizes from `first` on.
std::string table(std::span<const BenchResult> results, std::size_t first, std::size_t sizes,
                  std::span<const PaperColumn> columns) {
    const std::vector<std::string> methods = measured_methods(results);
    std::vector<Row> rows(1, {"model (triangles), stand-in"});
    for (std::size_t s = first; s < first + sizes; ++s) {
        for (const PaperColumn& column : columns) rows[0].push_back(fmt::format("{}³ {}", kSizes[s], column.name));
        for (const std::string& method : methods) rows[0].push_back(fmt::format("{}³ **{}**", kSizes[s], method));
    }
    for (const PaperModel& model : kPaper) {
        if (!is_measured(results, model)) continue;
        Row& row = rows.emplace_back(Row{fmt::format("{} ({}), {}", model.name, model.triangles, model.stand_in)});
        for (std::size_t s = first; s < first + sizes; ++s) {
            for (const PaperColumn& column : columns) row.push_back(printed((model.*column.times)[s]));
            for (const std::string& method : methods) {
                row.push_back(ours(results, model.stand_in, kSizes[s], method));
            }
        }
    }
    return markdown(rows);
}

}  // namespace

std::string paper_tables(std::span<const BenchResult> results) {
    if (std::ranges::none_of(kPaper, [&](const PaperModel& model) { return is_measured(results, model); })) {
        std::vector<std::string> stand_ins;
        for (const PaperModel& model : kPaper) stand_ins.emplace_back(model.stand_in);
        return fmt::format("No tables: none of the models that stand in for the paper's is given: {}\n",
                           fmt::join(stand_ins, ", "));
    }
    constexpr PaperColumn kTables2And3[] = {
        {"HA", &PaperModel::ha}, {"VP", &PaperModel::vp}, {"Sramek", &PaperModel::sramek}};
    constexpr PaperColumn kTable4[] = {{"VA", &PaperModel::va}, {"DL", &PaperModel::dl}};
    return fmt::format(
        "Seconds. HA, VP, Sramek, VA and DL are the figures printed in Tables 2 to 4 of Rueda, Ogáyar, Segura, Feito:\n"
        "\"Fast and Simple Hardware Accelerated Voxelizations Using Simplicial Coverings\" (AMD64 2.2 GHz, GeForce "
        "6800).\nColumns with bold heads are xorvox's, measured now, one thread, on models of about as many "
        "triangles.\n\nTable 2\n\n{}\nTable 3\n\n{}\nTable 4\n\n{}",
        table(results, 0, 2, kTables2And3), table(results, 2, 2, kTables2And3), table(results, 0, 4, kTable4));
}

}  // namespace xorvox::tools
