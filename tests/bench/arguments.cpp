#include "tests/bench/arguments.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/lattice.h"

namespace xorvox::bench {

Expected<Arguments> parse_arguments(int argc, char** argv, const std::string& sizes, bool has_json) {
    Arguments arguments;
    std::string size_list = sizes;
    std::vector<std::string> paths;
    arguments.usage = "usage: " + std::string(argv[0]) + " MESH... [--sizes N,N]" + (has_json ? " [--json]" : "");
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (word == "--help" || word == "-h") {
            arguments.help = true;
            return arguments;
        }
        if (word == "--json" && has_json) {
            arguments.json = true;
        } else if (word == "--sizes" && i + 1 < argc) {
            size_list = argv[++i];
        } else if (word.starts_with('-')) {
            return fail(fmt::format("'{}' is not understood; {}", word, arguments.usage));
        } else {
            paths.emplace_back(word);
        }
    }
    if (paths.empty()) return fail("no mesh is given; " + arguments.usage);
    Expected<std::vector<std::uint32_t>> numbers = tools::parse_numbers("--sizes", size_list, kMaxLatticeSide);
    if (!numbers) return tl::unexpected(numbers.error());
    arguments.sizes = std::move(*numbers);
    Expected<std::vector<tools::Model>> models = tools::read_models(paths);
    if (!models) return tl::unexpected(models.error());
    arguments.models = std::move(*models);
    return arguments;
}

}  // namespace xorvox::bench
