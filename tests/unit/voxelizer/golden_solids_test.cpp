// The bits of models, as numbers that stay: another compiler, machine or kernel that differs shows here.

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "engines.h"
#include "models.h"
#include "tests/catch.h"
#include "voxelizer/fit.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

const std::filesystem::path kSource = XORVOX_SOURCE_DIR;

/// FNV-1a over the words of a volume, a byte at a time, lowest first.
std::uint64_t hash_of(const BitVolume& volume) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const std::uint64_t word : volume.view().words) {
        for (int shift = 0; shift < 64; shift += 8) hash = (hash ^ (word >> shift & 0xff)) * 0x100000001b3;
    }
    return hash;
}

struct Golden {
    std::uint32_t size;
    std::string line;
};

/// tests/golden/solids.txt, by model.
std::map<std::string, std::vector<Golden>> read_golden() {
    std::map<std::string, std::vector<Golden>> golden;
    std::ifstream file(kSource / "tests/golden/solids.txt");
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream words(line);
        std::string model;
        std::uint32_t size = 0;
        words >> model >> size;
        golden[model].push_back({size, line});
    }
    return golden;
}

void check_model(const std::string& model, const Mesh& mesh, const std::vector<Golden>& golden) {
    const auto box = bounds(mesh.view());
    REQUIRE(box);
    for (const SolidOptions& options : all_engines()) {
        SolidVoxelizer engine(options);
        REQUIRE(engine.set_mesh(mesh.view()) == Status::Ok);
        for (const Golden& expected : golden) {
            INFO(name_of(options));
            const auto lattice = fit_cube(*box, expected.size);
            REQUIRE(lattice);
            BitVolume volume(*lattice);
            REQUIRE(engine.set_lattice(*lattice) == Status::Ok);
            REQUIRE(engine.solid(volume.view()) == Status::Ok);
            CHECK(fmt::format("{} {} {} {:016x}", model, expected.size, volume.count(), hash_of(volume)) ==
                  expected.line);
        }
    }
}

}  // namespace

TEST_CASE("the demo's model has its golden bits at every size, for every kernel") {
    const auto golden = read_golden();
    REQUIRE(golden.contains("duck"));
    const auto mesh = io::read_mesh((kSource / "examples/duck.ply").string());
    REQUIRE(mesh);
    check_model("duck", *mesh, golden.at("duck"));
}

TEST_CASE("models have their golden bits at every size, for every kernel", "[models]") {
    if (!has_models()) XORVOX_SKIP("the models of ../shared/models are not here");
    const auto golden = read_golden();
    CHECK(golden.size() > 5);
    for (const auto& [model, lines] : golden) {
        if (model != "duck") check_model(model, read_model(model), lines);
    }
}
