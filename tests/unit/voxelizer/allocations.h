// Counts what is asked of operator new, and makes it fail, in this test program.
#pragma once

#include <cstddef>

namespace xorvox::test {

/// Allocations of all threads since the program began.
std::size_t allocation_count();
/// Bytes that are allocated now, and the most there have been since reset_peak().
std::size_t allocated_bytes();
std::size_t peak_bytes();
void reset_peak();

/// From now on `count` allocations succeed, and the one after throws std::bad_alloc, once.
void fail_after(std::size_t count);
/// No allocation fails any more; whether one has.
bool has_failed();

}  // namespace xorvox::test
