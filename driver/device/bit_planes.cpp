#include "driver/device/bit_planes.h"

#include <bit>
#include <cstring>

#include "driver/device/bit_planes_x86.h"

namespace xorvox::device {
namespace {

// A block of pixels is brought into lanes: lane k holds byte k of each pixel, one byte a pixel. Each bit of the lanes
// is a plane.
using Word = std::uint64_t;

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
template <unsigned Bits, unsigned Field, unsigned Half = 32 / Field>
Word spread(Word word) {
    if constexpr (Half == 0) {
        return word;
    } else {
        constexpr std::uint64_t low = every(2 * Half * Field, Half * Bits);
        word = (word & low) | ((word & (low << (Half * Bits))) << (Half * (Field - Bits)));
        return spread<Bits, Field, Half / 2>(word);
    }
}

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

template <unsigned Bits>
void split_block(const std::byte* pixels, const PlanePlaces& places, std::size_t at) {
    constexpr unsigned kLanes = (Bits + 7) / 8;
    std::array<Word, kLanes> lanes;
    load_lanes<Bits>(pixels, lanes);
    for (unsigned k = 0; k < kLanes; ++k) {
        const std::uint64_t planes = transpose(lanes[k]);
        for (unsigned bit = 8 * k; bit < std::min(8 * k + 8, Bits); ++bit) {
            if (places[bit] != nullptr) places[bit][at] = static_cast<std::byte>(planes >> (bit % 8 * 8));
        }
    }
}

/// 8 pixels at a time, on any processor; bit_planes_x86.h says what it does.
struct Portable {
    static constexpr std::uint32_t kBlock = 8;

    template <unsigned Bits>
    static void split_blocks(const BitPlaneLayout& layout, const std::byte* pixels, const PlanePlaces& places) {
        for (std::uint32_t row = 0; row < layout.rows; ++row) {
            const std::byte* from = pixels + row * layout.pixel_row_bytes();
            const std::size_t at = row * layout.row_planes() * layout.plane_bytes();
            for (std::uint32_t i = 0; i < layout.columns / kBlock; ++i, from += Bits) {
                split_block<Bits>(from, places, at + i);
            }
        }
    }
};

/// The last `columns` of a row, fewer than a block.
template <class Method, unsigned Bits>
void split_rest(const std::byte* pixels, std::uint32_t columns, const PlanePlaces& places, std::size_t at) {
    std::array<std::byte, std::size_t{Method::kBlock} * Bits / 8> block{};
    std::memcpy(block.data(), pixels, (std::size_t{columns} * Bits + 7) / 8);
    std::array<std::array<std::byte, Method::kBlock / 8>, Bits> planes;
    PlanePlaces own{};
    for (unsigned bit = 0; bit < Bits; ++bit) own[bit] = places[bit] != nullptr ? planes[bit].data() : nullptr;
    Method::template split_blocks<Bits>({.columns = Method::kBlock}, block.data(), own);
    const std::size_t bytes = (columns + 7) / 8;
    const auto last = static_cast<std::byte>(0xff >> (8 * bytes - columns));
    for (unsigned bit = 0; bit < Bits; ++bit) {
        if (places[bit] == nullptr) continue;
        planes[bit][bytes - 1] &= last;
        for (std::size_t i = 0; i < bytes; ++i) places[bit][at + i] = planes[bit][i];
    }
}

template <class Method, unsigned Bits>
void split_rows(const BitPlaneLayout& layout, const std::byte* pixels, const PlanePlaces& places) {
    Method::template split_blocks<Bits>(layout, pixels, places);
    const std::uint32_t rest = layout.columns % Method::kBlock;
    if (rest == 0) return;
    const std::size_t whole = layout.columns - rest;
    for (std::uint32_t row = 0; row < layout.rows; ++row) {
        split_rest<Method, Bits>(pixels + row * layout.pixel_row_bytes() + whole * Bits / 8, rest, places,
                                 row * layout.row_planes() * layout.plane_bytes() + whole / 8);
    }
}

/// Rows of one bit a pixel are their planes already.
void copy_rows(const BitPlaneLayout& layout, const std::byte* pixels, std::byte* planes) {
    const std::size_t bytes = layout.plane_bytes();
    std::memcpy(planes, pixels, layout.rows * bytes);
    const std::uint32_t rest = layout.columns % 8;
    if (rest == 0) return;
    for (std::uint32_t row = 0; row < layout.rows; ++row) {
        planes[row * bytes + bytes - 1] &= static_cast<std::byte>(0xff >> (8 - rest));
    }
}

template <class Method>
void split_all(const BitPlaneLayout& layout, const std::byte* pixels, const PlanePlaces& places) {
    switch (layout.format) {
        case PixelFormat::Mono1: return copy_rows(layout, pixels, places[0]);
        case PixelFormat::Mono2: return split_rows<Method, 2>(layout, pixels, places);
        case PixelFormat::Rgb111: return split_rows<Method, 3>(layout, pixels, places);
        case PixelFormat::Mono4: return split_rows<Method, 4>(layout, pixels, places);
        case PixelFormat::Rgb332: return split_rows<Method, 8>(layout, pixels, places);
        case PixelFormat::Rgb555: return split_rows<Method, 15>(layout, pixels, places);
        case PixelFormat::Rgb565: return split_rows<Method, 16>(layout, pixels, places);
        case PixelFormat::Rgb888: return split_rows<Method, 24>(layout, pixels, places);
    }
}

/// The bit of a pixel that is the lowest of a channel; the drawing in driver/display/description.h.
std::array<std::uint8_t, 3> lowest_bits(PixelFormat format) {
    const std::array<std::uint8_t, 3> bits = channel_bits(format);
    const bool red_is_lowest = format == PixelFormat::Rgb111 || format == PixelFormat::Rgb888;
    if (red_is_lowest || is_mono(format)) return {0, bits[0], static_cast<std::uint8_t>(bits[0] + bits[1])};
    return {static_cast<std::uint8_t>(bits[2] + bits[1]), bits[2], 0};
}

}  // namespace

bool has(PlaneMethod method) {
#if defined(XORVOX_BIT_PLANES_X86)
    if (method == PlaneMethod::Avx512) return __builtin_cpu_supports("avx512bw") != 0;
    if (method == PlaneMethod::Avx2) return __builtin_cpu_supports("avx2") != 0;
#endif
    return method == PlaneMethod::Portable;
}

Status split_bit_planes(const BitPlaneLayout& layout, std::span<const std::byte> pixels, std::span<std::byte> planes) {
    PlaneMethod method = PlaneMethod::Portable;
    if (has(PlaneMethod::Avx2)) method = PlaneMethod::Avx2;
    if (has(PlaneMethod::Avx512)) method = PlaneMethod::Avx512;
    return split_bit_planes(layout, pixels, planes, method);
}

Status split_bit_planes(const BitPlaneLayout& layout, std::span<const std::byte> pixels, std::span<std::byte> planes,
                        PlaneMethod method) {
    if (bits_per_pixel(layout.format) == 0 || layout.columns < 1 || layout.shown < 1 || layout.shown > 8 ||
        !has(method) || pixels.size() < layout.pixel_bytes() || planes.size() < layout.bytes()) {
        return Status::InvalidArgument;
    }
    PlanePlaces places{};
    const std::array<std::uint8_t, 3> bits = channel_bits(layout.format);
    const std::array<std::uint8_t, 3> lowest = lowest_bits(layout.format);
    for (std::uint32_t channel = 0; channel < 3; ++channel) {
        for (std::uint32_t plane = 0; plane < layout.channel_planes(channel); ++plane) {
            places[lowest[channel] + bits[channel] - 1u - plane] = planes.data() + layout.offset(0, channel, plane);
        }
    }
    switch (method) {
#if defined(XORVOX_BIT_PLANES_X86)
        case PlaneMethod::Avx512: split_all<Avx512>(layout, pixels.data(), places); break;
        case PlaneMethod::Avx2: split_all<Avx2>(layout, pixels.data(), places); break;
#endif
        default: split_all<Portable>(layout, pixels.data(), places); break;
    }
    return Status::Ok;
}

}  // namespace xorvox::device
