#include "tests/bench/arguments.h"

#include <string_view>
#include <utility>

#include "voxelizer/lattice.h"

namespace xorvox::bench {

Expected<Arguments> parse_arguments(int argc, char** argv, const std::string& sizes) {
    Arguments arguments;
    std::string size_list = sizes;
    std::vector<std::string> paths;
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (word == "--json") {
            arguments.json = true;
        } else if (word == "--sizes" && i + 1 < argc) {
            size_list = argv[++i];
        } else if (word.starts_with('-')) {
            return fail("usage: " + std::string(argv[0]) + " MESH... [--sizes N,N] [--json]");
        } else {
            paths.emplace_back(word);
        }
    }
    if (paths.empty()) return fail("no mesh is given");
    Expected<std::vector<std::uint32_t>> numbers = tools::parse_numbers("--sizes", size_list, kMaxLatticeSide);
    if (!numbers) return tl::unexpected(numbers.error());
    arguments.sizes = std::move(*numbers);
    for (const std::string& path : paths) {
        Expected<tools::Model> model = tools::read_model(path);
        if (!model) return tl::unexpected(model.error());
        arguments.models.push_back(std::move(*model));
    }
    return arguments;
}

}  // namespace xorvox::bench
