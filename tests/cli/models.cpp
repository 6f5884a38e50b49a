// Counts of an exact kernel on real models, which stand beside the project and are not part of it.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;

namespace {

struct Count {
    const char* model;
    const char* size;
    long set;
    long tolerance;
};

constexpr Count kCounts[] = {
    {"bunny70k.ply", "64", 47'815, 0},     {"spot5856.ply", "64", 33'892, 0},  {"armadillo86k.ply", "64", 16'418, 0},
    {"dragon871k.ply", "128", 106'314, 2}, {"tiecube12.obj", "33", 32'768, 0},
};

const std::vector<std::string> kMethods[] = {
    {"--method", "reference"},
    {"--method", "column"},
    {"--method", "simplicial"},
    {"--method", "simplicial", "--apex", "0,0,0"},
};

}  // namespace

TEST_CASE("models set as many voxels as an exact kernel counts, by every method", "[cli][models]") {
    const std::filesystem::path models = std::filesystem::path(XORVOX_SOURCE_DIR) / ".." / "shared" / "models";
    if (!std::filesystem::exists(models)) XORVOX_SKIP("the models of ../shared/models are not here");
    const Folder folder;
    for (const Count& count : kCounts) {
        CAPTURE(count.model);
        std::string mesh = (models / count.model).string();
        if (!std::filesystem::exists(mesh)) {
            const std::string unpacked = folder.path(count.model);
            REQUIRE(std::system(("zstd -q -d '" + mesh + ".zst' -o '" + unpacked + "'").c_str()) == 0);
            mesh = unpacked;
        }
        const std::string out = folder.path("out.bits");
        std::string bits;
        for (const std::vector<std::string>& method : kMethods) {
            CAPTURE(method);
            std::vector<std::string> arguments{"voxelize", mesh, "--size", count.size, "-o", out, "--json"};
            arguments.insert(arguments.end(), method.begin(), method.end());
            const Outcome outcome = run_program(arguments);
            REQUIRE(outcome.status == 0);
            const std::size_t at = outcome.out.find("\"set\": ");
            REQUIRE(at != std::string::npos);
            CHECK(std::labs(std::stol(outcome.out.substr(at + 7)) - count.set) <= count.tolerance);
            if (bits.empty()) bits = read_file(out);
            CHECK(read_file(out) == bits);
        }
    }
}
