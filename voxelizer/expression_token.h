// The words of an expression's text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace xorvox {

struct ExpressionToken {
    enum class Kind : std::uint8_t { Number, Name, Symbol, End, Unknown };

    Kind kind = Kind::End;
    std::string_view text;
    std::size_t column = 1;  ///< of its first byte, from 1
    double number = 0.0;     ///< of a Number; not finite if it is too large or too small

    bool is(std::string_view symbol) const { return kind == Kind::Symbol && text == symbol; }
};

/// The first word of `text` from `at` on, which is moved behind it. An End stays there.
ExpressionToken next_token(std::string_view text, std::size_t& at);

/// How a message names it: in quotes and cut short, a byte that is no printable character by its number, "the end".
std::string describe(const ExpressionToken& token);

}  // namespace xorvox
