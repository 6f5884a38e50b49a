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
        if (std::ranges::find(numbers, number) == numbers.end()) numbers.push_back(number);
    }
    return numbers;
}

namespace {

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

/// Gives new names to models that share theirs.
template <class Name>
void rename_namesakes(std::vector<Model>& models, const Name& name) {
    std::vector<Model*> namesakes;
    for (Model& model : models) {
        if (std::ranges::count(models, model.name, &Model::name) > 1) namesakes.push_back(&model);
    }
    for (Model* const model : namesakes) model->name = name(*model);
}

std::string name_with_folder(const Model& model) {
    const std::filesystem::path path = std::filesystem::absolute(model.path);
    return (path.parent_path().filename() / path.stem()).string();
}

}  // namespace

Expected<std::vector<Model>> read_models(const std::vector<std::string>& paths) {
    std::vector<Model> models;
    for (const std::string& path : paths) {
        if (std::ranges::find(models, path, &Model::path) != models.end()) continue;
        Expected<Model> model = read_model(path);
        if (!model) return tl::unexpected(model.error());
        models.push_back(std::move(*model));
    }
    rename_namesakes(models, name_with_folder);
    rename_namesakes(models, [](const Model& model) { return model.path; });
    return models;
}

}  // namespace xorvox::tools
