#include "driver/host/color.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "driver/host/color_list.h"
#include "driver/host/color_space.h"
#include "voxelizer/expression.h"
#include "voxelizer/noise.h"

namespace xorvox::host {
namespace {

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

/// By distance from the upright axis through the box's middle.
class Radial final : public ColorField {
public:
    explicit Radial(std::span<const glm::dvec3> stops) : ramp_(stops) {}
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const float x = points[i].x - 0.5f;
            const float y = points[i].y - 0.5f;
            colors[i] = ramp_.at(2.0f * std::sqrt(x * x + y * y));
        }
    }

private:
    Ramp ramp_;
};

/// By distance from the box's centre.
class Spherical final : public ColorField {
public:
    explicit Spherical(std::span<const glm::dvec3> stops) : ramp_(stops) {}
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const float x = points[i].x - 0.5f;
            const float y = points[i].y - 0.5f;
            const float z = points[i].z - 0.5f;
            colors[i] = ramp_.at(2.0f * std::sqrt(x * x + y * y + z * z));
        }
    }

private:
    Ramp ramp_;
};

using NoiseFunction = void (*)(std::span<const glm::vec3> points, std::span<float> values);

class Noise final : public ColorField {
public:
    /// The palette's middle is at 0; `spread` of it lies between -1 and 1, where most of the noise is.
    Noise(NoiseFunction noise, float scale, float spread, std::span<const glm::dvec3> stops)
        : noise_(noise), scale_(scale), spread_(spread), ramp_(stops) {}
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override {
        std::array<glm::vec3, 128> scaled;
        std::array<float, 128> values;
        for (std::size_t at = 0; at < points.size(); at += scaled.size()) {
            const std::size_t count = std::min(scaled.size(), points.size() - at);
            for (std::size_t i = 0; i < count; ++i) scaled[i] = points[at + i] * scale_;
            noise_(std::span(scaled).first(count), std::span(values).first(count));
            for (std::size_t i = 0; i < count; ++i) colors[at + i] = ramp_.at(0.5f + spread_ * values[i]);
        }
    }

private:
    NoiseFunction noise_;
    float scale_;
    float spread_;
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

Expected<std::unique_ptr<ColorField>> make_constant(std::string_view color) {
    const auto linear = parse_color_name(color);
    if (!linear) return tl::unexpected<Error>(linear.error());
    return std::make_unique<Constant>(*linear);
}

std::unique_ptr<ColorField> make_default_gradient() {
    // Lightness rises with height, as if lit from above.
    return std::make_unique<Gradient>(rising_colors());
}

/// A field of a ramp through the colours that are listed.
template <class Field>
Expected<std::unique_ptr<ColorField>> parse_ramp(std::string_view colors, std::string_view spec) {
    const auto stops = parse_colors(colors, 2, spec);
    if (!stops) return tl::unexpected<Error>(stops.error());
    return std::make_unique<Field>(*stops);
}

std::unique_ptr<ColorField> make_noise(std::string_view kind, float scale) {
    const std::array stops = {linear_from_hex(0x2848ff), linear_from_hex(0x00c8ff), linear_from_hex(0x38f068),
                              linear_from_hex(0xffd800), linear_from_hex(0xff3050)};
    // Perlin's noise is mostly well within ±0.7, simplex noise spreads wider: each uses the whole palette.
    if (kind == "simplex") return std::make_unique<Noise>(NoiseFunction(simplex_noise), scale, 0.55f, stops);
    return std::make_unique<Noise>(NoiseFunction(perlin_noise), scale, 0.8f, stops);
}

Expected<std::unique_ptr<ColorField>> parse_noise(std::string_view kind, std::string_view text) {
    float scale = 0.0f;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), scale);
    if (error != std::errc() || end != text.data() + text.size() || !(scale >= kLeastScale && scale <= kMostScale)) {
        return fail(fmt::format("{0}:{1}: the scale must be a number from {2} to {3}, as in {0}:{4}", kind, text,
                                kLeastScale, kMostScale, kDefaultScale));
    }
    return make_noise(kind, scale);
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
        if (kind == "noise" || kind == "simplex") return make_noise(kind, kDefaultScale);
    } else {
        const std::string_view arguments = spec.substr(colon + 1);
        if (kind == "constant") return make_constant(arguments);
        if (kind == "gradient") return parse_ramp<Gradient>(arguments, spec);
        if (kind == "radial") return parse_ramp<Radial>(arguments, spec);
        if (kind == "spherical") return parse_ramp<Spherical>(arguments, spec);
        if (kind == "noise" || kind == "simplex") return parse_noise(kind, arguments);
        if (kind == "expr") return parse_expression(arguments);
    }
    return fail(fmt::format("colour \"{}\" is not understood; allowed: {}", spec, kColorKinds));
}

}  // namespace xorvox::host
