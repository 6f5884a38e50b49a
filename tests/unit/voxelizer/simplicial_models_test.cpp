// The covering of real models, which stand beside the project and are not part of it.

#include <vector>

#include "models.h"
#include "oracle.h"
#include "simplicial_calls.h"
#include "tests/catch.h"
#include "voxelizer/fit.h"

using namespace xorvox;
using namespace xorvox::test;

TEST_CASE("the covering of models gives the columns' bits", "[models]") {
    if (!has_models()) XORVOX_SKIP("the models of ../shared/models are not here");
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
    if (!has_models()) XORVOX_SKIP("the models of ../shared/models are not here");
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
