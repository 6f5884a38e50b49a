// What voxelize_solid and voxelize refuse, and that they leave the output alone.

#include <cmath>
#include <limits>

#include "meshes.h"
#include "tests/catch.h"
#include "voxelizer/voxelize.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Call {
    Mesh mesh = box_mesh(glm::dvec3(1.0), glm::dvec3(5.0));
    Lattice lattice = integer_lattice({9, 8, 7});
    std::size_t missing_scratch = 0;
    SolidReport report{};
    bool untouched = false;

    Status run() {
        BitVolume out(9, 8, 7);
        for (std::uint64_t& word : out.view().words) word = 0x5a5a5a5a5a5a5a5a;
        const BitVolume before = out;
        struct alignas(16) Block {
            std::byte bytes[16];
        };
        std::vector<Block> scratch(solid_scratch_bytes(mesh.view(), lattice) / 16 + 1);
        const std::size_t size = solid_scratch_bytes(mesh.view(), lattice) - missing_scratch;
        const Status status = voxelize_solid(
            mesh.view(), lattice, std::as_writable_bytes(std::span(scratch)).first(size), out.view(), &report);
        untouched = out == before;
        return status;
    }
};

bool mentions(const Expected<BitVolume>& result, const std::string& words) {
    if (result) return false;
    INFO(result.error().message);
    CHECK_THAT(result.error().message, Catch::Matchers::Contains(words));
    CHECK(result.error().message.find('\n') == std::string::npos);
    return true;
}

}  // namespace

TEST_CASE("a good call writes its output") {
    Call call;
    CHECK(call.run() == Status::Ok);
    CHECK_FALSE(call.untouched);
}

TEST_CASE("vertices that are not numbers are named and nothing is written") {
    for (const double bad : {kNaN, kInfinity, -kInfinity, 1e308, -1e308}) {
        for (int axis = 0; axis < 3; ++axis) {
            Call call;
            call.mesh.positions[20][axis] = bad;
            call.mesh.positions[31][axis] = bad;
            CHECK(call.run() == Status::OutOfRange);
            CHECK(call.report.bad_vertex == 20);
            CHECK(call.untouched);
        }
    }
}

TEST_CASE("the first vertex beyond 2^30 units of the snapping grid is named") {
    // 9 samples: 2^16 units a voxel, so that the last place is 16,384 voxels from the corner at -½.
    Call call;
    call.mesh.positions[7].x = 16'383.5;
    CHECK(call.run() == Status::Ok);
    call.mesh.positions[7].x = 16'383.5 + 1e-4;
    CHECK(call.run() == Status::OutOfRange);
    CHECK(call.report.bad_vertex == 7);
    CHECK(call.untouched);
    call.mesh.positions[7].x = -16'384.5;
    CHECK(call.run() == Status::Ok);
    call.mesh.positions[7].x = -16'384.5 - 1e-4;
    CHECK(call.run() == Status::OutOfRange);
}

TEST_CASE("vertices that no face uses may be anything") {
    Call call;
    call.mesh.positions.emplace_back(kNaN, 0.0, 1e300);
    CHECK(call.run() == Status::Ok);
}

TEST_CASE("vertex numbers beyond the last vertex are found") {
    Call call;
    call.mesh.indices[17] = static_cast<std::uint32_t>(call.mesh.positions.size());
    CHECK(call.run() == Status::InvalidArgument);
    CHECK(call.report.bad_index == 17);
    CHECK(call.untouched);
}

TEST_CASE("tables of rings and faces that do not fit are refused") {
    Call no_triangles;
    no_triangles.mesh.indices.pop_back();
    CHECK(no_triangles.run() == Status::InvalidArgument);
    CHECK(no_triangles.untouched);

    using Table = std::vector<std::uint32_t>;
    for (const Table& rings : {Table{0, 3, 37}, Table{0, 6, 3, 9}, Table{3, 0}}) {
        Call call;
        call.mesh.ring_starts = rings;
        CHECK(call.run() == Status::InvalidArgument);
        CHECK(call.untouched);
    }
    for (const Table& faces : {Table{0, 13}, Table{0, 2, 1}}) {
        Call call;
        call.mesh.face_starts = faces;
        CHECK(call.run() == Status::InvalidArgument);
        CHECK(call.untouched);
    }
}

TEST_CASE("too little scratch memory is refused") {
    Call call;
    call.missing_scratch = 1;
    CHECK(call.run() == Status::OutOfMemory);
    CHECK(call.untouched);
}

TEST_CASE("scratch memory that is not aligned is refused") {
    const Call call;
    BitVolume out(9, 8, 7);
    alignas(16) std::byte scratch[2048];
    const auto at = [&](std::size_t offset) {
        return voxelize_solid(call.mesh.view(), call.lattice, std::span(scratch).subspan(offset), out.view());
    };
    CHECK(at(8) == Status::InvalidArgument);
    CHECK(at(16) == Status::Ok);
}

TEST_CASE("lattices that are wrong, or of another shape than the output, are refused") {
    Call call;
    call.lattice.nx = 4097;
    CHECK(call.run() == Status::OutOfRange);
    CHECK(call.untouched);
    call.lattice.nx = 0;
    CHECK(call.run() == Status::InvalidArgument);
    CHECK(call.untouched);
    call.lattice = integer_lattice({8, 9, 7});
    CHECK(call.run() == Status::InvalidArgument);
    CHECK(call.untouched);
}

TEST_CASE("voxelize says in words what is wrong") {
    const Mesh mesh = box_mesh(glm::dvec3(1.0), glm::dvec3(5.0));
    const Lattice lattice = integer_lattice({9, 8, 7});

    Mesh far = mesh;
    far.positions[12] = {1.5, -2e9, 3.0};
    CHECK(mentions(voxelize(far.view(), lattice), "vertex 12 (counted from 0) at (1.5, -2000000000, 3)"));
    far.positions[12].z = kNaN;
    CHECK(mentions(voxelize(far.view(), lattice), "nan"));

    Mesh wrong = mesh;
    wrong.indices[5] = 1000;
    CHECK(mentions(voxelize(wrong.view(), lattice), "uses vertex 1000 (entry 5"));
    wrong = mesh;
    wrong.ring_starts = {0, 4, 2};
    CHECK(mentions(voxelize(wrong.view(), lattice), "tables do not fit together"));

    CHECK(mentions(voxelize(mesh.view(), integer_lattice({0, 8, 7})), "0 x 8 x 7"));
    CHECK(mentions(voxelize(mesh.view(), integer_lattice({9, 5000, 7})), "too large"));
    CHECK(mentions(voxelize(mesh.view(), integer_lattice({9, 8, 7}, glm::dvec3(-1.0))), "pitches must be positive"));
    const std::vector<glm::dvec2> plan(3);
    CHECK(mentions(voxelize(mesh.view(), {.nx = 9, .ny = 8, .nz = 7, .plan = plan}), "3 plan, 0 z0 and 0 z entries"));
}

TEST_CASE("a volume larger than the machine's memory is refused before it is asked for") {
    const std::vector<glm::dvec2> plan(std::size_t{1} << 24);
    std::vector<double> z;
    for (int k = 0; k < 4096; ++k) z.push_back(k);
    // One column a row, so that each takes a word: 512 GiB.
    const Lattice lattice{.nx = 1, .ny = 1u << 24, .nz = 4096, .plan = plan, .z = z};
    CHECK(mentions(voxelize(MeshView{}, lattice), "512.0 GiB"));
}
