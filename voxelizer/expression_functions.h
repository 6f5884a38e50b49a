// The functions of expressions: their names, what they take, and the instructions that they become.
#pragma once

#include <span>
#include <string_view>

#include "voxelizer/expression_builder.h"

namespace xorvox {

struct ExpressionFunction {
    std::string_view name;
    /// A letter for each operand: s scalar, v vec3, n either of them, t truth value. At most three.
    std::string_view takes;
    /// Operands of these types.
    ExpressionValue (*build)(ExpressionBuilder& builder, const ExpressionValue* values);
};

/// In the order in which messages and the manual list them.
std::span<const ExpressionFunction> expression_functions();

}  // namespace xorvox
