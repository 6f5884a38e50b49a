#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/unit/voxelizer/allocations.h"
#include "voxelizer/expression.h"
#include "voxelizer/noise.h"

using namespace xorvox;

namespace {

Expression parse(const std::string& text) {
    auto expression = Expression::parse(text);
    INFO(text);
    if (!expression) FAIL(expression.error().message);
    return *expression;
}

glm::vec3 at(const std::string& text, const glm::vec3& point = {0.25f, 0.5f, 0.75f}) {
    glm::vec3 value(-99.0f);
    parse(text).evaluate({&point, 1}, {&value, 1});
    return value;
}

float scalar(const std::string& text, const glm::vec3& point = {0.25f, 0.5f, 0.75f}) {
    CHECK_FALSE(parse(text).is_vector());
    return at(text, point).x;
}

glm::vec3 vector(const std::string& text) {
    CHECK(parse(text).is_vector());
    return at(text);
}

std::vector<glm::vec3> random_points(std::size_t count) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(0.0f, 1.0f);
    std::vector<glm::vec3> points(count);
    for (glm::vec3& point : points) point = {place(random), place(random), place(random)};
    return points;
}

}  // namespace

TEST_CASE("an expression reads numbers, constants and coordinates") {
    CHECK(scalar("2") == 2.0f);
    CHECK(scalar(" .5 ") == 0.5f);
    CHECK(scalar("1.e2") == 100.0f);
    CHECK(scalar("25e-2") == 0.25f);
    CHECK(scalar("pi") == 3.14159265f);
    CHECK(scalar("tau") == 6.28318531f);
    CHECK(scalar("x") == 0.25f);
    CHECK(scalar("y\n") == 0.5f);
    CHECK(scalar("\tz") == 0.75f);
    CHECK(vector("p") == glm::vec3(0.25f, 0.5f, 0.75f));
}

TEST_CASE("operators bind as in C, and from left to right") {
    CHECK(scalar("1 + 2 * 3") == 7.0f);
    CHECK(scalar("(1 + 2) * 3") == 9.0f);
    CHECK(scalar("10 - 4 - 3") == 3.0f);
    CHECK(scalar("24 / 4 / 3") == 2.0f);
    CHECK(scalar("24 / 4 * 3") == 18.0f);
    CHECK(scalar("-2 * -3 - -1") == 7.0f);
    CHECK(scalar("--2") == 2.0f);
    CHECK(scalar("-p.y + 1") == 0.5f);
    CHECK(scalar("1 + 1 < 3 ? 5 : 6") == 5.0f);
    CHECK(scalar("x < y && y < z ? 1 : 2") == 1.0f);
    CHECK(scalar("x > y && y > z || x < z ? 1 : 2") == 1.0f);
    CHECK(scalar("x > y && (y > z || x < z) ? 1 : 2") == 2.0f);
    CHECK(scalar("!(x < y) ? 1 : 2") == 2.0f);
}

TEST_CASE("choices chain to the right, and may be between truth values") {
    const char* text = "x < 0.2 ? 1 : x < 0.4 ? 2 : 3";
    CHECK(scalar(text, {0.1f, 0, 0}) == 1.0f);
    CHECK(scalar(text, {0.3f, 0, 0}) == 2.0f);
    CHECK(scalar(text, {0.5f, 0, 0}) == 3.0f);
    CHECK(scalar("(x < y ? y < z : y > z) ? 1 : 2") == 1.0f);
    CHECK(vector("x < y ? p : 1") == glm::vec3(0.25f, 0.5f, 0.75f));
    CHECK(vector("x > y ? p : 1") == glm::vec3(1.0f));
}

TEST_CASE("comparisons are those of numbers") {
    const struct {
        const char* symbol;
        bool less, equal, greater;
    } comparisons[] = {{"<", true, false, false}, {"<=", true, true, false},  {">", false, false, true},
                       {">=", false, true, true}, {"==", false, true, false}, {"!=", true, false, true}};
    for (const auto& [symbol, less, equal, greater] : comparisons) {
        const std::string text = std::string("x") + symbol + "y ? 1 : 0";
        INFO(text);
        CHECK(scalar(text, {1, 2, 0}) == (less ? 1.0f : 0.0f));
        CHECK(scalar(text, {2, 2, 0}) == (equal ? 1.0f : 0.0f));
        CHECK(scalar(text, {3, 2, 0}) == (greater ? 1.0f : 0.0f));
    }
}

TEST_CASE("vectors are taken part by part, and a scalar counts for all parts") {
    CHECK(vector("p + vec3(1, 2, 3)") == glm::vec3(1.25f, 2.5f, 3.75f));
    CHECK(vector("2 * p") == glm::vec3(0.5f, 1.0f, 1.5f));
    CHECK(vector("p * p") == glm::vec3(0.0625f, 0.25f, 0.5625f));
    CHECK(vector("1 - p") == glm::vec3(0.75f, 0.5f, 0.25f));
    CHECK(vector("p / 2") == glm::vec3(0.125f, 0.25f, 0.375f));
    CHECK(vector("-p") == glm::vec3(-0.25f, -0.5f, -0.75f));
    CHECK(vector("rgb(z, y, x)") == glm::vec3(0.75f, 0.5f, 0.25f));
    CHECK(vector("max(p, 0.5)") == glm::vec3(0.5f, 0.5f, 0.75f));
    CHECK(vector("mix(vec3(0,0,0), vec3(2,4,8), x)") == glm::vec3(0.5f, 1.0f, 2.0f));
    CHECK(vector("cross(vec3(1,0,0), vec3(0,1,0))") == glm::vec3(0, 0, 1));
    CHECK(vector("cross(vec3(1,2,3), vec3(-2,5,7))") == glm::vec3(-1, -13, 9));
    CHECK(vector("normalize(vec3(3,0,4))") == glm::vec3(0.6f, 0.0f, 0.8f));
    CHECK(scalar("dot(p, vec3(1,2,4))") == 4.25f);
    CHECK(scalar("length(vec3(3,0,-4))") == 5.0f);
    CHECK(scalar("distance(vec3(1,2,3), vec3(3,5,9))") == 7.0f);
    CHECK(scalar("p.x + 2*p.y + 4*p.z") == 4.25f);
    CHECK(scalar("p.r + 2*p.g + 4*p.b") == 4.25f);
    CHECK(scalar("(2*p).y") == 1.0f);
}

TEST_CASE("every function of numbers agrees with a reference in doubles") {
    const auto fract = [](double a) { return a - std::floor(a); };
    const auto clamp = [](double a, double least, double most) { return std::min(std::max(a, least), most); };
    const struct {
        const char* text;
        std::function<double(double, double, double)> reference;
    } functions[] = {
        {"abs(x)", [](double x, double, double) { return std::abs(x); }},
        {"floor(8*x)", [](double x, double, double) { return std::floor(8 * x); }},
        {"fract(4*x)", [&](double x, double, double) { return fract(4 * x); }},
        {"mod(x, y)", [](double x, double y, double) { return x - y * std::floor(x / y); }},
        {"min(x, y)", [](double x, double y, double) { return std::min(x, y); }},
        {"max(x, y)", [](double x, double y, double) { return std::max(x, y); }},
        {"clamp(x, -0.5, z*z)", [&](double x, double, double z) { return clamp(x, -0.5, z * z); }},
        {"mix(x, y, z)", [](double x, double y, double z) { return x + z * (y - x); }},
        {"step(x, y)", [](double x, double y, double) { return y < x ? 0.0 : 1.0; }},
        {"smoothstep(-1, 2, y)",
         [&](double, double y, double) {
             const double t = clamp((y + 1) / 3, 0, 1);
             return t * t * (3 - 2 * t);
         }},
        {"select(x < y, z, 2)", [](double x, double y, double z) { return x < y ? z : 2.0; }},
        {"sqrt(x*x)", [](double x, double, double) { return std::sqrt(x * x); }},
        {"pow(abs(x), y)", [](double x, double y, double) { return std::pow(std::abs(x), y); }},
        {"pow(x, 3)", [](double x, double, double) { return x * x * x; }},
        {"exp(3*x)", [](double x, double, double) { return std::exp(3 * x); }},
        {"log(abs(x))", [](double x, double, double) { return std::log(std::abs(x)); }},
        {"sin(20*x)", [](double x, double, double) { return std::sin(double(20.0f * float(x))); }},
        {"cos(20*x)", [](double x, double, double) { return std::cos(double(20.0f * float(x))); }},
        {"noise(8*p)",
         [](double x, double y, double z) { return double(perlin_noise(8.0f * glm::vec3(glm::dvec3(x, y, z)))); }},
        {"simplex(8*p)",
         [](double x, double y, double z) { return double(simplex_noise(8.0f * glm::vec3(glm::dvec3(x, y, z)))); }},
    };
    std::vector<glm::vec3> points = random_points(2000);
    for (glm::vec3& point : points) point = 3.0f * point - 1.5f;
    std::vector<glm::vec3> values(points.size());
    for (const auto& [text, reference] : functions) {
        parse(text).evaluate(points, values);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const glm::dvec3 point(points[i]);
            INFO(text << " at " << point.x << ", " << point.y << ", " << point.z);
            REQUIRE(double{values[i].x} == Approx(reference(point.x, point.y, point.z)).epsilon(2e-6).margin(2e-6));
        }
    }
}

TEST_CASE("hsv gives the linear light of an sRGB hue, which goes round once from 0 to 1") {
    CHECK(vector("hsv(0, 1, 1)") == glm::vec3(1, 0, 0));
    CHECK(vector("hsv(-7, 1, 1)") == glm::vec3(1, 0, 0));
    CHECK(vector("hsv(x, 0, 1)") == glm::vec3(1));
    CHECK(vector("hsv(x, 9, -1)") == glm::vec3(0));
    const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    std::vector<glm::vec3> points = random_points(1000);
    std::vector<glm::vec3> values(points.size());
    parse("hsv(5*x - 2, y, z)").evaluate(points, values);
    for (std::size_t i = 0; i < points.size(); ++i) {
        // By sextants of the circle, as A. R. Smith gave it in 1978.
        const double turn = 5.0 * double{points[i].x} - 2.0;
        const double sextant = 6.0 * (turn - std::floor(turn));
        const double s = double{points[i].y};
        const double v = double{points[i].z};
        const double f = sextant - std::floor(sextant);
        const double low = v * (1 - s);
        const double falling = v * (1 - s * f);
        const double rising = v * (1 - s * (1 - f));
        const glm::dvec3 colors[] = {{v, rising, low},  {falling, v, low}, {low, v, rising},
                                     {low, falling, v}, {rising, low, v},  {v, low, falling}};
        const glm::dvec3 color = colors[static_cast<std::size_t>(sextant) % 6];
        INFO(turn << ", " << s << ", " << v);
        for (int channel = 0; channel < 3; ++channel)
            REQUIRE(double{values[i][channel]} == Approx(linear(color[channel])).margin(5e-6));
    }
}

TEST_CASE("what has no value is infinite or no number, and never stops the others") {
    const float infinity = std::numeric_limits<float>::infinity();
    CHECK(scalar("1/0") == infinity);
    CHECK(scalar("-1/0") == -infinity);
    CHECK(scalar("exp(1000)") == infinity);
    CHECK(scalar("exp(-1000)") == 0.0f);
    CHECK(scalar("log(0)") == -infinity);
    CHECK(scalar("pow(10, 39)") == infinity);
    for (const char* nan : {"0/0", "sqrt(-1)", "log(-1)", "pow(-1, 0.5)", "sin(1e7)", "cos(1/0)", "min(0/0, 1)"}) {
        INFO(nan);
        CHECK(std::isnan(scalar(nan)));
    }
    for (const char* zero : {"noise(p/0)", "noise(1e9*p)", "simplex(p/0)", "simplex(vec3(0/0, 0, 0))"}) {
        INFO(zero);
        CHECK(scalar(zero) == 0.0f);
    }
}

TEST_CASE("points give the same bits in batches of every size as one by one") {
    const std::vector<glm::vec3> points = random_points(700);
    std::string large = "vec3(0, 0, 0)";  // of so many instructions that a batch is short
    for (int i = 1; i <= 80; ++i) large += " + abs(" + std::to_string(i) + "*p)";
    for (const std::string& text : {std::string("hsv(0.5+0.5*noise(8*p), 1, z)"), std::string("x"), std::string("2"),
                                    std::string("simplex(5*p)*exp(p)"), large}) {
        const Expression expression = parse(text);
        std::vector<glm::vec3> single(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) expression.evaluate({&points[i], 1}, {&single[i], 1});
        for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 63u, 255u, 256u, 257u, 511u, 700u}) {
            std::vector<glm::vec3> values(count + 1, glm::vec3(-7.0f));
            expression.evaluate(std::span(points).first(count), std::span(values).first(count));
            INFO(text.substr(0, 40) << ", " << count << " points");
            REQUIRE(std::equal(values.begin(), values.end() - 1, single.begin()));
            REQUIRE(values.back() == glm::vec3(-7.0f));
        }
    }
}

TEST_CASE("expressions have the same bits on every machine") {
    const struct {
        const char* text;
        glm::vec3 value;
    } golden[] = {
        {"hsv(0.5+0.5*noise(8*p), 1, z)", {0x0p+0f, 0x1.9327b8p-1f, 0x1.758b22p-1f}},
        {"simplex(4*p)", {0x1.1a8feep-4f, 0x1.1a8feep-4f, 0x1.1a8feep-4f}},
        {"exp(p)", {0x1.59905ap+0f, 0x1.01c2a6p+1f, 0x1.3ad446p+1f}},
        {"log(p)", {-0x1.34379p+0f, -0x1.6d3c34p-2f, -0x1.af8e8ap-4f}},
        {"sin(9*p)", {0x1.b5a31p-2f, 0x1.13796ap-6f, 0x1.f0956ap-1f}},
        {"cos(9*p)", {-0x1.cee28cp-1f, 0x1.ffed78p-1f, -0x1.f2c6fcp-3f}},
        {"pow(p, 1.7)", {0x1.0881ap-3f, 0x1.1736bp-1f, 0x1.ac09b2p-1f}},
        {"normalize(p - 0.5)", {-0x1.a20bd6p-2f, 0x1.a20bd6p-2f, 0x1.a20bd6p-1f}},
        {"smoothstep(0, 1, mod(5*p, 0.3))", {0x0p+0f, 0x1.a9fbb6p-4f, 0x1.ba5e04p-3f}},
    };
    for (const auto& [text, value] : golden) {
        INFO(text);
        CHECK(at(text, {0.3f, 0.7f, 0.9f}) == value);
    }
}

TEST_CASE("a program makes each step once, and evaluating allocates nothing") {
    CHECK(parse("noise(8*p) + noise(8*p)").instructions().size() == 9);  // x y z, 8, three products, noise, sum
    CHECK(parse("2 * x * 2").instructions().size() == 4);
    const Expression expression = parse("hsv(noise(8*p), 1, simplex(p))");
    const std::vector<glm::vec3> points = random_points(1000);
    std::vector<glm::vec3> values(points.size());
    const std::size_t before = test::allocation_count();
    expression.evaluate(points, values);
    const std::size_t after = test::allocation_count();
    CHECK(after == before);
}
