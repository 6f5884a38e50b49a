// Whether OpenGL must be here: the environment's XORVOX_REQUIRE, a comma-separated list, then has "gl".
#pragma once

#include <cstdlib>
#include <string>

namespace xorvox::test {

inline bool gl_is_required() {
    const char* list = std::getenv("XORVOX_REQUIRE");
    return list != nullptr && ("," + std::string(list) + ",").find(",gl,") != std::string::npos;
}

}  // namespace xorvox::test

/// Skips the test where `expected` has no OpenGL, or fails it if there must be one.
#define XORVOX_NEED_GL(expected)                                              \
    do {                                                                      \
        if ((expected).has_value()) break;                                    \
        if (xorvox::test::gl_is_required()) FAIL((expected).error().message); \
        XORVOX_SKIP((expected).error().message);                              \
    } while (false)
