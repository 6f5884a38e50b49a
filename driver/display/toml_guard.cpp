#include "driver/display/toml_guard.h"

namespace xorvox::display {
namespace {

bool contains(std::string_view set, char c) {
    return set.find(c) != set.npos;
}

bool is_ascii(char c) {
    return static_cast<unsigned char>(c) < 0x80;
}

bool is_word(char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '-';
}

}  // namespace

std::optional<Stray> find_stray(std::string_view toml) {
    enum class In { Statement, Number, Comment, Text, Literal };
    if (toml.starts_with("\xef\xbb\xbf")) toml.remove_prefix(3);  // A byte order mark may stand first.

    In in = In::Statement;
    std::size_t line = 1;
    char before = '\n';
    for (std::size_t i = 0; i < toml.size(); before = toml[i++]) {
        const char c = toml[i];
        if (c == '\n') {
            in = In::Statement;  // A text that is still open is an error of its own.
            ++line;
        } else if (in == In::Statement || in == In::Number) {
            const std::string_view rest = toml.substr(i, 3);
            if (rest == "\"\"\"" || rest == "'''") return Stray{line, "a text of several lines, which no key takes"};
            if (!is_ascii(c)) return Stray{line, "a character that is allowed only in texts and comments"};
            if (contains(" \t,]}", c)) in = In::Statement;
            if (c == '#') in = In::Comment;
            if (contains("+-0123456789", c) && !is_word(before)) in = In::Number;
            if (c == '"' || c == '\'') {
                // toml++ looks for the end of a number with no regard to texts.
                if (in == In::Number || !contains(" \t\n=,.[{", before)) {
                    return Stray{line, "a quotation mark within a word or number"};
                }
                in = c == '"' ? In::Text : In::Literal;
            }
        } else if (in == In::Text) {
            if (c == '"') in = In::Statement;
            if (c == '\\' && i + 1 < toml.size() && toml[i + 1] != '\n') {
                if (!is_ascii(toml[++i])) return Stray{line, "a character that cannot be escaped"};
            }
        } else if (in == In::Literal && c == '\'') {
            in = In::Statement;
        }
    }
    return std::nullopt;
}

}  // namespace xorvox::display
