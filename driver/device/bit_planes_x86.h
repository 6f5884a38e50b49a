// Bit planes by the wide registers of x86 processors: what bit_planes.cpp chooses from at run time. Not for callers,
// but for tests, which ask for each method.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/device/bit_planes.h"

#if defined(__x86_64__) && defined(__GNUC__) && __STDC_HOSTED__
#define XORVOX_BIT_PLANES_X86
#endif

namespace xorvox::device {

enum class PlaneMethod : std::uint8_t { Portable, Avx2, Avx512 };

/// Whether this program and the processor that it runs on have a method.
bool has(PlaneMethod method);

/// split_bit_planes() by a method; InvalidArgument, too, where it is missing.
[[nodiscard]] Status split_bit_planes(const BitPlaneLayout& layout, std::span<const std::byte> pixels,
                                      std::span<std::byte> planes, PlaneMethod method);

/// Where the plane of each bit of a pixel begins; nullptr: it is not shown.
using PlanePlaces = std::array<std::byte*, 24>;

#if defined(XORVOX_BIT_PLANES_X86)

// split_blocks<Bits>() writes the planes of all whole blocks of kBlock pixels of all rows, which have 2, 3, 4, 8, 15,
// 16 or 24 bits a pixel. Nothing else is read or written. `places` are those of the first row.

struct Avx2 {
    static constexpr std::uint32_t kBlock = 32;
    template <unsigned Bits>
    static void split_blocks(const BitPlaneLayout& layout, const std::byte* pixels, const PlanePlaces& places);
};

struct Avx512 {
    static constexpr std::uint32_t kBlock = 64;
    template <unsigned Bits>
    static void split_blocks(const BitPlaneLayout& layout, const std::byte* pixels, const PlanePlaces& places);
};

#endif

}  // namespace xorvox::device
