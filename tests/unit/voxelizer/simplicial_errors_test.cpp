// What the simplicial covering refuses, and that it leaves the outputs alone.

#include <limits>

#include "meshes.h"
#include "simplicial_calls.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

struct Call {
    Mesh mesh = box_mesh(glm::dvec3(1.0), glm::dvec3(5.0));
    Lattice lattice = integer_lattice({9, 8, 7});
    SimplicialOptions options{};
    std::size_t missing_scratch = 0;
    std::size_t scratch_offset = 0;
    SimplicialReport report{};

    /// The Status of both functions, which must agree, and must leave their output alone unless they succeed.
    Status run() {
        BitVolume bits(9, 8, 7);
        for (std::uint64_t& word : bits.view().words) word = 0x5a5a5a5a5a5a5a5a;
        const BitVolume bits_before = bits;
        std::vector<std::int16_t> sums(9 * 8 * 7, 77);
        const std::vector<std::int16_t> sums_before = sums;
        SimplicialScratch scratch(mesh.view());
        const auto memory =
            scratch.bytes().subspan(scratch_offset, simplicial_scratch_bytes(mesh.view()) - missing_scratch);
        SimplicialReport sums_report;
        const Status status = voxelize_simplicial(mesh.view(), lattice, options, memory, bits.view(), &report);
        CHECK(sum_inclusions(mesh.view(), lattice, options, memory, sums, &sums_report) == status);
        CHECK(sums_report.fault == report.fault);
        CHECK(sums_report.bad_vertex == report.bad_vertex);
        CHECK(sums_report.bad_index == report.bad_index);
        CHECK((bits == bits_before) == (status != Status::Ok));
        CHECK((sums == sums_before) == (status != Status::Ok));
        CHECK((report.fault != SimplicialFault::None) == (status == Status::OutOfRange));
        return status;
    }
};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("a good call of the covering writes its outputs") {
    CHECK(Call{}.run() == Status::Ok);
}

TEST_CASE("an apex beyond 2^30 units of the snapping grid is refused and told from a vertex") {
    // 9 samples: 2^16 units a sample, so that the last place is 16,384 samples from the corner at -½.
    for (int axis = 0; axis < 3; ++axis) {
        Call call;
        glm::dvec3 apex(4.0);
        apex[axis] = 16'383.5;
        call.options.apex = apex;
        CHECK(call.run() == Status::Ok);
        for (const double bad : {16'383.5 + 1e-4, -16'384.5 - 1e-4, kNaN, 1e308}) {
            apex[axis] = bad;
            call.options.apex = apex;
            CHECK(call.run() == Status::OutOfRange);
            CHECK(call.report.fault == SimplicialFault::Apex);
        }
    }
}

TEST_CASE("the covering names the first vertex beyond the grid that a face uses") {
    Call call;
    call.mesh.positions[20].y = kNaN;
    call.mesh.positions[31].x = 1e9;
    CHECK(call.run() == Status::OutOfRange);
    CHECK(call.report.fault == SimplicialFault::Vertex);
    CHECK(call.report.bad_vertex == 20);

    Call unused;
    unused.mesh.positions.emplace_back(kNaN, 0.0, 1e300);
    CHECK(unused.run() == Status::Ok);
}

TEST_CASE("the covering refuses table lattices as unsupported") {
    Call call;
    const std::vector<glm::dvec2> plan(9 * 8);
    const std::vector<double> z{0, 1, 2, 3, 4, 5, 6};
    call.lattice.plan = plan;
    call.lattice.z = z;
    CHECK(call.run() == Status::Unsupported);

    BitVolume out(9, 8, 7);
    SimplicialCovering covering;
    CHECK(covering.start(call.lattice, glm::dvec3(0.0), Axis::Y, out.view()) == Status::Unsupported);
}

TEST_CASE("the covering refuses lattices that are wrong, or of another shape than the output") {
    Call call;
    call.lattice.nx = 4097;
    CHECK(call.run() == Status::OutOfRange);
    CHECK(call.report.fault == SimplicialFault::Lattice);
    call.lattice.nx = 0;
    CHECK(call.run() == Status::InvalidArgument);
    call.lattice = integer_lattice({8, 8, 7});
    CHECK(call.run() == Status::InvalidArgument);
}

TEST_CASE("the covering refuses meshes that are not well formed") {
    Call call;
    call.mesh.indices[17] = static_cast<std::uint32_t>(call.mesh.positions.size());
    CHECK(call.run() == Status::InvalidArgument);
    CHECK(call.report.bad_index == 17);
    call = Call{};
    call.mesh.ring_starts = {0, 6, 3, 9};
    CHECK(call.run() == Status::InvalidArgument);
}

TEST_CASE("the covering refuses scratch memory that is too small or not aligned") {
    Call call;
    call.missing_scratch = 1;
    CHECK(call.run() == Status::OutOfMemory);
    call = Call{};
    call.scratch_offset = 8;
    CHECK(call.run() == Status::InvalidArgument);
}

TEST_CASE("a covering that cannot start leaves the volume alone") {
    const Lattice lattice = integer_lattice({9, 8, 7});
    BitVolume out(9, 8, 7);
    out.view().flip(3, 3, 3);
    SimplicialCovering covering;
    CHECK(covering.start(lattice, {0.0, 1e9, 0.0}, Axis::Y, out.view()) == Status::OutOfRange);
    CHECK(covering.start(lattice, {0.0, kNaN, 0.0}, Axis::Y, out.view()) == Status::OutOfRange);
    CHECK(covering.start(integer_lattice({9, 9, 7}), glm::dvec3(0.0), Axis::Y, out.view()) == Status::InvalidArgument);
    CHECK(covering.start(integer_lattice({0, 9, 7}), glm::dvec3(0.0), Axis::Y, out.view()) == Status::InvalidArgument);
    CHECK(out.count() == 1);
}
