#include "sim/vcd.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <iterator>
#include <utility>

namespace xorvox::sim {
namespace {

constexpr std::size_t kBufferBytes = 1 << 16;

/// The code of a wire: one printable character, from ! on.
constexpr char code(std::size_t line) {
    return static_cast<char>('!' + line);
}
static_assert(code(kMaxLines - 1) <= '~');

std::string identifier(std::string text) {
    const auto is_other = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; };
    std::ranges::replace_if(text, is_other, '_');
    return text;
}

}  // namespace

VcdWriter::VcdWriter(std::vector<std::string> names, const VcdOptions& options, Output output)
    : output_(std::move(output)), most_changes_(options.most_changes) {
    names.resize(std::min<std::size_t>(names.size(), kMaxLines));
    write_header(names, options.scope);
}

void VcdWriter::write_header(const std::vector<std::string>& names, const std::string& scope) {
    auto out = std::back_inserter(buffer_);
    fmt::format_to(out, "$version xorvox $end\n$timescale 1 ns $end\n$scope module {} $end\n", identifier(scope));
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i].empty()) continue;
        traced_ |= LineMask{1} << i;
        fmt::format_to(out, "$var wire 1 {} {} $end\n", code(i), identifier(names[i]));
    }
    buffer_ += "$upscope $end\n$enddefinitions $end\n";
}

void VcdWriter::on_pins(std::uint64_t time_ns, LineMask levels, LineMask changed) {
    if (ended_early_ns_ || !status_) return;
    if (!time_ns_) {
        write_time(time_ns);
        buffer_ += "$dumpvars\n";
        write_levels(levels, traced_);
        buffer_ += "$end\n";
        return;
    }
    changed &= traced_;
    if (changed == 0) return;
    const auto count = static_cast<std::uint64_t>(std::popcount(changed));
    if (count > most_changes_ - changes_) {
        ended_early_ns_ = time_ns;
        return;
    }
    changes_ += count;
    write_time(time_ns);
    write_levels(levels, changed);
    if (buffer_.size() >= kBufferBytes) flush();
}

Expected<void> VcdWriter::finish(std::uint64_t end_ns) {
    if (time_ns_) write_time(ended_early_ns_.value_or(std::max(end_ns, *time_ns_)));
    flush();
    return status_;
}

void VcdWriter::write_time(std::uint64_t time_ns) {
    if (time_ns_ == time_ns) return;
    time_ns_ = time_ns;
    fmt::format_to(std::back_inserter(buffer_), "#{}\n", time_ns);
}

void VcdWriter::write_levels(LineMask levels, LineMask which) {
    for (; which != 0; which &= which - 1) {
        const auto line = static_cast<std::size_t>(std::countr_zero(which));
        buffer_ += (levels >> line & 1u) != 0 ? '1' : '0';
        buffer_ += code(line);
        buffer_ += '\n';
    }
}

void VcdWriter::flush() {
    if (status_) status_ = output_(buffer_);
    buffer_.clear();
}

}  // namespace xorvox::sim
