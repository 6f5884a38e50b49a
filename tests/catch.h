// One include for Catch2, version 2 (Debian 12) or 3 (Debian 13).
#pragma once

#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
#endif

#include <cstdio>

/// Ends a test case that cannot run here; CTest counts it as skipped because of what this prints.
#define XORVOX_SKIP(reason)                                        \
    do {                                                           \
        std::printf("SKIPPED: %s\n", std::string(reason).c_str()); \
        SUCCEED();                                                 \
        return;                                                    \
    } while (false)
