// voxelize() with options, and failures in words.
#include "voxelizer/voxelize.h"

#include <algorithm>
#include <stop_token>
#include <string>
#include <vector>

#include "meshes.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

const Mesh kBox = box_mesh(glm::dvec3(1.0), glm::dvec3(5.0));
const Lattice kLattice = integer_lattice({9, 8, 7});

std::string words(Status status, const Region& region = whole(kLattice), const Mesh& mesh = kBox,
                  const SolidReport& report = {}) {
    return describe_failure(status, mesh.view(), kLattice, region, report).message;
}

}  // namespace

TEST_CASE("voxelize gives the same bits and report for every kernel and number of threads") {
    SolidReport expected_report;
    const auto expected = voxelize(kBox.view(), kLattice, &expected_report);
    REQUIRE(expected);
    CHECK(expected->count() > 0);
    for (const Kernel kernel : available_kernels()) {
        for (const unsigned threads : {1u, 2u, 3u}) {
            SolidReport report;
            const auto volume = voxelize(kBox.view(), kLattice, {.kernel = kernel, .threads = threads}, &report);
            REQUIRE(volume);
            CHECK(*volume == *expected);
            CHECK(report.crossings == expected_report.crossings);
        }
    }
}

TEST_CASE("a stop request is a failure of its own") {
    std::stop_source stop;
    stop.request_stop();
    const auto volume = voxelize(kBox.view(), kLattice, {.stop = stop.get_token()});
    REQUIRE_FALSE(volume);
    CHECK_THAT(volume.error().message, Catch::Matchers::Contains("stopped"));
}

TEST_CASE("progress runs from its begin to its end and never back") {
    std::vector<double> told;
    REQUIRE(voxelize(kBox.view(), kLattice, {.progress = [&](double part) { told.push_back(part); }}));
    REQUIRE_FALSE(told.empty());
    CHECK(std::is_sorted(told.begin(), told.end()));
    CHECK(told.front() >= 0.0);
    CHECK(told.back() == 1.0);
}

TEST_CASE("failures are told in one line that names what is wrong") {
    using Catch::Matchers::Contains;
    CHECK_THAT(words(Status::Cancelled), Contains("stopped"));
    CHECK_THAT(words(Status::OutOfMemory), Contains("memory") && Contains("smaller"));
    CHECK_THAT(words(Status::Unsupported), Contains("regular"));
    CHECK_THAT(words(Status::InvalidArgument, {{0, 0, 5}, {9, 8, 3}}),
               Contains("region of 9 x 8 x 3") && Contains("(0, 0, 5)") && Contains("9 x 8 x 7"));
    CHECK_THAT(words(Status::InvalidArgument, {{0, 0, 5}, {9, 0, 1}}), Contains("9 x 0 x 1"));
    CHECK_THAT(words(Status::InvalidArgument, {{0, 0, 5}, {9, 8, 2}}), Contains("another shape than 9 x 8 x 2"));
    CHECK_THAT(words(Status::OutOfRange, whole(kLattice), kBox, {.bad_vertex = 3}), Contains("vertex 3"));
    Mesh wrong = kBox;
    wrong.indices[4] = 999;
    CHECK_THAT(words(Status::InvalidArgument, whole(kLattice), wrong), Contains("uses vertex 999 (entry 4"));
    CHECK(words(Status::InvalidArgument).find('\n') == std::string::npos);
}
