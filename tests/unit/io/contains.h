// contains("…"): matches text with that in it, by either version of Catch2.
#pragma once

#include <string>

#include "tests/catch.h"

inline auto contains(const std::string& part) {
#if __has_include(<catch2/catch_all.hpp>)
    return Catch::Matchers::ContainsSubstring(part);
#else
    return Catch::Matchers::Contains(part);
#endif
}
