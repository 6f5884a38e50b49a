// Expression: a formula over the points of a box, as text, for colours and shapes.
//
// The language, with examples: docs/color.md. Hosted only: parsing allocates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "voxelizer/error.h"

namespace xorvox {

/// What an instruction computes from its operands a, b and c. Vectors have been taken apart: every value is one number.
/// A truth value is 1 or 0.
enum class ExpressionOp : std::uint8_t {
    Constant,  ///< the instruction's own number
    X,         ///< the point's coordinates
    Y,
    Z,
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
    Abs,
    Floor,
    Sqrt,
    Exp,
    Log,
    Sin,
    Cos,
    Pow,
    Min,  ///< b < a ? b : a
    Max,  ///< a < b ? b : a
    LinearFromSrgb,
    PerlinNoise,  ///< at the point (a, b, c)
    SimplexNoise,
    Less,
    LessEqual,
    Equal,
    And,
    Or,
    Not,
    Select,  ///< a is a truth value: b where it is true, else c
};

/// One step of a program. Its result has the number of its place in the list; operands are results of earlier steps, 0
/// where the operation has no such operand.
struct ExpressionInstruction {
    ExpressionOp op = ExpressionOp::Constant;
    std::uint16_t a = 0;
    std::uint16_t b = 0;
    std::uint16_t c = 0;
    double constant = 0.0;  ///< of Constant only; a float can hold its size
};

/// A formula that has been read and checked. Copies are independent; any number of threads may evaluate one.
class Expression {
public:
    static constexpr std::size_t kMostCharacters = 4096;
    static constexpr std::size_t kMostNesting = 64;  ///< parentheses, calls, signs and ?: within each other
    static constexpr std::size_t kMostInstructions = 1024;

    /// Reads `text`. An error names the column, from 1, what is there and what is allowed: among others text, nesting
    /// and programs beyond the bounds above.
    static Expected<Expression> parse(std::string_view text);

    /// Whether the result is a vec3; otherwise it is a scalar.
    bool is_vector() const { return is_vector_; }

    /// The values at `points`, a scalar in all three parts; `values` has as many entries. Single precision, the same
    /// bits on every machine and however points are divided into calls, but for the sign and payload of a NaN.
    /// Allocates nothing; takes 32 KiB of stack. Every input has a value: x / 0 is infinite or NaN, the root or
    /// logarithm of a negative number NaN, the sine and cosine beyond ±2^20 NaN, noise beyond ±2^22 or at a NaN 0.
    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> values) const;

    /// The program, 1 … kMostInstructions steps, for other evaluators: intervals, doubles, a shader.
    std::span<const ExpressionInstruction> instructions() const { return instructions_; }
    /// The steps whose results are the value's parts; of a scalar, the same one three times.
    const std::array<std::uint16_t, 3>& results() const { return results_; }

private:
    Expression() = default;

    std::vector<ExpressionInstruction> instructions_;
    std::array<std::uint16_t, 3> results_{};
    bool is_vector_ = false;
};

}  // namespace xorvox
