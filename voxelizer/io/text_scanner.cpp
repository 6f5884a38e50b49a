#include "voxelizer/io/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

namespace xorvox::io {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

template <class Number>
std::from_chars_result read_whole(std::string_view word, Number& value) {
    // from_chars takes no plus sign, which exporters do write.
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    auto result = std::from_chars(word.data(), word.data() + word.size(), value);
    if (result.ptr != word.data() + word.size()) result.ec = std::errc::invalid_argument;
    return result;
}

}  // namespace

const char* TextScanner::continuation(const char* at) const {
    if (!obj_ || *at != '\\') return nullptr;
    ++at;
    if (at != end_ && *at == '\r') ++at;
    return at != end_ && *at == '\n' ? at + 1 : nullptr;
}

void TextScanner::skip_blanks() {
    while (at_ != end_) {
        if (is_blank(*at_)) {
            ++at_;
        } else if (const char* next = continuation(at_)) {
            at_ = next;
            ++line_;
        } else {
            return;
        }
    }
}

bool TextScanner::next_line() {
    for (;;) {
        skip_blanks();
        if (at_ == end_) return false;
        if (obj_ && *at_ == '#') {
            skip_line();
        } else if (*at_ == '\n') {
            ++at_;
            ++line_;
        } else {
            return true;
        }
    }
}

std::string_view TextScanner::word() {
    skip_blanks();
    if (obj_ && at_ != end_ && *at_ == '#') skip_line();
    const char* const begin = at_;
    while (at_ != end_ && *at_ != '\n' && !is_blank(*at_) && !continuation(at_)) ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
}

void TextScanner::skip_line() {
    at_ = std::find(at_, end_, '\n');
}

std::string_view TextScanner::rest_of_line() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
    const char* const begin = at_;
    skip_line();
    const char* last = at_;
    while (last != begin && is_blank(last[-1])) --last;
    return {begin, static_cast<std::size_t>(last - begin)};
}

const char* read_number(std::string_view word, double& value) {
    double number = 0;
    const auto result = read_whole(word, number);
    if (result.ec == std::errc::result_out_of_range) return "is beyond the range of a double";
    if (result.ec != std::errc{}) return "is not a number";
    if (!std::isfinite(number)) return "is not a finite number";
    value = number;
    return nullptr;
}

const char* read_number(std::string_view word, std::int64_t& value) {
    std::int64_t number = 0;
    const auto result = read_whole(word, number);
    if (result.ec == std::errc::result_out_of_range) return "is too large";
    if (result.ec != std::errc{}) return "is not a whole number";
    value = number;
    return nullptr;
}

std::string quoted(std::string_view word) {
    constexpr std::size_t kLongest = 40;
    std::string text = "'";
    for (const char c : word.substr(0, kLongest)) {
        if (c >= ' ' && c <= '~') {
            text += c;
        } else {
            text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        }
    }
    return text + (word.size() > kLongest ? "…'" : "'");
}

}  // namespace xorvox::io
