// The covering of real models, which stand beside the project and are not part of it.

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "oracle.h"
#include "simplicial_calls.h"
#include "tests/catch.h"
#include "voxelizer/fit.h"
#include "voxelizer/io/mesh_file.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

std::filesystem::path models() {
    return std::filesystem::path(XORVOX_SOURCE_DIR) / ".." / "shared" / "models";
}

/// The model, which is packed by zstd.
Mesh read_model(const std::string& name) {
    const std::string command = "zstd -q -d -c '" + (models() / (name + ".ply.zst")).string() + "'";
    std::FILE* const pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::string bytes;
    std::array<char, 65536> part;
    while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe)) bytes.append(part.data(), n);
    REQUIRE(pclose(pipe) == 0);
    auto mesh = io::parse_ply(bytes, name);
    REQUIRE(mesh);
    return std::move(*mesh);
}

}  // namespace

TEST_CASE("the covering of models gives the columns' bits", "[models]") {
    if (!std::filesystem::exists(models())) XORVOX_SKIP("the models of ../shared/models are not here");
    struct Case {
        const char* model;
        std::vector<SimplicialOptions> options;
    };
    const std::vector<SimplicialOptions> all{{.apex = {}, .sweep = Axis::X},
                                             {.apex = {}, .sweep = Axis::Y},
                                             {.apex = {}, .sweep = Axis::Z},
                                             {.apex = glm::dvec3(100.0, -20.0, 3.0), .sweep = Axis::Y}};
    for (const auto& [model, options] :
         {Case{"spot5856", all}, Case{"bunny70k", all}, Case{"dragon871k", {SimplicialOptions{}}}}) {
        CAPTURE(model);
        const Mesh mesh = read_model(model);
        const auto box = bounds(mesh.view());
        REQUIRE(box);
        const auto lattice = fit_cube(*box, 64);
        REQUIRE(lattice);
        const BitVolume expected = voxelized(mesh.view(), *lattice);
        for (const SimplicialOptions& option : options) {
            CAPTURE(static_cast<int>(option.sweep), option.apex.has_value());
            CHECK(difference(covered(mesh.view(), *lattice, option), expected) == "");
        }
    }
}

TEST_CASE("the signed sums of a well oriented model are its parity", "[models]") {
    if (!std::filesystem::exists(models())) XORVOX_SKIP("the models of ../shared/models are not here");
    const Mesh mesh = read_model("spot5856");
    const auto box = bounds(mesh.view());
    REQUIRE(box);
    const auto lattice = fit_cube(*box, 64);
    REQUIRE(lattice);
    const auto counted = sums(mesh.view(), *lattice);
    CHECK(inspect_inclusions(counted).is_consistent());
    BitVolume bits(*lattice);
    REQUIRE(positive_inclusions(counted, bits.view()) == Status::Ok);
    CHECK(difference(bits, voxelized(mesh.view(), *lattice)) == "");
}
