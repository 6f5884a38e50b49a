#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "driver/host/color.h"
#include "driver/host/color_space.h"
#include "tests/catch.h"

using namespace xorvox::host;
using Catch::Matchers::Contains;

namespace {

glm::vec3 color_at(const std::string& spec, glm::vec3 point) {
    const auto field = parse_color(spec);
    if (!field) FAIL(field.error().message);
    glm::vec3 color(-1);
    (*field)->evaluate({&point, 1}, {&color, 1});
    return color;
}

std::string message(const std::string& spec) {
    const auto field = parse_color(spec);
    REQUIRE_FALSE(field);
    return field.error().message;
}

}  // namespace

TEST_CASE("sRGB codes become linear light") {
    CHECK(linear_from_srgb(0) == 0.0);
    CHECK(linear_from_srgb(255) == 1.0);
    for (int code = 0; code < 256; ++code) {
        const double c = code / 255.0;
        const double expected = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        CHECK(linear_from_srgb(static_cast<std::uint8_t>(code)) == Approx(expected).epsilon(1e-14));
    }
}

TEST_CASE("a constant colour is a name or six hexadecimal digits") {
    CHECK(color_at("constant:red", {0, 0, 0}) == glm::vec3(1, 0, 0));
    CHECK(color_at("constant:cyan", {1, 1, 1}) == glm::vec3(0, 1, 1));
    CHECK(color_at("constant:black", {1, 1, 1}) == glm::vec3(0));
    CHECK(color_at("constant:orange", {0, 0, 0}) == color_at("constant:#ffa500", {1, 0, 0.5f}));
    CHECK(color_at("constant:#FFaa00", {0, 0, 0}) == color_at("constant:#ffAA00", {0, 0, 0}));
    const glm::vec3 gray = color_at("constant:gray", {0, 0, 0});
    CHECK(gray.r == Approx(0.2158605));
    CHECK(gray.r == gray.b);
}

TEST_CASE("a gradient runs from the bottom to the top") {
    CHECK(color_at("gradient:red,blue", {0.2f, 0.9f, 0}).r == Approx(1.0f));
    CHECK(color_at("gradient:red,blue", {0.2f, 0.9f, 0}).b == Approx(0.0f).margin(1e-6));
    CHECK(color_at("gradient:red,blue", {0.5f, 0.1f, 1}).b == Approx(1.0f));
    CHECK(color_at("gradient:#000000,white", {0, 0, 0}) == glm::vec3(0));
    CHECK(color_at("gradient", {0, 0, 0.3f}) == color_at("gradient", {1, 1, 0.3f}));
    const glm::vec3 gray = color_at("gradient:black,white", {0, 0, 0.5f});
    CHECK(gray.g == Approx(0.125f).epsilon(1e-3));  // Half of the lightness is an eighth of the light.
}

TEST_CASE("colours have the same bits on every machine") {
    const struct {
        const char* spec;
        float z;
        glm::vec3 color;
    } golden[] = {
        {"gradient", 0.0f, {0x1.d94bccp-7f, 0x1.b65ddep-4f, 0x1.fffffcp-1f}},
        {"gradient", 0.25f, {0x1.8bd95ap-25f, 0x1.7da59ep-1f, 0x1.fffffap-1f}},
        {"gradient", 0.5f, {0x1.187cap-4f, 0x1.856378p-1f, 0x1.8fb7a8p-4f}},
        {"gradient", 0.8f, {0x1.671d3cp-1f, 0x1.753ba8p-1f, 0x1.831aaep-6f}},
        {"gradient", 1.0f, {0x1p+0f, 0x1.51168p-1f, 0x0p+0f}},
        {"gradient:red,#00ff00", 0.25f, {0x1.b0e47p-1f, 0x1.61f068p-3f, 0x1.901004p-14f}},
        {"gradient:red,#00ff00", 0.8f, {0x1.26b314p-2f, 0x1.755f46p-1f, 0x1.8f0db4p-14f}},
        {"noise", 0.0f, {0x1.a1e2f4p-2f, 0x1.9c2b18p-1f, 0x1.404a5cp-4f}},
        {"noise", 0.8f, {0x1.e5961cp-1f, 0x1.65142ap-1f, 0x1.93d59ap-8f}},
        {"noise:10.5", 0.5f, {0x1p+0f, 0x1.832964p-2f, 0x1.5b5c56p-5f}},
        {"noise:10.5", 1.0f, {0x1.bdd126p-8f, 0x1.7cdfe8p-3f, 0x1p+0f}},
        {"gradient:red,#00ff00,blue,white", 0.4f, {0x0p+0f, 0x1.7771e8p-1f, 0x1.b8db5p-3f}},
        {"simplex", 0.8f, {0x1.549f18p-4f, 0x1.ba51fp-1f, 0x1.0ba116p-3f}},
        {"radial:red,gold,blue", 0.1f, {0x1.66f418p-1f, 0x1.29f5dp-1f, 0x1.23375p-3f}},
        {"spherical:red,gold,blue", 0.1f, {0x0p+0f, 0x1.8110acp-6f, 0x1.ec33e4p-1f}},
    };
    for (const auto& [spec, z, color] : golden) {
        INFO(spec << " at " << z);
        CHECK(color_at(spec, {0.3f, 0.7f, z}) == color);
    }
}

TEST_CASE("gradient and noise are bright everywhere, within 0 to 1, and vary") {
    for (const char* spec : {"gradient", "noise", "noise:0.1", "noise:256", "simplex", "simplex:0.1", "simplex:256"}) {
        INFO(spec);
        const auto field = parse_color(spec).value();
        std::vector<glm::vec3> points;
        for (int x = 0; x <= 20; ++x) {
            for (int y = 0; y <= 20; ++y) {
                for (int z = 0; z <= 20; ++z) points.push_back(glm::vec3(x, y, z) / 20.0f);
            }
        }
        std::vector<glm::vec3> colors(points.size());
        field->evaluate(points, colors);
        bool varies = false;
        for (const glm::vec3& c : colors) {
            REQUIRE(std::max({c.r, c.g, c.b}) >= 0.5f);
            REQUIRE(std::max({c.r, c.g, c.b}) <= 1.0f);
            REQUIRE(std::min({c.r, c.g, c.b}) >= 0.0f);
            varies = varies || c != colors[0];
        }
        CHECK(varies);
    }
}

TEST_CASE("the default gradient keeps its order in few bits: blue only falls, red only rises") {
    const auto field = parse_color("gradient").value();
    for (const auto& [most_red, most_blue] : {std::pair{1.0f, 1.0f}, {7.0f, 3.0f}}) {
        float red = 0.0f;
        float blue = most_blue;
        for (int step = 0; step <= 1000; ++step) {
            const glm::vec3 point(0.5f, 0.5f, static_cast<float>(step) / 1000.0f);
            glm::vec3 color(0.0f);
            field->evaluate({&point, 1}, {&color, 1});
            const float red_now = std::round(color.r * most_red);
            const float blue_now = std::round(color.b * most_blue);
            INFO("height " << point.z);
            REQUIRE(red_now >= red);
            REQUIRE(blue_now <= blue);
            REQUIRE((red_now == 0.0f || blue_now == 0.0f));  // Both at once would be pink or grey.
            red = red_now;
            blue = blue_now;
        }
        CHECK(red == most_red);
        CHECK(blue == 0.0f);
    }
}

TEST_CASE("each colour of a list has its own place") {
    CHECK(color_at("gradient:red,lime,blue,white", {0, 0, 1.0f / 3.0f}).g == Approx(1.0f));
    CHECK(color_at("gradient:red,lime,blue,white", {0, 0, 2.0f / 3.0f}).r == Approx(0.0f).margin(1e-5));
    CHECK(color_at("gradient:red,lime,blue,white", {0, 0, 1}).r == Approx(1.0f));
}

TEST_CASE("radial and spherical maps begin in the middle and end at half the box's side") {
    for (const glm::vec3 axis : {glm::vec3(0.5f, 0.5f, 0.0f), {0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 1.0f}}) {
        CHECK(color_at("radial:red,blue", axis).r == Approx(1.0f));
    }
    for (const glm::vec3 rim :
         {glm::vec3(1.0f, 0.5f, 0.5f), {0.5f, 0.0f, 0.1f}, {0.8f, 0.9f, 0.5f}, {0, 0, 0}, {9, 9, 9}}) {
        CHECK(color_at("radial:red,blue", rim).b == Approx(1.0f));
        CHECK(color_at("radial:red,blue", rim).r == Approx(0.0f).margin(1e-5));
    }
    CHECK(color_at("spherical:red,blue", {0.5f, 0.5f, 0.5f}).r == Approx(1.0f));
    CHECK(color_at("spherical:red,blue", {0.5f, 0.5f, 1.0f}).b == Approx(1.0f));
    CHECK(color_at("spherical:red,blue", {-9, 0, 0}).b == Approx(1.0f));
    // Half way, as a gradient is half way up.
    const glm::vec3 half = color_at("gradient:red,blue", {0, 0, 0.5f});
    CHECK(color_at("radial:red,blue", {0.75f, 0.5f, 0.9f}) == half);
    CHECK(color_at("spherical:red,blue", {0.5f, 0.5f, 0.25f}) == half);
}

TEST_CASE("points outside the box get the nearest colour") {
    CHECK(color_at("gradient", {0, 0, -5}) == color_at("gradient", {0, 0, 0}));
    CHECK(color_at("gradient", {0, 0, 5}) == color_at("gradient", {0, 0, 1}));
}

TEST_CASE("an expression is a colour, and a scalar is grey") {
    CHECK(color_at("expr: rgb(z, y, x)", {0.25f, 0.5f, 0.75f}) == glm::vec3(0.75f, 0.5f, 0.25f));
    CHECK(color_at("expr:y", {0.25f, 0.5f, 0.75f}) == glm::vec3(0.5f));
    CHECK(color_at("expr: x < 0.5 ? rgb(1, 0, 0) : rgb(0, 0, 1)", {0.6f, 0, 0}) == glm::vec3(0, 0, 1));
    CHECK(color_at("expr: hsv(0.5+0.5*noise(8*p), 1, z)", {0.5f, 0.5f, 0}) == glm::vec3(0));
    CHECK(message("expr: hsv(1, 2)") ==
          "expr: found \")\" at column 10; an operator or \",\" (hsv takes 3 values) is needed there");
    CHECK_THAT(message("expr:"), Contains("expr: found the end at column 1"));
}

TEST_CASE("a colour that is not understood is refused with what is allowed") {
    for (const char* spec : {"", "rainbow", "constant", "red", "gradients", "gradient ", "Noise", ":", "expr"}) {
        CHECK_THAT(message(spec), Contains(std::string("colour \"") + spec + "\"") &&
                                      Contains("constant:#rrggbb, gradient,") &&
                                      Contains("simplex:SCALE, expr:EXPRESSION"));
    }
    CHECK_THAT(message("constant:redd"), Contains("unknown colour \"redd\"") && Contains("#rrggbb, black, silver"));
    CHECK_THAT(message("constant:"), Contains("unknown colour \"\""));
    for (const char* hex : {"#12345", "#1234567", "#12345g", "#-12345", "#", "# 12345", "#0x1234"}) {
        CHECK_THAT(message(std::string("constant:") + hex), Contains("six hexadecimal digits"));
    }
    for (const char* kind : {"gradient", "radial", "spherical"}) {
        CHECK_THAT(message(std::string(kind) + ":red"), Contains(kind) && Contains("two colours or more with commas"));
        CHECK_THAT(message(std::string(kind) + ":red,"), Contains("unknown colour \"\""));
    }
    CHECK_THAT(message("gradient:red,bleu"), Contains("unknown colour \"bleu\""));
    CHECK_THAT(message("gradient:rde,blue"), Contains("unknown colour \"rde\""));
    std::string many = "gradient:red";
    for (int i = 0; i < 64; ++i) many += ",red";
    CHECK_THAT(message(many), Contains("at most 64 colours"));
    for (const char* scale : {"", "x", "4x", "0", "-1", "nan", "inf", "1e9", "0.01"}) {
        CHECK_THAT(message(std::string("noise:") + scale), Contains("a number from 0.1 to 256"));
        CHECK_THAT(message(std::string("simplex:") + scale), Contains("a number from 0.1 to 256, as in simplex:4"));
    }
}
