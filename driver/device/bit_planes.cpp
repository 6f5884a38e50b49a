#include "driver/device/bit_planes.h"

#include <bit>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace xorvox::device {
namespace {

constexpr std::uint32_t kMostPixelBits = 24;

// A block of pixels is brought into lanes: lane k holds byte k of each pixel, one byte a pixel. Each bit of the lanes
// is a plane.
#if defined(__SSE2__)
using Word = std::uint64_t __attribute__((vector_size(16)));  // Two words, 8 pixels each.
constexpr std::uint32_t kBlock = 16;
#else
using Word = std::uint64_t;
constexpr std::uint32_t kBlock = 8;
#endif
constexpr std::uint32_t kBlockPlaneBytes = kBlock / 8;

/// `Bytes` bytes, the first one lowest.
template <std::size_t Bytes>
std::uint64_t load(const std::byte* at) {
    std::uint64_t word = 0;
    if constexpr (std::endian::native == std::endian::little && std::has_single_bit(Bytes)) {
        std::memcpy(&word, at, Bytes);
    } else {
        for (std::size_t i = 0; i < Bytes; ++i) word |= std::to_integer<std::uint64_t>(at[i]) << (8 * i);
    }
    return word;
}

/// Bits 0 … bits − 1 of every field of `Field` bits.
constexpr std::uint64_t every(unsigned field, unsigned bits) {
    std::uint64_t mask = 0;
    for (unsigned at = 0; at < 64; at += field) mask |= ((std::uint64_t{1} << bits) - 1) << at;
    return mask;
}

/// The numbers of `Bits` bits that lie close in the low part of a word, one in each field of `Field` bits: the upper
/// half of them moves up, then the upper half of each half.
template <unsigned Bits, unsigned Field, unsigned Half = 32 / Field, class AnyWord>
AnyWord spread(AnyWord word) {
    if constexpr (Half == 0) {
        return word;
    } else {
        constexpr std::uint64_t low = every(2 * Half * Field, Half * Bits);
        word = (word & low) | ((word & (low << (Half * Bits))) << (Half * (Field - Bits)));
        return spread<Bits, Field, Half / 2>(word);
    }
}

#if defined(__SSE2__)

/// Lanes of less than a byte a pixel, and of a byte.
template <unsigned Bits>
void load_lanes(const std::byte* at, std::array<Word, 1>& lanes) {
    lanes[0] = Word{load<Bits>(at), load<Bits>(at + Bits)};
    if constexpr (Bits < 8) lanes[0] = spread<Bits, 8>(lanes[0]);
}

/// Two bytes a pixel, of 16 pixels.
void part_bytes(Word first, Word second, std::array<Word, 2>& lanes) {
    const auto a = reinterpret_cast<__m128i>(first);
    const auto b = reinterpret_cast<__m128i>(second);
    const __m128i low = _mm_set1_epi16(0xff);
    lanes[0] = reinterpret_cast<Word>(_mm_packus_epi16(_mm_and_si128(a, low), _mm_and_si128(b, low)));
    lanes[1] = reinterpret_cast<Word>(_mm_packus_epi16(_mm_srli_epi16(a, 8), _mm_srli_epi16(b, 8)));
}

template <unsigned Bits>
void load_lanes(const std::byte* at, std::array<Word, 2>& lanes) {
    if constexpr (Bits == 16) {
        part_bytes(Word{load<8>(at), load<8>(at + 8)}, Word{load<8>(at + 16), load<8>(at + 24)}, lanes);
    } else {
        static_assert(Bits == 15);
        // Four pixels are 60 bits; every other four begin in the middle of a byte.
        const Word first{load<8>(at), load<8>(at + 7) >> 4};
        const Word second{load<8>(at + 15), load<8>(at + 22) >> 4};
        part_bytes(spread<15, 16>(first), spread<15, 16>(second), lanes);
    }
}

template <unsigned Bits>
void load_lanes(const std::byte* at, std::array<Word, 3>& lanes) {
    static_assert(Bits == 24);
    // Each round brings byte i of the 48 to 2·i mod 47; after four of them byte 3·k + c is at k + 16·c.
    __m128i a;
    __m128i b;
    __m128i c;
    std::memcpy(&a, at, 16);
    std::memcpy(&b, at + 16, 16);
    std::memcpy(&c, at + 32, 16);
    const auto upper = [](__m128i x) { return _mm_unpackhi_epi64(x, x); };
    for (int round = 0; round < 4; ++round) {
        const __m128i first = _mm_unpacklo_epi8(a, upper(b));
        const __m128i second = _mm_unpacklo_epi8(upper(a), c);
        c = _mm_unpacklo_epi8(b, upper(c));
        a = first;
        b = second;
    }
    lanes = {reinterpret_cast<Word>(a), reinterpret_cast<Word>(b), reinterpret_cast<Word>(c)};
}

/// Calls put(bit, plane) for each bit of a lane, from `Bits` − 1 down.
template <unsigned Bits, class Put>
void for_each_plane(Word lane, const Put& put) {
    auto rest = reinterpret_cast<__m128i>(lane);
    if constexpr (Bits < 8) rest = _mm_slli_epi16(rest, 8 - Bits);
    for (unsigned bit = Bits; bit-- > 0;) {
        put(bit, static_cast<std::uint16_t>(_mm_movemask_epi8(rest)));
        rest = _mm_add_epi8(rest, rest);
    }
}

#else

template <unsigned Bits>
void load_lanes(const std::byte* at, std::array<Word, 1>& lanes) {
    lanes[0] = load<Bits>(at);
    if constexpr (Bits < 8) lanes[0] = spread<Bits, 8>(lanes[0]);
}

/// The low bytes of the four halfwords of a word, together.
std::uint64_t low_bytes(std::uint64_t word) {
    word &= every(16, 8);
    word = (word | word >> 8) & every(32, 16);
    return (word | word >> 16) & 0xffffffff;
}

template <unsigned Bits>
void load_lanes(const std::byte* at, std::array<Word, 2>& lanes) {
    static_assert(Bits == 15 || Bits == 16);
    std::uint64_t first = load<8>(at);
    std::uint64_t second = load<8>(at + Bits / 2);
    if constexpr (Bits == 15) {
        // Four pixels are 60 bits; the second four begin in the middle of a byte.
        first = spread<15, 16>(first);
        second = spread<15, 16>(second >> 4);
    }
    lanes[0] = low_bytes(first) | low_bytes(second) << 32;
    lanes[1] = low_bytes(first >> 8) | low_bytes(second >> 8) << 32;
}

template <unsigned Bits>
void load_lanes(const std::byte* at, std::array<Word, 3>& lanes) {
    static_assert(Bits == 24);
    lanes = {};
    for (unsigned i = 0; i < 8; ++i) {
        for (unsigned k = 0; k < 3; ++k) lanes[k] |= std::to_integer<std::uint64_t>(at[3 * i + k]) << (8 * i);
    }
}

/// Bit j of byte i becomes bit i of byte j (Warren, Hacker's Delight, section 7-3).
std::uint64_t transpose(std::uint64_t word) {
    const auto swap = [&word](unsigned distance, std::uint64_t mask) {
        const std::uint64_t differ = (word ^ (word >> distance)) & mask;
        word ^= differ ^ (differ << distance);
    };
    swap(7, 0x00aa00aa00aa00aa);
    swap(14, 0x0000cccc0000cccc);
    swap(28, 0x00000000f0f0f0f0);
    return word;
}

/// Calls put(bit, plane) for each of the `Bits` lowest bits of a lane.
template <unsigned Bits, class Put>
void for_each_plane(Word lane, const Put& put) {
    const std::uint64_t planes = transpose(lane);
    for (unsigned bit = 0; bit < Bits; ++bit) put(bit, static_cast<std::uint8_t>(planes >> (8 * bit)));
}

#endif

/// Where the plane of each bit of a pixel goes; nullptr: it is not shown.
using PlanePlaces = std::array<std::byte*, kMostPixelBits>;

/// Writes kBlockPlaneBytes of each plane, from `at` on.
template <unsigned Bits>
void split_block(const std::byte* pixels, const PlanePlaces& places, std::size_t at) {
    constexpr unsigned kLanes = (Bits + 7) / 8;
    std::array<Word, kLanes> lanes;
    load_lanes<Bits>(pixels, lanes);
    const auto split_lane = [&]<unsigned Lane>() {
        for_each_plane<std::min(8u, Bits - 8 * Lane)>(lanes[Lane], [&](unsigned bit, auto plane) {
            static_assert(sizeof plane == kBlockPlaneBytes);
            if (std::byte* const place = places[8 * Lane + bit]) std::memcpy(place + at, &plane, sizeof plane);
        });
    };
    split_lane.template operator()<0>();
    if constexpr (kLanes > 1) split_lane.template operator()<1>();
    if constexpr (kLanes > 2) split_lane.template operator()<2>();
}

/// The last `columns` of a row, fewer than a block.
template <unsigned Bits>
void split_rest(const std::byte* pixels, std::uint32_t columns, const PlanePlaces& places, std::size_t at) {
    std::array<std::byte, std::size_t{kBlock} * Bits / 8> block{};
    std::memcpy(block.data(), pixels, (std::size_t{columns} * Bits + 7) / 8);
    std::array<std::array<std::byte, kBlockPlaneBytes>, kMostPixelBits> planes;
    PlanePlaces own{};
    for (unsigned bit = 0; bit < Bits; ++bit) own[bit] = planes[bit].data();
    split_block<Bits>(block.data(), own, 0);
    const std::size_t bytes = (columns + 7) / 8;
    const auto last = static_cast<std::byte>(0xff >> (8 * bytes - columns));
    for (unsigned bit = 0; bit < Bits; ++bit) {
        if (places[bit] == nullptr) continue;
        planes[bit][bytes - 1] &= last;
        std::memcpy(places[bit] + at, planes[bit].data(), bytes);
    }
}

template <unsigned Bits>
void split_row(const std::byte* pixels, std::uint32_t columns, const PlanePlaces& places) {
    std::size_t at = 0;
    for (; columns >= kBlock; columns -= kBlock, at += kBlockPlaneBytes) {
        split_block<Bits>(pixels, places, at);
        pixels += std::size_t{kBlock} * Bits / 8;
    }
    if (columns > 0) split_rest<Bits>(pixels, columns, places, at);
}

/// The bit of a pixel that is the lowest of a channel; the drawing in driver/display/description.h.
std::array<std::uint8_t, 3> lowest_bits(PixelFormat format) {
    const std::array<std::uint8_t, 3> bits = channel_bits(format);
    const bool red_is_lowest = format == PixelFormat::Rgb111 || format == PixelFormat::Rgb888;
    if (red_is_lowest || is_mono(format)) return {0, bits[0], static_cast<std::uint8_t>(bits[0] + bits[1])};
    return {static_cast<std::uint8_t>(bits[2] + bits[1]), bits[2], 0};
}

}  // namespace

Status split_bit_planes(const BitPlaneLayout& layout, std::span<const std::byte> pixels, std::span<std::byte> planes) {
    if (bits_per_pixel(layout.format) == 0 || layout.columns < 1 || layout.shown < 1 || layout.shown > 8 ||
        pixels.size() < layout.pixel_bytes() || planes.size() < layout.bytes()) {
        return Status::InvalidArgument;
    }
    if (layout.format == PixelFormat::Mono1 && layout.columns % 8 == 0) {
        std::memcpy(planes.data(), pixels.data(), layout.bytes());  // A plane already.
        return Status::Ok;
    }
    PlanePlaces places{};
    const std::array<std::uint8_t, 3> bits = channel_bits(layout.format);
    const std::array<std::uint8_t, 3> lowest = lowest_bits(layout.format);
    for (std::uint32_t channel = 0; channel < 3; ++channel) {
        for (std::uint32_t plane = 0; plane < layout.channel_planes(channel); ++plane) {
            places[lowest[channel] + bits[channel] - 1u - plane] = planes.data() + layout.offset(0, channel, plane);
        }
    }
    const std::size_t row_bytes = layout.row_planes() * layout.plane_bytes();
    const std::byte* row = pixels.data();
    for (std::uint32_t r = 0; r < layout.rows; ++r, row += layout.pixel_row_bytes()) {
        switch (layout.format) {
            case PixelFormat::Mono1: split_row<1>(row, layout.columns, places); break;
            case PixelFormat::Mono2: split_row<2>(row, layout.columns, places); break;
            case PixelFormat::Rgb111: split_row<3>(row, layout.columns, places); break;
            case PixelFormat::Mono4: split_row<4>(row, layout.columns, places); break;
            case PixelFormat::Rgb332: split_row<8>(row, layout.columns, places); break;
            case PixelFormat::Rgb555: split_row<15>(row, layout.columns, places); break;
            case PixelFormat::Rgb565: split_row<16>(row, layout.columns, places); break;
            case PixelFormat::Rgb888: split_row<24>(row, layout.columns, places); break;
        }
        for (std::byte*& place : places) {
            if (place != nullptr) place += row_bytes;
        }
    }
    return Status::Ok;
}

}  // namespace xorvox::device
