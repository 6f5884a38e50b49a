// Arbitrary text as an expression: refused with a message of one line that names a column, or a program within its
// bounds whose values are the same for a point alone as among others.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "voxelizer/expression.h"

namespace {

bool same(float a, float b) {
    return a == b || (a != a && b != b);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto expression = xorvox::Expression::parse({reinterpret_cast<const char*>(data), size});
    if (!expression) {
        const std::string& message = expression.error().message;
        if (message.find("column ") == std::string::npos || message.find('\n') != std::string::npos) std::abort();
        return 0;
    }
    const auto instructions = expression->instructions();
    if (instructions.empty() || instructions.size() > xorvox::Expression::kMostInstructions) std::abort();
    for (std::size_t i = 0; i < instructions.size(); ++i) {
        for (const std::size_t operand : {instructions[i].a, instructions[i].b, instructions[i].c}) {
            if (operand != 0 && operand >= i) std::abort();
        }
    }
    for (const std::size_t result : expression->results()) {
        if (result >= instructions.size()) std::abort();
    }
    std::vector<glm::vec3> points;
    for (int i = 0; i < 19; ++i) points.push_back(glm::vec3(i % 3, i % 5, i) / 16.0f);
    std::vector<glm::vec3> values(points.size());
    expression->evaluate(points, values);
    glm::vec3 alone(0.0f);
    expression->evaluate({&points[17], 1}, {&alone, 1});
    for (int i = 0; i < 3; ++i) {
        if (!same(alone[i], values[17][i])) std::abort();
    }
    return 0;
}
