// Scratch: hands out arrays from a buffer of the caller. Freestanding; internal to the voxelizer.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace xorvox {

inline constexpr std::size_t kScratchAlignment = 16;

class Scratch {
public:
    explicit Scratch(std::span<std::byte> buffer) : rest_(buffer) {}

    /// Bytes that an array of `count` entries takes.
    template <class T>
    static constexpr std::size_t bytes(std::size_t count) {
        return (count * sizeof(T) + kScratchAlignment - 1) / kScratchAlignment * kScratchAlignment;
    }

    /// An array of unspecified contents; the buffer must have bytes<T>(count) left.
    template <class T>
    std::span<T> take(std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kScratchAlignment);
        assert(rest_.size() >= bytes<T>(count));
        T* const first = reinterpret_cast<T*>(rest_.data());
        rest_ = rest_.subspan(bytes<T>(count));
        return {first, count};
    }

private:
    std::span<std::byte> rest_;
};

/// Whether `buffer` is aligned as Scratch needs it.
inline bool is_aligned(std::span<const std::byte> buffer) {
    return reinterpret_cast<std::uintptr_t>(buffer.data()) % kScratchAlignment == 0;
}

}  // namespace xorvox
