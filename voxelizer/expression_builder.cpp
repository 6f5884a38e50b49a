#include "voxelizer/expression_builder.h"

#include <algorithm>

namespace xorvox {
namespace {

using Op = ExpressionOp;
using Value = ExpressionValue;

bool is_truth(Op op) {
    return op == Op::Less || op == Op::LessEqual || op == Op::Equal || op == Op::And || op == Op::Or || op == Op::Not;
}

}  // namespace

std::string_view describe(ExpressionType type) {
    switch (type) {
        case ExpressionType::Scalar: return "a scalar";
        case ExpressionType::Vector: return "a vec3";
        case ExpressionType::Truth: break;
    }
    return "a truth value";
}

std::uint16_t ExpressionBuilder::emit(const ExpressionInstruction& wanted) {
    const auto same = std::ranges::find_if(instructions_, [&](const ExpressionInstruction& made) {
        return made.op == wanted.op && made.a == wanted.a && made.b == wanted.b && made.c == wanted.c &&
               made.constant == wanted.constant;
    });
    const auto place = static_cast<std::uint16_t>(same - instructions_.begin());
    if (same != instructions_.end()) return place;
    if (place == Expression::kMostInstructions) {
        full_ = true;
        return 0;
    }
    instructions_.push_back(wanted);
    return place;
}

Value ExpressionBuilder::constant(double number) {
    const std::uint16_t place = emit({.op = Op::Constant, .constant = number});
    return {ExpressionType::Scalar, {place, place, place}};
}

Value ExpressionBuilder::apply(Op op, const Value& a, const Value& b, const Value& c) {
    const auto has = [&](ExpressionType type) { return a.type == type || b.type == type || c.type == type; };
    Value value;
    if (has(ExpressionType::Vector)) {
        value.type = ExpressionType::Vector;
        for (std::size_t i = 0; i < 3; ++i)
            value.parts[i] = emit({.op = op, .a = a.parts[i], .b = b.parts[i], .c = c.parts[i]});
        return value;
    }
    if (is_truth(op) || (op == Op::Select && b.type == ExpressionType::Truth)) value.type = ExpressionType::Truth;
    value.parts.fill(emit({.op = op, .a = a.parts[0], .b = b.parts[0], .c = c.parts[0]}));
    return value;
}

Value ExpressionBuilder::at_point(Op op, const Value& point) {
    const std::uint16_t place = emit({.op = op, .a = point.parts[0], .b = point.parts[1], .c = point.parts[2]});
    return {ExpressionType::Scalar, {place, place, place}};
}

Value ExpressionBuilder::point() {
    return vector(apply(Op::X), apply(Op::Y), apply(Op::Z));
}

Value ExpressionBuilder::part(const Value& vector, std::size_t index) {
    const std::uint16_t place = vector.parts[index];
    return {ExpressionType::Scalar, {place, place, place}};
}

Value ExpressionBuilder::vector(const Value& x, const Value& y, const Value& z) {
    return {ExpressionType::Vector, {x.parts[0], y.parts[0], z.parts[0]}};
}

Value ExpressionBuilder::clamp(const Value& value, const Value& least, const Value& most) {
    return apply(Op::Min, apply(Op::Max, value, least), most);
}

Value ExpressionBuilder::fract(const Value& value) {
    return subtract(value, apply(Op::Floor, value));
}

Value ExpressionBuilder::mix(const Value& a, const Value& b, const Value& t) {
    return add(multiply(a, subtract(constant(1.0), t)), multiply(b, t));  // exactly a at 0 and b at 1
}

Value ExpressionBuilder::dot(const Value& a, const Value& b) {
    const Value products = multiply(a, b);
    return add(add(part(products, 0), part(products, 1)), part(products, 2));
}

Value ExpressionBuilder::length(const Value& vector) {
    return apply(Op::Sqrt, dot(vector, vector));
}

}  // namespace xorvox
