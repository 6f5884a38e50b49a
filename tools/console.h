// Console: what the program says besides its results: warnings, and progress on a terminal.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>

namespace xorvox::tools {

/// One line on standard error, after "xorvox: ". Never throws, even when standard error is closed.
void complain(std::string_view message) noexcept;

/// complain(), after "warning: ".
void warn(std::string_view message);

/// 47815 as "47,815".
std::string thousands(std::uint64_t number);

/// `text` as a JSON string, quotes included. Bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

/// While it lives and standard error is a terminal: after one second, a line with what is going on, for how long, and
/// how much of it is done where that is known, renewed in place and wiped at the end. On a pipe, nothing.
class Progress {
public:
    explicit Progress(std::string_view activity);

    /// `part` of it is done: 0 to 1.
    void done(double part) { percent_ = static_cast<int>(part * 100.0); }

private:
    std::atomic<int> percent_ = -1;  // Not known.
    std::jthread thread_;
};

}  // namespace xorvox::tools
