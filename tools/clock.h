// Clock: the time that links and displays are given.
#pragma once

#include <chrono>
#include <cstdint>

namespace xorvox::tools {

/// Nanoseconds since some moment before the program; never goes back.
inline std::uint64_t clock_ns() {
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                                      std::chrono::nanoseconds(1));
}

}  // namespace xorvox::tools
