#include "voxelizer/lattice.h"

#include <limits>
#include <vector>

#include "tests/catch.h"

using namespace xorvox;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Lattice regular(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) {
    return {.nx = nx, .ny = ny, .nz = nz};
}

}  // namespace

TEST_CASE("regular lattices from 1 to 4096 a side are valid") {
    CHECK(validate(regular(1, 1, 1)) == Status::Ok);
    CHECK(validate(regular(4096, 4096, 4096)) == Status::Ok);
    CHECK(validate(regular(4097, 1, 1)) == Status::OutOfRange);
    CHECK(validate(regular(1, 4097, 1)) == Status::OutOfRange);
    CHECK(validate(regular(1, 1, 4097)) == Status::OutOfRange);
    CHECK(validate(regular(0xffffffff, 0xffffffff, 1)) == Status::OutOfRange);
    CHECK(validate(regular(0, 1, 1)) == Status::InvalidArgument);
    CHECK(validate(regular(1, 0, 1)) == Status::InvalidArgument);
    CHECK(validate(regular(1, 1, 0)) == Status::InvalidArgument);
}

TEST_CASE("pitches must be positive and everything finite") {
    for (const double bad : {0.0, -1.0, kNaN, HUGE_VAL}) {
        for (int axis = 0; axis < 3; ++axis) {
            Lattice lattice = regular(2, 3, 4);
            lattice.pitch[axis] = bad;
            CHECK(validate(lattice) == Status::InvalidArgument);
        }
    }
    Lattice lattice = regular(2, 3, 4);
    lattice.origin.y = kNaN;
    CHECK(validate(lattice) == Status::InvalidArgument);
    lattice = regular(2, 3, 4);
    lattice.pitch.z = 1e308;
    CHECK(validate(lattice) == Status::OutOfRange);
}

TEST_CASE("tables must have an entry for each column and layer") {
    const std::vector<glm::dvec2> plan(6);
    const std::vector<double> z0(6);
    const std::vector<double> z{0.0, 1.0};
    const Lattice good{.nx = 2, .ny = 3, .nz = 2, .plan = plan, .z0 = z0, .z = z};
    CHECK(validate(good) == Status::Ok);
    Lattice lattice = good;
    lattice.z0 = {};
    CHECK(validate(lattice) == Status::Ok);
    lattice.z0 = lattice.z;
    CHECK(validate(lattice) == Status::InvalidArgument);
    lattice = good;
    lattice.plan = lattice.plan.first(5);
    CHECK(validate(lattice) == Status::InvalidArgument);
    lattice = good;
    lattice.z = lattice.z.first(1);
    CHECK(validate(lattice) == Status::InvalidArgument);
    lattice = good;
    lattice.plan = {};
    CHECK(validate(lattice) == Status::InvalidArgument);
}

TEST_CASE("tables must be finite, and z increasing") {
    const auto status = [](glm::dvec2 place, double base, double top) {
        const std::vector<glm::dvec2> plan{{0.0, 0.0}, place};
        const std::vector<double> z0{0.0, base};
        const std::vector<double> z{0.0, top};
        return validate({.nx = 2, .ny = 1, .nz = 2, .plan = plan, .z0 = z0, .z = z});
    };
    CHECK(status({1.0, 0.0}, 0.0, 1.0) == Status::Ok);
    CHECK(status({kNaN, 0.0}, 0.0, 1.0) == Status::InvalidArgument);
    CHECK(status({1.0, HUGE_VAL}, 0.0, 1.0) == Status::InvalidArgument);
    CHECK(status({1.0, 0.0}, kNaN, 1.0) == Status::InvalidArgument);
    CHECK(status({1.0, 0.0}, 0.0, kNaN) == Status::InvalidArgument);
    CHECK(status({1.0, 0.0}, 0.0, 0.0) == Status::InvalidArgument);
    CHECK(status({1.0, 0.0}, 0.0, -1.0) == Status::InvalidArgument);
    CHECK(status({1.0, 0.0}, 1.5e308, 1e308) == Status::OutOfRange);
}

TEST_CASE("a table whose heights are lost beside z0 is out of range") {
    const auto status = [](std::vector<double> z0, std::vector<double> z) {
        const std::vector<glm::dvec2> plan(z0.size());
        return validate({.nx = static_cast<std::uint32_t>(z0.size()),
                         .ny = 1,
                         .nz = static_cast<std::uint32_t>(z.size()),
                         .plan = plan,
                         .z0 = z0,
                         .z = z});
    };
    CHECK(status({1e17}, {0.0, 2000.0}) == Status::Ok);
    CHECK(status({1e20}, {0.0, 2000.0}) == Status::OutOfRange);
    CHECK(status({-1e20}, {0.0, 1000.0, 2000.0}) == Status::OutOfRange);
    CHECK(status({1e20}, {0.0}) == Status::Ok);
    CHECK(status({1e20, 2e20}, {0.0, 2000.0}) == Status::Ok);  // The box is high without the table.
    CHECK(status({0.1}, {-0.3, 0.7}) == Status::Ok);           // Rounding by a last bit is no loss.
    const double most = std::numeric_limits<double>::max();
    CHECK(status({0x1p970}, {-most / 2, 0x1p1023}) == Status::OutOfRange);  // The box is finite, the table's rise not.
}

TEST_CASE("a table lattice may have more than 4096 columns a side, but 2^24 in all") {
    const std::vector<glm::dvec2> plan(5000);
    const std::vector<double> z{0.0};
    CHECK(validate({.nx = 5000, .ny = 1, .nz = 1, .plan = plan, .z = z}) == Status::Ok);
    CHECK(validate({.nx = 1u << 24, .ny = 2, .nz = 1, .plan = plan, .z = z}) == Status::OutOfRange);
}

TEST_CASE("sample bounds hold the outermost samples") {
    const Lattice lattice{.nx = 4, .ny = 2, .nz = 3, .origin = {1.0, 2.0, 3.0}, .pitch = {2.0, 4.0, 6.0}};
    CHECK(sample_bounds(lattice).lower == glm::dvec3(2.0, 4.0, 6.0));
    CHECK(sample_bounds(lattice).upper == glm::dvec3(8.0, 8.0, 18.0));
    const std::vector<glm::dvec2> plan{{5.0, -1.0}, {-2.0, 3.0}};
    const std::vector<double> z0{1.0, -4.0};
    const std::vector<double> z{2.0, 3.0};
    const Lattice table{.nx = 2, .ny = 1, .nz = 2, .plan = plan, .z0 = z0, .z = z};
    CHECK(sample_bounds(table).lower == glm::dvec3(-2.0, -1.0, -2.0));
    CHECK(sample_bounds(table).upper == glm::dvec3(5.0, 3.0, 4.0));
}
