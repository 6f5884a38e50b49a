#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/expression.h"
#include "voxelizer/expression_builder.h"
#include "voxelizer/expression_functions.h"
#include "voxelizer/expression_token.h"

namespace xorvox {
namespace {

using Kind = ExpressionToken::Kind;
using Op = ExpressionOp;
using Type = ExpressionType;

/// A value, and where its text begins.
struct Operand {
    ExpressionValue value;
    std::size_t column = 1;
};

struct Operator {
    std::string_view symbol;
    int rank;  ///< what ranks higher is done first
    Op op;
    bool swapped;  ///< a > b is b < a
};

constexpr Operator kOperators[] = {
    {"||", 1, Op::Or, false},      {"&&", 2, Op::And, false},       {"==", 3, Op::Equal, false},
    {"!=", 3, Op::Equal, false},   {"<=", 4, Op::LessEqual, false}, {">=", 4, Op::LessEqual, true},
    {"<", 4, Op::Less, false},     {">", 4, Op::Less, true},        {"+", 5, Op::Add, false},
    {"-", 5, Op::Subtract, false}, {"*", 6, Op::Multiply, false},   {"/", 6, Op::Divide, false},
};

constexpr int kLogic = 2;       ///< up to this rank operands are truth values
constexpr int kComparison = 4;  ///< up to this rank they are scalars, above scalars or vectors

const Operator* find_operator(const ExpressionToken& token) {
    for (const Operator& known : kOperators) {
        if (token.is(known.symbol)) return &known;
    }
    return nullptr;
}

/// `needed` is a letter of ExpressionFunction::takes.
bool fits(Type type, char needed) {
    switch (needed) {
        case 's': return type == Type::Scalar;
        case 'v': return type == Type::Vector;
        case 't': return type == Type::Truth;
        default: return type != Type::Truth;
    }
}

std::string_view describe_need(char needed) {
    switch (needed) {
        case 's': return "a scalar";
        case 'v': return "a vec3";
        case 't': return "a truth value, as in x < 0.5";
        default: return "a scalar or a vec3";
    }
}

std::string allowed_names() {
    std::string names = "p, x, y, z, pi, tau and the functions ";
    for (const ExpressionFunction& function : expression_functions()) {
        if (&function != expression_functions().data()) names += ", ";
        names += function.name;
    }
    return names;
}

tl::unexpected<Error> mismatch(std::string_view who, char needed, const Operand& found) {
    return fail(fmt::format("{} takes {}; found {} at column {}", who, describe_need(needed),
                            describe(found.value.type), found.column));
}

class Parser {
public:
    explicit Parser(std::string_view text) : text_(text) { advance(); }

    Expected<Operand> whole() {
        auto value = choice();
        if (!value) return value;
        if (token_.kind != Kind::End) return misplaced("an operator or the end");
        if (value->value.type == Type::Truth) return mismatch("a result", 'n', *value);
        return value;
    }

    ExpressionBuilder& builder() { return builder_; }

private:
    /// Counts how deep the parser is within itself.
    class Level {
    public:
        explicit Level(std::size_t& depth) : depth_(++depth) {}
        ~Level() { --depth_; }
        Level(const Level&) = delete;
        Level& operator=(const Level&) = delete;

    private:
        std::size_t& depth_;
    };

    void advance() { token_ = next_token(text_, at_); }

    tl::unexpected<Error> misplaced(std::string_view needed) const {
        return fail(fmt::format("found {} at column {}; {} is needed there", describe(token_), token_.column, needed));
    }

    tl::unexpected<Error> too_deep() const {
        return fail(fmt::format("column {} is nested deeper than {} levels, the most that is allowed", token_.column,
                                Expression::kMostNesting));
    }

    /// What an operation gave, if the program has room for it.
    Expected<Operand> made(const ExpressionValue& value, std::size_t column) const {
        if (!builder_.is_full()) return Operand{value, column};
        return fail(
            fmt::format("the expression up to column {} takes more than {} instructions, the most that are"
                        " allowed; a vec3 counts three times",
                        token_.column, Expression::kMostInstructions));
    }

    /// CONDITION ? VALUE : VALUE, or what binds closer. The recursions all pass here or through sign().
    Expected<Operand> choice() {
        const Level level(depth_);
        if (depth_ > Expression::kMostNesting) return too_deep();
        auto condition = operation(1);
        if (!condition || !token_.is("?")) return condition;
        if (!fits(condition->value.type, 't')) return mismatch("\"?\"", 't', *condition);
        advance();
        const auto yes = choice();
        if (!yes) return yes;
        if (!token_.is(":")) return misplaced("an operator or \":\"");
        advance();
        const auto no = choice();
        if (!no) return no;
        const bool truth = yes->value.type == Type::Truth;
        if (truth != (no->value.type == Type::Truth)) return mismatch("\":\" here", truth ? 't' : 'n', *no);
        return made(builder_.apply(Op::Select, condition->value, yes->value, no->value), condition->column);
    }

    /// Operators of at least `rank`, from left to right.
    Expected<Operand> operation(int rank) {
        auto left = sign();
        while (left) {
            const Operator* const found = find_operator(token_);
            if (found == nullptr || found->rank < rank) break;
            advance();
            const auto right = operation(found->rank + 1);
            if (!right) return right;
            left = combine(*found, *left, *right);
        }
        return left;
    }

    Expected<Operand> combine(const Operator& with, const Operand& left, const Operand& right) {
        const char needed = with.rank <= kLogic ? 't' : with.rank <= kComparison ? 's' : 'n';
        for (const Operand* operand : {&left, &right}) {
            if (!fits(operand->value.type, needed))
                return mismatch(fmt::format("\"{}\"", with.symbol), needed, *operand);
        }
        ExpressionValue value = with.swapped ? builder_.apply(with.op, right.value, left.value)
                                             : builder_.apply(with.op, left.value, right.value);
        if (with.symbol == "!=") value = builder_.apply(Op::Not, value);
        return made(value, left.column);
    }

    Expected<Operand> sign() {
        const bool negate = token_.is("-");
        if (!negate && !token_.is("!")) return access();
        const Level level(depth_);
        if (depth_ > Expression::kMostNesting) return too_deep();
        const std::size_t column = token_.column;
        advance();
        const auto operand = sign();
        if (!operand) return operand;
        const char needed = negate ? 'n' : 't';
        if (!fits(operand->value.type, needed)) return mismatch(negate ? "\"-\"" : "\"!\"", needed, *operand);
        return made(builder_.apply(negate ? Op::Negate : Op::Not, operand->value), column);
    }

    /// A value, or a part of it.
    Expected<Operand> access() {
        auto value = primary();
        while (value && token_.is(".")) {
            advance();
            constexpr std::string_view kParts = "xyzrgb";
            const std::size_t part = token_.text.size() == 1 ? kParts.find(token_.text[0]) : std::string_view::npos;
            if (part == std::string_view::npos) return misplaced("x, y, z, r, g or b");
            if (!fits(value->value.type, 'v')) return mismatch(fmt::format("\".{}\"", token_.text), 'v', *value);
            advance();
            value->value = ExpressionBuilder::part(value->value, part % 3);
        }
        return value;
    }

    Expected<Operand> primary() {
        const ExpressionToken first = token_;
        if (first.kind == Kind::Number) {
            if (!std::isfinite(first.number)) {
                return fail(
                    fmt::format("the number {} at column {} is too large or too small; allowed: 0, 1e-300 … 3e38",
                                describe(first), first.column));
            }
            advance();
            return made(builder_.constant(first.number), first.column);
        }
        if (first.kind == Kind::Name) return name();
        if (!first.is("(")) return misplaced("a value, \"-\", \"!\" or \"(\"");
        advance();
        auto inner = choice();
        if (!inner) return inner;
        if (!token_.is(")")) return misplaced("an operator or \")\"");
        advance();
        inner->column = first.column;
        return inner;
    }

    Expected<Operand> name() {
        const ExpressionToken first = token_;
        advance();
        const auto is = [&](std::string_view name) { return first.text == name; };
        if (is("p")) return made(builder_.point(), first.column);
        if (is("x")) return made(builder_.apply(Op::X), first.column);
        if (is("y")) return made(builder_.apply(Op::Y), first.column);
        if (is("z")) return made(builder_.apply(Op::Z), first.column);
        if (is("pi")) return made(builder_.constant(std::numbers::pi), first.column);
        if (is("tau")) return made(builder_.constant(2.0 * std::numbers::pi), first.column);
        for (const ExpressionFunction& function : expression_functions()) {
            if (is(function.name)) return call(function, first.column);
        }
        return fail(
            fmt::format("unknown name {} at column {}; allowed: {}", describe(first), first.column, allowed_names()));
    }

    Expected<Operand> call(const ExpressionFunction& function, std::size_t column) {
        const std::size_t count = function.takes.size();
        if (!token_.is("(")) return misplaced(fmt::format("\"(\" behind {}", function.name));
        advance();
        ExpressionValue values[3];
        for (std::size_t i = 0; i < count; ++i) {
            const auto operand = choice();
            if (!operand) return operand;
            if (!fits(operand->value.type, function.takes[i]))
                return mismatch(function.name, function.takes[i], *operand);
            values[i] = operand->value;
            const std::string_view after = i + 1 < count ? "," : ")";
            if (!token_.is(after)) {
                return misplaced(fmt::format("an operator or \"{}\" ({} takes {} value{})", after, function.name, count,
                                             count == 1 ? "" : "s"));
            }
            advance();
        }
        return made(function.build(builder_, values), column);
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t depth_ = 0;
    ExpressionToken token_;
    ExpressionBuilder builder_;
};

}  // namespace

Expected<Expression> Expression::parse(std::string_view text) {
    if (text.size() > kMostCharacters) {
        return fail(fmt::format("the expression goes on at column {}; at most {} characters are allowed",
                                kMostCharacters + 1, kMostCharacters));
    }
    Parser parser(text);
    const auto value = parser.whole();
    if (!value) return tl::unexpected<Error>(value.error());
    Expression expression;
    expression.instructions_ = parser.builder().take();
    expression.results_ = value->value.parts;
    expression.is_vector_ = value->value.type == Type::Vector;
    return expression;
}

}  // namespace xorvox
