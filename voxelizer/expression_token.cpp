#include "voxelizer/expression_token.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include <fmt/format.h>

namespace xorvox {
namespace {

using Kind = ExpressionToken::Kind;

constexpr std::size_t kMostQuoted = 32;

// The C library's depend on the locale.
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool begins_number(std::string_view rest) {
    return is_digit(rest[0]) || (rest[0] == '.' && rest.size() > 1 && is_digit(rest[1]));
}

std::size_t symbol_length(std::string_view rest) {
    for (const std::string_view pair : {"<=", ">=", "==", "!=", "&&", "||"}) {
        if (rest.starts_with(pair)) return 2;
    }
    return std::string_view("+-*/()<>!?:,.").find(rest[0]) != std::string_view::npos ? 1 : 0;
}

/// The number at the beginning of `rest`; `length` becomes that of its text.
double read_number(std::string_view rest, std::size_t& length) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    length = static_cast<std::size_t>(end - rest.data());
    // Programs are evaluated in floats, too.
    if (error != std::errc() || number > double{std::numeric_limits<float>::max()})
        return std::numeric_limits<double>::infinity();
    return number;
}

}  // namespace

ExpressionToken next_token(std::string_view text, std::size_t& at) {
    while (at < text.size() && is_space(text[at])) ++at;
    ExpressionToken token;
    token.column = at + 1;
    if (at == text.size()) return token;
    const std::string_view rest = text.substr(at);
    std::size_t length = 1;
    if (begins_number(rest)) {
        token.kind = Kind::Number;
        token.number = read_number(rest, length);
    } else if (is_letter(rest[0])) {
        token.kind = Kind::Name;
        while (length < rest.size() && (is_letter(rest[length]) || is_digit(rest[length]))) ++length;
    } else if (symbol_length(rest) > 0) {
        token.kind = Kind::Symbol;
        length = symbol_length(rest);
    } else {
        token.kind = Kind::Unknown;
    }
    token.text = rest.substr(0, length);
    at += length;
    return token;
}

std::string describe(const ExpressionToken& token) {
    if (token.kind == Kind::End) return "the end";
    const char first = token.text[0];
    if (token.kind == Kind::Unknown && (first < ' ' || first > '~'))
        return fmt::format("the byte {:#04x}", static_cast<unsigned char>(first));
    const bool is_long = token.text.size() > kMostQuoted;
    return fmt::format("\"{}{}\"", token.text.substr(0, kMostQuoted), is_long ? "…" : "");
}

}  // namespace xorvox
