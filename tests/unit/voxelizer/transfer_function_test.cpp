#include "voxelizer/transfer_function.h"

#include <string>

#include "tests/catch.h"

using namespace xorvox;

namespace {

Expected<glm::dvec3> parse_color(std::string_view text) {
    if (text == "black") return glm::dvec3(0.0);
    if (text == "white") return glm::dvec3(1.0);
    if (text == "red") return glm::dvec3(1.0, 0.0, 0.0);
    return fail("no such colour");
}

std::string refusal(std::string_view text) {
    const auto transfer = TransferFunction::parse(text, parse_color);
    return transfer ? std::string() : transfer.error().message;
}

}  // namespace

TEST_CASE("transfer: between two stops in proportion, beyond them as there") {
    const auto transfer = TransferFunction::parse("-1:black,0.5:red,1.5:white", parse_color);
    REQUIRE(transfer);
    CHECK(transfer->at(-2.0) == glm::vec3(0.0f));
    CHECK(transfer->at(-1.0) == glm::vec3(0.0f));
    CHECK(transfer->at(-0.25) == glm::vec3(0.5f, 0.0f, 0.0f));
    CHECK(transfer->at(0.5) == glm::vec3(1.0f, 0.0f, 0.0f));
    CHECK(transfer->at(1.0) == glm::vec3(1.0f, 0.5f, 0.5f));
    CHECK(transfer->at(1e30) == glm::vec3(1.0f));
}

TEST_CASE("transfer: opacity dims, and what is clear lends no colour") {
    const auto transfer = TransferFunction::parse("0:white:0,1:red:0.5", parse_color);
    REQUIRE(transfer);
    CHECK(transfer->at(0.0) == glm::vec3(0.0f));
    CHECK(transfer->at(0.5) == glm::vec3(0.25f, 0.0f, 0.0f));
    CHECK(transfer->at(1.0) == glm::vec3(0.5f, 0.0f, 0.0f));
    const auto one = TransferFunction::parse("3:white", parse_color);
    REQUIRE(one);
    CHECK(one->at(-5.0) == glm::vec3(1.0f));
}

TEST_CASE("transfer: mistakes are told with their stop") {
    CHECK_THAT(refusal(""), Catch::Contains("a stop VALUE:COLOR is missing"));
    CHECK_THAT(refusal("0:black,"), Catch::Contains("is missing"));
    CHECK_THAT(refusal("0:black,x:white"), Catch::Contains("stop 2") && Catch::Contains("x:white"));
    CHECK_THAT(refusal("0"), Catch::Contains("VALUE:COLOR"));
    CHECK_THAT(refusal("nan:black"), Catch::Contains("VALUE:COLOR"));
    CHECK_THAT(refusal("0:blue"), Catch::Contains("stop 1") && Catch::Contains("no such colour"));
    CHECK_THAT(refusal("0:black:2"), Catch::Contains("opacity 2"));
    CHECK_THAT(refusal("0:black:0.5:1"), Catch::Contains("opacity 0.5:1"));
    CHECK_THAT(refusal("1:black,1:white"), Catch::Contains("stop 2") && Catch::Contains("increase"));
    std::string many = "0:black";
    for (int n = 1; n <= 256; ++n) many += "," + std::to_string(n) + ":white";
    CHECK_THAT(refusal(many), Catch::Contains("more than 256"));
}
