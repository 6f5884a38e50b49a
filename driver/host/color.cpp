#include "driver/host/color.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "driver/host/color_space.h"
#include "voxelizer/expression.h"
#include "voxelizer/noise.h"

namespace xorvox::host {
namespace {

struct Name {
    std::string_view name;
    std::uint32_t rrggbb;
};

/// The sixteen names of HTML 4, and a few more, all with the values of CSS Color Level 4.
constexpr Name kNames[] = {
    {"black", 0x000000},     {"silver", 0xc0c0c0}, {"gray", 0x808080},    {"white", 0xffffff},  {"maroon", 0x800000},
    {"red", 0xff0000},       {"purple", 0x800080}, {"fuchsia", 0xff00ff}, {"green", 0x008000},  {"lime", 0x00ff00},
    {"olive", 0x808000},     {"yellow", 0xffff00}, {"navy", 0x000080},    {"blue", 0x0000ff},   {"teal", 0x008080},
    {"aqua", 0x00ffff},      {"cyan", 0x00ffff},   {"magenta", 0xff00ff}, {"orange", 0xffa500}, {"gold", 0xffd700},
    {"pink", 0xffc0cb},      {"coral", 0xff7f50},  {"crimson", 0xdc143c}, {"violet", 0xee82ee}, {"indigo", 0x4b0082},
    {"turquoise", 0x40e0d0}, {"azure", 0xf0ffff},  {"salmon", 0xfa8072},  {"brown", 0xa52a2a},  {"ivory", 0xfffff0},
};

constexpr float kDefaultScale = 4.0f;
constexpr float kLeastScale = 0.1f;
constexpr float kMostScale = 256.0f;

class Constant final : public ColorField {
public:
    explicit Constant(const glm::dvec3& color) : color_(color) {}
    void evaluate(std::span<const glm::vec3>, std::span<glm::vec3> colors) const override {
        std::ranges::fill(colors, color_);
    }
    std::optional<glm::vec3> constant() const override { return color_; }

private:
    glm::vec3 color_;
};

class Gradient final : public ColorField {
public:
    explicit Gradient(std::span<const glm::dvec3> stops) : ramp_(stops) {}
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override {
        for (std::size_t i = 0; i < points.size(); ++i) colors[i] = ramp_.at(points[i].z);
    }

private:
    Ramp ramp_;
};

class Noise final : public ColorField {
public:
    Noise(float scale, std::span<const glm::dvec3> stops) : scale_(scale), ramp_(stops) {}
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override {
        constexpr std::size_t kMost = 128;
        std::array<glm::vec3, kMost> scaled;
        std::array<float, kMost> values;
        for (std::size_t first = 0; first < points.size(); first += kMost) {
            const std::size_t count = std::min(kMost, points.size() - first);
            for (std::size_t i = 0; i < count; ++i) scaled[i] = points[first + i] * scale_;
            perlin_noise(std::span(scaled).first(count), std::span(values).first(count));
            // Noise is mostly well within ±0.7: this spread uses the whole palette.
            for (std::size_t i = 0; i < count; ++i) colors[first + i] = ramp_.at(0.5f + 0.8f * values[i]);
        }
    }

private:
    float scale_;
    Ramp ramp_;
};

class Formula final : public ColorField {
public:
    explicit Formula(Expression expression) : expression_(std::move(expression)) {}
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override {
        expression_.evaluate(points, colors);
    }

private:
    Expression expression_;
};

Expected<glm::dvec3> parse_one_color(std::string_view text) {
    if (text.starts_with('#')) {
        std::uint32_t rrggbb = 0;
        const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), rrggbb, 16);
        if (text.size() != 7 || error != std::errc() || end != text.data() + text.size()) {
            return fail(
                fmt::format("colour \"{}\": a # must be followed by six hexadecimal digits, as in #ff8000", text));
        }
        return linear_from_hex(rrggbb);
    }
    const auto* known = std::ranges::find(kNames, text, &Name::name);
    if (known != std::end(kNames)) return linear_from_hex(known->rrggbb);
    std::string names;
    for (const Name& name : kNames) names += fmt::format(", {}", name.name);
    return fail(fmt::format("unknown colour \"{}\"; allowed: #rrggbb{}", text, names));
}

Expected<std::unique_ptr<ColorField>> make_constant(std::string_view color) {
    const auto linear = parse_one_color(color);
    if (!linear) return tl::unexpected<Error>(linear.error());
    return std::make_unique<Constant>(*linear);
}

std::unique_ptr<ColorField> make_default_gradient() {
    // Lightness rises with height, as if lit from above. Where red begins to count, blue has ceased to: so the order
    // survives formats with two bits of blue, or one.
    const std::array stops = {linear_from_hex(0x205cff), linear_from_hex(0x00e0ff), linear_from_hex(0x4ae258),
                              linear_from_hex(0xd0e030), linear_from_hex(0xffd400)};
    return std::make_unique<Gradient>(stops);
}

Expected<std::unique_ptr<ColorField>> make_gradient(std::string_view colors) {
    const std::size_t comma = colors.find(',');
    if (comma == std::string_view::npos) {
        return fail(fmt::format(
            "gradient:{}: two colours with a comma between them are needed, as in gradient:blue,gold", colors));
    }
    const auto bottom = parse_one_color(colors.substr(0, comma));
    if (!bottom) return tl::unexpected<Error>(bottom.error());
    const auto top = parse_one_color(colors.substr(comma + 1));
    if (!top) return tl::unexpected<Error>(top.error());
    return std::make_unique<Gradient>(std::array{*bottom, *top});
}

std::unique_ptr<ColorField> make_noise(float scale) {
    const std::array stops = {linear_from_hex(0x2848ff), linear_from_hex(0x00c8ff), linear_from_hex(0x38f068),
                              linear_from_hex(0xffd800), linear_from_hex(0xff3050)};
    return std::make_unique<Noise>(scale, stops);
}

Expected<std::unique_ptr<ColorField>> parse_noise(std::string_view text) {
    float scale = 0.0f;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), scale);
    if (error != std::errc() || end != text.data() + text.size() || !(scale >= kLeastScale && scale <= kMostScale)) {
        return fail(fmt::format("noise:{}: the scale must be a number from {} to {}, as in noise:{}", text, kLeastScale,
                                kMostScale, kDefaultScale));
    }
    return make_noise(scale);
}

Expected<std::unique_ptr<ColorField>> parse_expression(std::string_view text) {
    auto expression = Expression::parse(text);
    if (!expression) return fail("expr: " + expression.error().message);
    return std::make_unique<Formula>(std::move(*expression));
}

}  // namespace

Expected<std::unique_ptr<ColorField>> parse_color(std::string_view spec) {
    const std::size_t colon = spec.find(':');
    const std::string_view kind = spec.substr(0, colon);
    if (colon == std::string_view::npos) {
        if (kind == "gradient") return make_default_gradient();
        if (kind == "noise") return make_noise(kDefaultScale);
    } else {
        const std::string_view arguments = spec.substr(colon + 1);
        if (kind == "constant") return make_constant(arguments);
        if (kind == "gradient") return make_gradient(arguments);
        if (kind == "noise") return parse_noise(arguments);
        if (kind == "expr") return parse_expression(arguments);
    }
    return fail(
        fmt::format("colour \"{}\" is not understood; allowed: constant:NAME, constant:#rrggbb, gradient,"
                    " gradient:COLOR,COLOR, noise, noise:SCALE, expr:EXPRESSION",
                    spec));
}

}  // namespace xorvox::host
