#include <algorithm>
#include <cmath>
#include <limits>

#include "voxelizer/elementary.h"
#include "voxelizer/expression.h"
#include "voxelizer/noise.h"

namespace xorvox {
namespace {

using Op = ExpressionOp;

/// Loops have this constant length, which compilers turn into vectors.
constexpr std::size_t kLanes = 8;
/// Numbers in a call's scratch: a row of at least kLanes for each instruction.
constexpr std::size_t kScratch = Expression::kMostInstructions * kLanes;
constexpr std::size_t kMostBatch = 256;

/// Where an instruction's operands and result are: rows of `size` numbers, a multiple of kLanes.
struct Rows {
    const float* a;
    const float* b;
    const float* c;
    float* result;
    std::size_t size;
};

template <class Function>
void each(const Rows& rows, Function function) {
    for (std::size_t i = 0; i < rows.size; i += kLanes) {
        const float* const a = rows.a + i;
        float* const __restrict result = rows.result + i;
        for (std::size_t lane = 0; lane < kLanes; ++lane) result[lane] = function(a[lane]);
    }
}

template <class Function>
void each_pair(const Rows& rows, Function function) {
    for (std::size_t i = 0; i < rows.size; i += kLanes) {
        const float* const a = rows.a + i;
        const float* const b = rows.b + i;
        float* const __restrict result = rows.result + i;
        for (std::size_t lane = 0; lane < kLanes; ++lane) result[lane] = function(a[lane], b[lane]);
    }
}

template <class Function>
void each_triple(const Rows& rows, Function function) {
    for (std::size_t i = 0; i < rows.size; i += kLanes) {
        const float* const a = rows.a + i;
        const float* const b = rows.b + i;
        const float* const c = rows.c + i;
        float* const __restrict result = rows.result + i;
        for (std::size_t lane = 0; lane < kLanes; ++lane) result[lane] = function(a[lane], b[lane], c[lane]);
    }
}

float truth(bool value) {
    return value ? 1.0f : 0.0f;
}

float square_root(float x) {
    return x >= 0.0f ? std::sqrt(x) : std::numeric_limits<float>::quiet_NaN();
}

void run(Op op, const Rows& rows) {
    switch (op) {
        case Op::Constant:
        case Op::X:
        case Op::Y:
        case Op::Z: return;  // filled in by the caller
        case Op::Add: return each_pair(rows, [](float a, float b) { return a + b; });
        case Op::Subtract: return each_pair(rows, [](float a, float b) { return a - b; });
        case Op::Multiply: return each_pair(rows, [](float a, float b) { return a * b; });
        case Op::Divide: return each_pair(rows, [](float a, float b) { return a / b; });
        case Op::Negate: return each(rows, [](float a) { return -a; });
        case Op::Abs: return each(rows, [](float a) { return std::abs(a); });
        case Op::Floor: return each(rows, [](float a) { return elementary::floor(a); });
        case Op::Sqrt: return each(rows, square_root);
        case Op::Exp: return each(rows, [](float a) { return elementary::narrow(elementary::exp(double{a})); });
        case Op::Log: return each(rows, [](float a) { return elementary::narrow(elementary::log(double{a})); });
        case Op::Sin: return each(rows, [](float a) { return elementary::narrow(elementary::sin(double{a})); });
        case Op::Cos: return each(rows, [](float a) { return elementary::narrow(elementary::cos(double{a})); });
        case Op::Pow:
            return each_pair(
                rows, [](float a, float b) { return elementary::narrow(elementary::pow(double{a}, double{b})); });
        case Op::Min: return each_pair(rows, [](float a, float b) { return b < a ? b : a; });
        case Op::Max: return each_pair(rows, [](float a, float b) { return a < b ? b : a; });
        case Op::LinearFromSrgb: return each(rows, [](float a) { return elementary::linear_from_srgb(a); });
        case Op::PerlinNoise:
            return each_triple(rows, [](float a, float b, float c) { return perlin_noise({a, b, c}); });
        case Op::SimplexNoise:
            return each_triple(rows, [](float a, float b, float c) { return simplex_noise({a, b, c}); });
        case Op::Less: return each_pair(rows, [](float a, float b) { return truth(a < b); });
        case Op::LessEqual: return each_pair(rows, [](float a, float b) { return truth(a <= b); });
        case Op::Equal: return each_pair(rows, [](float a, float b) { return truth(a == b); });
        case Op::And: return each_pair(rows, [](float a, float b) { return a * b; });
        case Op::Or: return each_pair(rows, [](float a, float b) { return a < b ? b : a; });
        case Op::Not: return each(rows, [](float a) { return 1.0f - a; });
        case Op::Select: return each_triple(rows, [](float a, float b, float c) { return a != 0.0f ? b : c; });
    }
}

std::size_t whole_lanes(std::size_t count) {
    return (count + kLanes - 1) / kLanes * kLanes;
}

/// One coordinate of all points; the row's rest is 0.
void gather(std::span<const glm::vec3> points, int axis, float* row) {
    for (std::size_t i = 0; i < points.size(); ++i) row[i] = points[i][axis];
    std::fill(row + points.size(), row + whole_lanes(points.size()), 0.0f);
}

}  // namespace

void Expression::evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> values) const {
    alignas(64) float scratch[kScratch];
    const std::size_t batch = std::min(kMostBatch, kScratch / instructions_.size() / kLanes * kLanes);
    const auto row = [&](std::size_t instruction) { return scratch + instruction * batch; };

    for (std::size_t i = 0; i < instructions_.size(); ++i) {
        if (instructions_[i].op == Op::Constant)
            std::fill_n(row(i), whole_lanes(std::min(batch, points.size())),
                        static_cast<float>(instructions_[i].constant));
    }
    for (std::size_t first = 0; first < points.size(); first += batch) {
        const auto some = points.subspan(first, std::min(batch, points.size() - first));
        for (std::size_t i = 0; i < instructions_.size(); ++i) {
            const ExpressionInstruction& step = instructions_[i];
            if (step.op == Op::X) gather(some, 0, row(i));
            if (step.op == Op::Y) gather(some, 1, row(i));
            if (step.op == Op::Z) gather(some, 2, row(i));
            run(step.op, {row(step.a), row(step.b), row(step.c), row(i), whole_lanes(some.size())});
        }
        for (std::size_t i = 0; i < some.size(); ++i)
            values[first + i] = {row(results_[0])[i], row(results_[1])[i], row(results_[2])[i]};
    }
}

}  // namespace xorvox
