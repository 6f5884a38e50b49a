#include "voxelizer/expression_functions.h"

namespace xorvox {
namespace {

using Builder = ExpressionBuilder;
using Op = ExpressionOp;
using Value = ExpressionValue;

template <Op op>
Value unary(Builder& b, const Value* v) {
    return b.apply(op, v[0]);
}

template <Op op>
Value binary(Builder& b, const Value* v) {
    return b.apply(op, v[0], v[1]);
}

template <Op op>
Value at_point(Builder& b, const Value* v) {
    return b.at_point(op, v[0]);
}

Value vector(Builder&, const Value* v) {
    return Builder::vector(v[0], v[1], v[2]);
}

Value hsv(Builder& b, const Value* v) {
    const Value zero = b.constant(0.0);
    const Value one = b.constant(1.0);
    const Value saturation = b.clamp(v[1], zero, one);
    const Value value = b.clamp(v[2], zero, one);
    // How far each channel is from its own place on the circle of hues, red at 0, green at 1/3, blue at 2/3.
    const Value turned = b.add(v[0], Builder::vector(zero, b.constant(2.0 / 3.0), b.constant(1.0 / 3.0)));
    const Value away = b.subtract(b.multiply(b.fract(turned), b.constant(6.0)), b.constant(3.0));
    const Value pure = b.clamp(b.subtract(b.apply(Op::Abs, away), one), zero, one);
    return b.apply(Op::LinearFromSrgb, b.multiply(value, b.mix(one, pure, saturation)));
}

Value mod(Builder& b, const Value* v) {
    return b.subtract(v[0], b.multiply(v[1], b.apply(Op::Floor, b.divide(v[0], v[1]))));
}

Value step(Builder& b, const Value* v) {
    return b.apply(Op::Select, b.apply(Op::Less, v[1], v[0]), b.constant(0.0), b.constant(1.0));
}

Value smoothstep(Builder& b, const Value* v) {
    const Value ratio = b.divide(b.subtract(v[2], v[0]), b.subtract(v[1], v[0]));
    const Value t = b.clamp(ratio, b.constant(0.0), b.constant(1.0));
    return b.multiply(b.multiply(t, t), b.subtract(b.constant(3.0), b.multiply(b.constant(2.0), t)));
}

Value cross(Builder& b, const Value* v) {
    const auto minor = [&](std::size_t i, std::size_t j) {
        return b.subtract(b.multiply(Builder::part(v[0], i), Builder::part(v[1], j)),
                          b.multiply(Builder::part(v[0], j), Builder::part(v[1], i)));
    };
    return Builder::vector(minor(1, 2), minor(2, 0), minor(0, 1));
}

constexpr ExpressionFunction kFunctions[] = {
    {"vec3", "sss", vector},
    {"rgb", "sss", vector},
    {"hsv", "sss", hsv},
    {"noise", "v", at_point<Op::PerlinNoise>},
    {"simplex", "v", at_point<Op::SimplexNoise>},
    {"abs", "n", unary<Op::Abs>},
    {"floor", "n", unary<Op::Floor>},
    {"fract", "n", [](Builder& b, const Value* v) { return b.fract(v[0]); }},
    {"mod", "nn", mod},
    {"min", "nn", binary<Op::Min>},
    {"max", "nn", binary<Op::Max>},
    {"clamp", "nnn", [](Builder& b, const Value* v) { return b.clamp(v[0], v[1], v[2]); }},
    {"mix", "nnn", [](Builder& b, const Value* v) { return b.mix(v[0], v[1], v[2]); }},
    {"step", "nn", step},
    {"smoothstep", "nnn", smoothstep},
    {"select", "tnn", [](Builder& b, const Value* v) { return b.apply(Op::Select, v[0], v[1], v[2]); }},
    {"sqrt", "n", unary<Op::Sqrt>},
    {"pow", "nn", binary<Op::Pow>},
    {"exp", "n", unary<Op::Exp>},
    {"log", "n", unary<Op::Log>},
    {"sin", "n", unary<Op::Sin>},
    {"cos", "n", unary<Op::Cos>},
    {"dot", "vv", [](Builder& b, const Value* v) { return b.dot(v[0], v[1]); }},
    {"cross", "vv", cross},
    {"length", "v", [](Builder& b, const Value* v) { return b.length(v[0]); }},
    {"distance", "vv", [](Builder& b, const Value* v) { return b.length(b.subtract(v[0], v[1])); }},
    {"normalize", "v", [](Builder& b, const Value* v) { return b.divide(v[0], b.length(v[0])); }},
};

}  // namespace

std::span<const ExpressionFunction> expression_functions() {
    return kFunctions;
}

}  // namespace xorvox
