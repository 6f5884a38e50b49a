// ExpressionBuilder: values of an expression while it is read, and the program that computes them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "voxelizer/expression.h"

namespace xorvox {

enum class ExpressionType : std::uint8_t { Scalar, Vector, Truth };

/// "a scalar", "a vec3" or "a truth value".
std::string_view describe(ExpressionType type);

/// A value of the program. A scalar or truth value is in all three parts.
struct ExpressionValue {
    ExpressionType type = ExpressionType::Scalar;
    std::array<std::uint16_t, 3> parts{};
};

/// Makes instructions. The same operation on the same operands is made once.
class ExpressionBuilder {
public:
    using Op = ExpressionOp;
    using Value = ExpressionValue;

    Value constant(double number);
    /// An operation part by part: a vector if any operand is one, then scalars count for all three parts. Comparisons
    /// and logic give truth values, and so does a choice between them.
    Value apply(Op op, const Value& a = {}, const Value& b = {}, const Value& c = {});
    /// An operation on three numbers, the parts of `point`.
    Value at_point(Op op, const Value& point);

    Value point();
    static Value part(const Value& vector, std::size_t index);
    static Value vector(const Value& x, const Value& y, const Value& z);

    Value add(const Value& a, const Value& b) { return apply(Op::Add, a, b); }
    Value subtract(const Value& a, const Value& b) { return apply(Op::Subtract, a, b); }
    Value multiply(const Value& a, const Value& b) { return apply(Op::Multiply, a, b); }
    Value divide(const Value& a, const Value& b) { return apply(Op::Divide, a, b); }
    Value clamp(const Value& value, const Value& least, const Value& most);
    Value fract(const Value& value);
    Value mix(const Value& a, const Value& b, const Value& t);
    Value dot(const Value& a, const Value& b);
    Value length(const Value& vector);

    /// Whether more than Expression::kMostInstructions were asked for; values mean nothing from then on.
    bool is_full() const { return full_; }
    std::vector<ExpressionInstruction> take() { return std::move(instructions_); }

private:
    std::uint16_t emit(const ExpressionInstruction& instruction);

    std::vector<ExpressionInstruction> instructions_;
    bool full_ = false;
};

}  // namespace xorvox
