#include "driver/device/bit_planes_x86.h"

#if defined(XORVOX_BIT_PLANES_X86)

#include <immintrin.h>

#include <array>
#include <cstring>
#include <utility>

#if !defined(__clang__)
// GCC's own headers give AVX-512 instructions registers that need not be set (its bug 105593).
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

// As in bit_planes.cpp, pixels are brought into lanes: lane k holds byte k of each pixel. Pixels of less than a byte
// have their bits lowest in their bytes, where what is above them is of no account; those of 3 bits stay as they are.
// Functions carry their target instead of the file, so that no inline function of a header is compiled for a processor
// that may be missing.
#define XORVOX_AVX2 [[gnu::target("avx2"), gnu::always_inline]] inline
#define XORVOX_AVX512 [[gnu::target("avx512f,avx512bw"), gnu::always_inline]] inline

namespace xorvox::device {
namespace {

template <unsigned Bits>
using AllBits = std::make_integer_sequence<unsigned, Bits>;

// Four numbers of 15 bits that lie close in a word are spread over it: the upper half of them moves up by two bits,
// then the upper half of each half by one.
constexpr long long kLow30 = 0x000000003fffffff, kLow15 = 0x00007fff00007fff;

/// Where bit `Bit` of each of 16 pixels of 3 bits is, which are six bytes.
template <unsigned Bit>
struct BitsOfThree {
    std::array<std::uint8_t, 16> bytes{};
    std::array<std::uint8_t, 16> bits{};
    constexpr BitsOfThree() {
        for (unsigned i = 0; i < 16; ++i) {
            bytes[i] = static_cast<std::uint8_t>((3 * i + Bit) / 8);
            bits[i] = static_cast<std::uint8_t>(1u << (3 * i + Bit) % 8);
        }
    }
};
template <unsigned Bit>
constexpr BitsOfThree<Bit> kBitsOfThree;

// Bytes of 128 bits of which pshufb makes four pixels of 24 bits, from byte `first` on, into RRRR GGGG BBBB, …
#define XORVOX_PART_COLORS(first)                                                                              \
    first, first + 3, first + 6, first + 9, first + 1, first + 4, first + 7, first + 10, first + 2, first + 5, \
        first + 8, first + 11, -1, -1, -1, -1

__m128i load_128(const void* at) {
    __m128i bytes;
    std::memcpy(&bytes, at, sizeof bytes);
    return bytes;
}

// AVX2: 32 pixels.

XORVOX_AVX2 __m256i load_256(const std::byte* low, const std::byte* high) {
    return _mm256_inserti128_si256(_mm256_castsi128_si256(load_128(low)), load_128(high), 1);
}

XORVOX_AVX2 __m256i spread(__m256i x, long long low, int bits, int distance) {
    const __m256i mask = _mm256_set1_epi64x(low);
    const __m256i upper = _mm256_and_si256(_mm256_srli_epi64(x, bits), mask);
    return _mm256_or_si256(_mm256_and_si256(x, mask), _mm256_slli_epi64(upper, bits + distance));
}

/// 32 halfwords.
XORVOX_AVX2 void part_bytes(__m256i a, __m256i b, __m256i* lanes) {
    const __m256i low = _mm256_set1_epi16(0xff);
    const __m256i first = _mm256_packus_epi16(_mm256_and_si256(a, low), _mm256_and_si256(b, low));
    const __m256i second = _mm256_packus_epi16(_mm256_srli_epi16(a, 8), _mm256_srli_epi16(b, 8));
    lanes[0] = _mm256_permute4x64_epi64(first, 0b11'01'10'00);
    lanes[1] = _mm256_permute4x64_epi64(second, 0b11'01'10'00);
}

/// 16 pixels of 15 bits into halfwords.
XORVOX_AVX2 __m256i load_16_of_15_bits(const std::byte* at) {
    // Four pixels are 60 bits: in words from the bytes 0, 7, 15 and 22 on, of which the second and last begin in the
    // middle.
    const __m256i words = _mm256_shuffle_epi8(load_256(at, at + 14),
                                              _mm256_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 7, 8, 9, 10, 11, 12, 13, 14,  //
                                                               1, 2, 3, 4, 5, 6, 7, 8, 8, 9, 10, 11, 12, 13, 14, 15));
    const __m256i even = _mm256_srlv_epi64(words, _mm256_setr_epi64x(0, 4, 0, 4));
    return spread(spread(even, kLow30, 30, 2), kLow15, 15, 1);
}

template <unsigned Bits>
XORVOX_AVX2 void load_lanes(const std::byte* at, __m256i* lanes) {
    if constexpr (Bits == 2) {
        __m256i x = _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(at)));
        x = _mm256_or_si256(x, _mm256_slli_epi32(x, 12));
        lanes[0] = _mm256_or_si256(x, _mm256_slli_epi32(x, 6));
    } else if constexpr (Bits == 3) {
        // As they are, 16 pixels a half.
        std::uint32_t last;
        std::memcpy(&last, at + 8, 4);
        const __m128i all =
            _mm_insert_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(at)), static_cast<int>(last), 2);
        lanes[0] = _mm256_inserti128_si256(_mm256_castsi128_si256(all), _mm_srli_si128(all, 6), 1);
    } else if constexpr (Bits == 4) {
        const __m256i x = _mm256_cvtepu8_epi16(load_128(at));
        lanes[0] = _mm256_or_si256(x, _mm256_slli_epi16(x, 4));
    } else if constexpr (Bits == 8) {
        lanes[0] = load_256(at, at + 16);
    } else if constexpr (Bits == 15) {
        part_bytes(load_16_of_15_bits(at), load_16_of_15_bits(at + 30), lanes);
    } else if constexpr (Bits == 16) {
        part_bytes(load_256(at, at + 16), load_256(at + 32, at + 48), lanes);
    } else {
        static_assert(Bits == 24);
        // Four pixels a vector's half, 16 pixels after those in the other half; the last four end with their bytes.
        const __m256i order = _mm256_setr_epi8(XORVOX_PART_COLORS(0), XORVOX_PART_COLORS(0));
        const __m256i last = _mm256_setr_epi8(XORVOX_PART_COLORS(0), XORVOX_PART_COLORS(4));
        const __m256i a = _mm256_shuffle_epi8(load_256(at, at + 48), order);
        const __m256i b = _mm256_shuffle_epi8(load_256(at + 12, at + 60), order);
        const __m256i c = _mm256_shuffle_epi8(load_256(at + 24, at + 72), order);
        const __m256i d = _mm256_shuffle_epi8(load_256(at + 36, at + 80), last);
        const __m256i ab = _mm256_unpacklo_epi32(a, b);
        const __m256i cd = _mm256_unpacklo_epi32(c, d);
        lanes[0] = _mm256_unpacklo_epi64(ab, cd);
        lanes[1] = _mm256_unpackhi_epi64(ab, cd);
        lanes[2] = _mm256_unpacklo_epi64(_mm256_unpackhi_epi32(a, b), _mm256_unpackhi_epi32(c, d));
    }
}

template <unsigned Bits, unsigned Bit>
XORVOX_AVX2 void put_plane(const __m256i* lanes, const PlanePlaces& places, std::size_t at) {
    if (places[Bit] == nullptr) return;
    int plane;
    if constexpr (Bits == 3) {
        const __m256i bytes = _mm256_broadcastsi128_si256(load_128(kBitsOfThree<Bit>.bytes.data()));
        const __m256i bits = _mm256_broadcastsi128_si256(load_128(kBitsOfThree<Bit>.bits.data()));
        const __m256i found = _mm256_and_si256(_mm256_shuffle_epi8(lanes[0], bytes), bits);
        plane = _mm256_movemask_epi8(_mm256_cmpeq_epi8(found, bits));
    } else {
        plane = _mm256_movemask_epi8(_mm256_slli_epi16(lanes[Bit / 8], 7 - Bit % 8));
    }
    std::memcpy(places[Bit] + at, &plane, sizeof plane);
}

template <unsigned Bits, unsigned... Bit>
XORVOX_AVX2 void put_planes(const __m256i* lanes, const PlanePlaces& places, std::size_t at,
                            std::integer_sequence<unsigned, Bit...>) {
    (put_plane<Bits, Bit>(lanes, places, at), ...);
}

// AVX-512: 64 pixels.

XORVOX_AVX512 __m512i spread(__m512i x, long long low, unsigned bits, unsigned distance) {
    const __m512i mask = _mm512_set1_epi64(low);
    const __m512i upper = _mm512_and_si512(_mm512_srli_epi64(x, bits), mask);
    return _mm512_or_si512(_mm512_and_si512(x, mask), _mm512_slli_epi64(upper, bits + distance));
}

/// 64 halfwords.
XORVOX_AVX512 void part_bytes(__m512i a, __m512i b, __m512i* lanes) {
    const __m512i low = _mm512_set1_epi16(0xff);
    const __m512i order = _mm512_setr_epi64(0, 2, 4, 6, 1, 3, 5, 7);
    const __m512i first = _mm512_packus_epi16(_mm512_and_si512(a, low), _mm512_and_si512(b, low));
    const __m512i second = _mm512_packus_epi16(_mm512_srli_epi16(a, 8), _mm512_srli_epi16(b, 8));
    lanes[0] = _mm512_permutexvar_epi64(order, first);
    lanes[1] = _mm512_permutexvar_epi64(order, second);
}

XORVOX_AVX512 __m512i load_512(const std::byte* a, const std::byte* b, const std::byte* c, const std::byte* d) {
    const __m512i two = _mm512_inserti32x4(_mm512_castsi128_si512(load_128(a)), load_128(b), 1);
    return _mm512_inserti32x4(_mm512_inserti32x4(two, load_128(c), 2), load_128(d), 3);
}

/// 32 pixels of 15 bits into halfwords.
XORVOX_AVX512 __m512i load_32_of_15_bits(const std::byte* at) {
    // As above.
    const __m512i order = _mm512_set4_epi32(0x0e0d0c0b, 0x0a090807, 0x07060504, 0x03020100);
    const __m512i last = _mm512_set4_epi32(0x0f0e0d0c, 0x0b0a0908, 0x08070605, 0x04030201);
    const __m512i words =
        _mm512_shuffle_epi8(load_512(at, at + 15, at + 30, at + 44), _mm512_mask_blend_epi32(0xf000, order, last));
    const __m512i even = _mm512_srlv_epi64(words, _mm512_setr_epi64(0, 4, 0, 4, 0, 4, 0, 4));
    return spread(spread(even, kLow30, 30, 2), kLow15, 15, 1);
}

/// 16 pixels of 24 bits, the first `skip` dwords from `at`, into RRRR GGGG BBBB of four pixels a quarter. No masked
/// load: it is slow where what it leaves out is in another page.
XORVOX_AVX512 __m512i load_16_of_24_bits(const std::byte* at, int skip) {
    const __m512i first = _mm512_setr_epi32(0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 8, 8, 9, 10, 11, 11);
    const __m512i order = _mm512_set4_epi32(-1, 0x0b080502, 0x0a070401, 0x09060300);
    const __m512i quarters =
        _mm512_permutexvar_epi32(_mm512_add_epi32(first, _mm512_set1_epi32(skip)), _mm512_loadu_si512(at));
    return _mm512_shuffle_epi8(quarters, order);
}

template <unsigned Bits>
XORVOX_AVX512 void load_lanes(const std::byte* at, __m512i* lanes) {
    if constexpr (Bits == 2) {
        __m512i x = _mm512_cvtepu8_epi32(load_128(at));
        x = _mm512_or_si512(x, _mm512_slli_epi32(x, 12));
        lanes[0] = _mm512_or_si512(x, _mm512_slli_epi32(x, 6));
    } else if constexpr (Bits == 3) {
        // As they are, 16 pixels a quarter.
        const __m256i all = _mm256_inserti128_si256(_mm256_castsi128_si256(load_128(at)),
                                                    _mm_loadl_epi64(reinterpret_cast<const __m128i*>(at + 16)), 1);
        lanes[0] = _mm512_permutexvar_epi16(_mm512_set_epi64(0, 0x000b'000b'000a'0009, 0, 0x0008'0008'0007'0006, 0,
                                                             0x0005'0005'0004'0003, 0, 0x0002'0002'0001'0000),
                                            _mm512_castsi256_si512(all));
    } else if constexpr (Bits == 4) {
        const __m512i x = _mm512_cvtepu8_epi16(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(at)));
        lanes[0] = _mm512_or_si512(x, _mm512_slli_epi16(x, 4));
    } else if constexpr (Bits == 8) {
        lanes[0] = _mm512_loadu_si512(at);
    } else if constexpr (Bits == 15) {
        part_bytes(load_32_of_15_bits(at), load_32_of_15_bits(at + 60), lanes);
    } else if constexpr (Bits == 16) {
        part_bytes(_mm512_loadu_si512(at), _mm512_loadu_si512(at + 64), lanes);
    } else {
        static_assert(Bits == 24);
        const __m512i a = load_16_of_24_bits(at, 0);
        const __m512i b = load_16_of_24_bits(at + 48, 0);
        const __m512i c = load_16_of_24_bits(at + 96, 0);
        const __m512i d = load_16_of_24_bits(at + 128, 4);
        const __m512i ab = _mm512_unpacklo_epi32(a, b);
        const __m512i cd = _mm512_unpacklo_epi32(c, d);
        // Quarter q has four pixels of each of a, b, c, d.
        const __m512i order = _mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
        lanes[0] = _mm512_permutexvar_epi32(order, _mm512_unpacklo_epi64(ab, cd));
        lanes[1] = _mm512_permutexvar_epi32(order, _mm512_unpackhi_epi64(ab, cd));
        lanes[2] = _mm512_permutexvar_epi32(
            order, _mm512_unpacklo_epi64(_mm512_unpackhi_epi32(a, b), _mm512_unpackhi_epi32(c, d)));
    }
}

template <unsigned Bits, unsigned Bit>
XORVOX_AVX512 void put_plane(const __m512i* lanes, const PlanePlaces& places, std::size_t at) {
    if (places[Bit] == nullptr) return;
    __mmask64 plane;
    if constexpr (Bits == 3) {
        const __m512i bytes = _mm512_broadcast_i32x4(load_128(kBitsOfThree<Bit>.bytes.data()));
        const __m512i bits = _mm512_broadcast_i32x4(load_128(kBitsOfThree<Bit>.bits.data()));
        plane = _mm512_test_epi8_mask(_mm512_shuffle_epi8(lanes[0], bytes), bits);
    } else {
        plane = _mm512_test_epi8_mask(lanes[Bit / 8], _mm512_set1_epi8(static_cast<char>(1u << Bit % 8)));
    }
    std::memcpy(places[Bit] + at, &plane, sizeof plane);
}

template <unsigned Bits, unsigned... Bit>
XORVOX_AVX512 void put_planes(const __m512i* lanes, const PlanePlaces& places, std::size_t at,
                              std::integer_sequence<unsigned, Bit...>) {
    (put_plane<Bits, Bit>(lanes, places, at), ...);
}

}  // namespace

template <unsigned Bits>
[[gnu::target("avx2")]] void Avx2::split_blocks(const BitPlaneLayout& layout, const std::byte* pixels,
                                                const PlanePlaces& all) {
    const PlanePlaces places = all;  // what is written does not change them
    const std::uint32_t blocks = layout.columns / kBlock;
    const std::size_t row_bytes = layout.row_planes() * layout.plane_bytes();
    for (std::uint32_t row = 0; row < layout.rows; ++row) {
        const std::byte* from = pixels + row * layout.pixel_row_bytes();
        std::size_t at = row * row_bytes;
        for (std::uint32_t i = 0; i < blocks; ++i, from += kBlock / 8 * Bits, at += kBlock / 8) {
            __m256i lanes[(Bits + 7) / 8];
            load_lanes<Bits>(from, lanes);
            put_planes<Bits>(lanes, places, at, AllBits<Bits>());
        }
    }
}

template <unsigned Bits>
[[gnu::target("avx512f,avx512bw")]] void Avx512::split_blocks(const BitPlaneLayout& layout, const std::byte* pixels,
                                                              const PlanePlaces& all) {
    const PlanePlaces places = all;  // what is written does not change them
    const std::uint32_t blocks = layout.columns / kBlock;
    const std::size_t row_bytes = layout.row_planes() * layout.plane_bytes();
    for (std::uint32_t row = 0; row < layout.rows; ++row) {
        const std::byte* from = pixels + row * layout.pixel_row_bytes();
        std::size_t at = row * row_bytes;
        for (std::uint32_t i = 0; i < blocks; ++i, from += kBlock / 8 * Bits, at += kBlock / 8) {
            __m512i lanes[(Bits + 7) / 8];
            load_lanes<Bits>(from, lanes);
            put_planes<Bits>(lanes, places, at, AllBits<Bits>());
        }
    }
}

#define XORVOX_INSTANTIATE(bits)                                                                         \
    template void Avx2::split_blocks<bits>(const BitPlaneLayout&, const std::byte*, const PlanePlaces&); \
    template void Avx512::split_blocks<bits>(const BitPlaneLayout&, const std::byte*, const PlanePlaces&);
XORVOX_INSTANTIATE(2)
XORVOX_INSTANTIATE(3)
XORVOX_INSTANTIATE(4)
XORVOX_INSTANTIATE(8)
XORVOX_INSTANTIATE(15)
XORVOX_INSTANTIATE(16)
XORVOX_INSTANTIATE(24)
#undef XORVOX_INSTANTIATE

}  // namespace xorvox::device

#endif
