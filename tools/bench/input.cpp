#include "tools/bench/input.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "tools/mesh_input.h"
#include "voxelizer/fit.h"

namespace xorvox::tools {

std::vector<std::string> split(std::string_view text) {
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        parts.emplace_back(text.substr(at, comma - at));
        at = comma + 1;
    }
    return parts;
}

Expected<std::vector<std::uint32_t>> parse_numbers(std::string_view option, std::string_view text, std::uint32_t most) {
    std::vector<std::uint32_t> numbers;
    for (const std::string& part : split(text)) {
        std::uint32_t number = 0;
        const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), number);
        if (error != std::errc() || stop != part.data() + part.size() || number < 1 || number > most) {
            return fail(fmt::format("{} has '{}'; it takes whole numbers from 1 to {} with commas between them", option,
                                    part, most));
        }
        numbers.push_back(number);
    }
    return numbers;
}

Expected<Model> read_model(const std::string& path) {
    Expected<MeshInput> input = read_solid({.path = path});
    if (!input) return tl::unexpected(input.error());
    const Expected<Box> box = bounds(input->mesh.view());
    if (!box) return fail(path + ": " + box.error().message);
    for (const std::uint32_t size : {1u, kMaxLatticeSide}) {
        if (const auto lattice = fit_cube(*box, size); !lattice) return fail(path + ": " + lattice.error().message);
    }
    return Model{std::filesystem::path(path).stem().string(), path, std::move(input->mesh), input->report.triangles,
                 *box};
}

}  // namespace xorvox::tools
