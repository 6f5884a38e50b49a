#include <random>
#include <string>

#include "tests/catch.h"
#include "voxelizer/expression.h"

using namespace xorvox;

namespace {

std::string message(const std::string& text) {
    const auto expression = Expression::parse(text);
    INFO(text);
    REQUIRE_FALSE(expression);
    return expression.error().message;
}

std::string repeat(std::size_t count, const std::string& text) {
    std::string all;
    for (std::size_t i = 0; i < count; ++i) all += text;
    return all;
}

}  // namespace

TEST_CASE("a wrong type is named with its column and what is taken") {
    CHECK(message("1 + noise(x)") == "noise takes a vec3; found a scalar at column 11");
    CHECK(message("0.5 + noise((2*x))") == "noise takes a vec3; found a scalar at column 13");
    CHECK(message("sqrt(x < y)") == "sqrt takes a scalar or a vec3; found a truth value at column 6");
    CHECK(message("vec3(1, p, 2)") == "vec3 takes a scalar; found a vec3 at column 9");
    CHECK(message("select(x, 1, 2)") == "select takes a truth value, as in x < 0.5; found a scalar at column 8");
    CHECK(message("x.y") == "\".y\" takes a vec3; found a scalar at column 1");
    CHECK(message("x + (y > z)") == "\"+\" takes a scalar or a vec3; found a truth value at column 5");
    CHECK(message("1 < 2*p ? 1 : 2") == "\"<\" takes a scalar; found a vec3 at column 5");
    CHECK(message("0 < x < 1 ? 1 : 2") == "\"<\" takes a scalar; found a truth value at column 1");
    CHECK(message("x && y < 1 ? 1 : 2") == "\"&&\" takes a truth value, as in x < 0.5; found a scalar at column 1");
    CHECK(message("x ? 1 : 2") == "\"?\" takes a truth value, as in x < 0.5; found a scalar at column 1");
    CHECK(message("x < 1 ? 1 : y < z") == "\":\" here takes a scalar or a vec3; found a truth value at column 13");
    CHECK(message("-(x < 1)") == "\"-\" takes a scalar or a vec3; found a truth value at column 2");
    CHECK(message("!x") == "\"!\" takes a truth value, as in x < 0.5; found a scalar at column 2");
    CHECK(message(" x < 1") == "a result takes a scalar or a vec3; found a truth value at column 2");
}

TEST_CASE("a wrong word is named with its column and what may be there") {
    CHECK(message("") == "found the end at column 1; a value, \"-\", \"!\" or \"(\" is needed there");
    CHECK(message("1 +") == "found the end at column 4; a value, \"-\", \"!\" or \"(\" is needed there");
    CHECK(message("1 2") == "found \"2\" at column 3; an operator or the end is needed there");
    CHECK(message("2x") == "found \"x\" at column 2; an operator or the end is needed there");
    CHECK(message("1)") == "found \")\" at column 2; an operator or the end is needed there");
    CHECK(message("(1") == "found the end at column 3; an operator or \")\" is needed there");
    CHECK(message("x < 1 ? 2") == "found the end at column 10; an operator or \":\" is needed there");
    CHECK(message("noise p") == "found \"p\" at column 7; \"(\" behind noise is needed there");
    CHECK(message("mix(1, 2)") == "found \")\" at column 9; an operator or \",\" (mix takes 3 values) is needed there");
    CHECK(message("sin(1, 2)") == "found \",\" at column 6; an operator or \")\" (sin takes 1 value) is needed there");
    CHECK(message("sin()") == "found \")\" at column 5; a value, \"-\", \"!\" or \"(\" is needed there");
    CHECK(message("p.w") == "found \"w\" at column 3; x, y, z, r, g or b is needed there");
    CHECK(message("p.xy") == "found \"xy\" at column 3; x, y, z, r, g or b is needed there");
    CHECK(message("x = 1") == "found \"=\" at column 3; an operator or the end is needed there");
    CHECK(message("x\x01") == "found the byte 0x01 at column 2; an operator or the end is needed there");
    CHECK(message("x + é") == "found the byte 0xc3 at column 5; a value, \"-\", \"!\" or \"(\" is needed there");
    CHECK(message("1e999 + x") ==
          "the number \"1e999\" at column 1 is too large or too small; allowed: 0, 1e-300 … 3e38");
    CHECK_THAT(message("x + 1e39"), Catch::Matchers::Contains("\"1e39\" at column 5"));
    CHECK_THAT(message("nois(p)"),
               Catch::Matchers::StartsWith("unknown name \"nois\" at column 1; allowed: p, x, y, z, pi, tau and the "
                                           "functions vec3, rgb, hsv, noise, simplex, abs"));
    CHECK_THAT(message(repeat(2000, "a")), Catch::Matchers::Contains("\"" + repeat(32, "a") + "…\" at column 1"));
}

TEST_CASE("text, nesting and programs beyond the bounds are refused, and those within are not") {
    const std::string longest = "x" + std::string(Expression::kMostCharacters - 1, ' ');
    CHECK(Expression::parse(longest));
    CHECK(message(longest + " ") == "the expression goes on at column 4097; at most 4096 characters are allowed");

    // The whole is a level of its own.
    const auto nested = [](std::size_t levels, const std::string& open, const std::string& close) {
        return repeat(levels, open) + "x" + repeat(levels, close);
    };
    constexpr std::size_t kMost = Expression::kMostNesting - 1;
    for (const auto& [open, close] :
         {std::pair{"(", ")"}, {"-", ""}, {"abs(", ")"}, {"x<y ? ", " : 1"}, {"x<y ? 1 : ", ""}}) {
        INFO(open);
        CHECK(Expression::parse(nested(kMost, open, close)));
        CHECK_THAT(message(nested(kMost + 1, open, close)),
                   Catch::Matchers::Contains("is nested deeper than 64 levels"));
    }
    CHECK_THAT(message(nested(kMost + 1, "(", ")")), Catch::Matchers::StartsWith("column 65 "));
    CHECK_THAT(message(repeat(4000, "(")), Catch::Matchers::StartsWith("column 65 "));

    // x, and a constant and a sum for each further number.
    std::string sum = "x";
    for (int i = 1; i <= 511; ++i) sum += "+" + std::to_string(i);
    REQUIRE(Expression::parse(sum));
    CHECK(Expression::parse(sum)->instructions().size() == 1023);
    CHECK(Expression::parse("-(" + sum + ")")->instructions().size() == Expression::kMostInstructions);
    CHECK_THAT(message("abs(-(" + sum + "))"), Catch::Matchers::Contains("takes more than 1024 instructions") &&
                                                   Catch::Matchers::Contains("column 1946"));
}

TEST_CASE("whatever the words, the answer is a program or a message of one line") {
    const char* const words[] = {
        "x", "p",  "1.5",   "(",   ")",  ",", "+",  "-", "*",  "/",       "<",     "?",    ":",
        "!", ".x", "noise", "hsv", "==", "&", "&&", ".", "1e", "select(", "vec3(", "mod(", " "};
    std::mt19937 random(5);
    int programs = 0;
    for (int i = 0; i < 60000; ++i) {
        std::string text;
        for (std::size_t count = 1 + random() % 7; count > 0; --count) text += words[random() % std::size(words)];
        const auto expression = Expression::parse(text);
        INFO(text);
        if (!expression) {
            REQUIRE_FALSE(expression.error().message.empty());
            REQUIRE(expression.error().message.find('\n') == std::string::npos);
            continue;
        }
        ++programs;
        const glm::vec3 point(0.1f, 0.2f, 0.3f);
        glm::vec3 value;
        expression->evaluate({&point, 1}, {&value, 1});
    }
    CHECK(programs > 1000);
}
