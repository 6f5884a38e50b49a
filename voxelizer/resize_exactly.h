// Vectors that are only filled anew, and must not hold more than they need. Hosted; internal to the voxelizer.
#pragma once

#include <cstddef>
#include <vector>

namespace xorvox {

/// As vector.resize(size), but what was in it may be lost, the old memory is gone before the new is asked for, and
/// there is none to grow into.
template <class T>
void resize_exactly(std::vector<T>& vector, std::size_t size) {
    if (size > vector.capacity()) {
        vector = std::vector<T>();  // `= {}` would keep the memory.
        vector.reserve(size);
    }
    vector.resize(size);
}

}  // namespace xorvox
