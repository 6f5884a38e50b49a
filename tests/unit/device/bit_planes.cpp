#include "driver/device/bit_planes.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "driver/device/bit_planes_x86.h"
#include "tests/catch.h"

using namespace xorvox;
using device::BitPlaneLayout;
using device::PlaneMethod;

namespace {

struct Way {
    const char* name;
    PlaneMethod method;
};
constexpr Way kAllWays[] = {{"on any processor", PlaneMethod::Portable},
                            {"with AVX2", PlaneMethod::Avx2},
                            {"with AVX-512", PlaneMethod::Avx512}};

/// Those that this processor has.
std::vector<Way> ways() {
    std::vector<Way> found;
    for (const Way& way : kAllWays) {
        if (has(way.method)) found.push_back(way);
    }
    return found;
}

std::uint32_t bit_at(std::span<const std::byte> bytes, std::size_t bit) {
    return std::to_integer<std::uint32_t>(bytes[bit / 8]) >> (bit % 8) & 1u;
}

/// Bits of a pixel from the lowest one on: channel and bit of it; the drawing in description.h, in its own words.
std::string drawn(PixelFormat format) {
    switch (format) {
        case PixelFormat::Mono1: return "R0";
        case PixelFormat::Mono2: return "R0R1";
        case PixelFormat::Mono4: return "R0R1R2R3";
        case PixelFormat::Rgb111: return "R0G0B0";
        case PixelFormat::Rgb332: return "B0B1G0G1G2R0R1R2";
        case PixelFormat::Rgb555: return "B0B1B2B3B4G0G1G2G3G4R0R1R2R3R4";
        case PixelFormat::Rgb565: return "B0B1B2B3B4G0G1G2G3G4G5R0R1R2R3R4";
        case PixelFormat::Rgb888: return "R0R1R2R3R4R5R6R7G0G1G2G3G4G5G6G7B0B1B2B3B4B5B6B7";
    }
    return "";
}

/// The level of a channel of a pixel as it came on the wire, read bit by bit.
std::uint32_t level(const BitPlaneLayout& layout, std::span<const std::byte> pixels, std::uint32_t row,
                    std::uint32_t column, std::uint32_t channel) {
    const std::string bits = drawn(layout.format);
    const std::size_t first = std::size_t{row} * layout.pixel_row_bytes() * 8 + column * (bits.size() / 2);
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < bits.size() / 2; ++i) {
        if (bits[2 * i] == "RGB"[channel]) sum += bit_at(pixels, first + i) << (bits[2 * i + 1] - '0');
    }
    return sum;
}

std::vector<std::byte> noise(std::size_t bytes, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<std::byte> all(bytes);
    for (std::byte& byte : all) byte = static_cast<std::byte>(random());
    return all;
}

/// The planes put together again with weights 2^b are the codes' shown bits, and every other bit is zero.
void check(const BitPlaneLayout& layout, std::span<const std::byte> pixels, std::span<const std::byte> planes) {
    bool whole = true;
    std::size_t ones = 0;
    std::size_t found = 0;
    for (std::uint32_t row = 0; row < layout.rows; ++row) {
        for (std::uint32_t channel = 0; channel < channel_count(layout.format); ++channel) {
            const std::uint32_t bits = device::channel_bits(layout.format)[channel];
            const std::uint32_t count = layout.channel_planes(channel);
            for (std::uint32_t column = 0; column < layout.columns; ++column) {
                std::uint32_t sum = 0;
                for (std::uint32_t plane = 0; plane < count; ++plane) {
                    const std::uint32_t bit = bit_at(planes, layout.offset(row, channel, plane) * 8 + column);
                    sum += bit << (count - 1 - plane);
                    ones += bit;
                }
                whole = whole && sum == level(layout, pixels, row, column, channel) >> (bits - count);
            }
        }
    }
    for (std::size_t bit = 0; bit < planes.size() * 8; ++bit) found += bit_at(planes, bit);
    CHECK(whole);
    CHECK(found == ones);
}

}  // namespace

TEST_CASE("bit planes put together again are the pixels, in every format and width") {
    for (const Way& way : ways()) {
        for (const PixelFormat format : kPixelFormats) {
            for (std::uint32_t columns = 1; columns <= 200; ++columns) {
                const BitPlaneLayout layout{format, columns, 3, 8};
                const auto pixels = noise(layout.pixel_bytes(), columns);
                std::vector<std::byte> planes(layout.bytes(), std::byte{0x5a});
                INFO(way.name << ", " << to_string(format) << ", " << columns << " columns");
                REQUIRE(split_bit_planes(layout, pixels, planes, way.method) == Status::Ok);
                check(layout, pixels, planes);
            }
        }
    }
}

TEST_CASE("every method makes the same bit planes, however many are shown, at any byte") {
    for (const Way& way : ways()) {
        for (const PixelFormat format : kPixelFormats) {
            for (std::uint32_t shown = 1; shown <= 8; ++shown) {
                for (std::uint32_t columns = 1; columns <= 200; ++columns) {
                    const BitPlaneLayout layout{format, columns, 2, shown};
                    const std::size_t odd = columns % 17;
                    const auto pixels = noise(odd + layout.pixel_bytes(), columns + shown);
                    std::vector<std::byte> planes(odd + layout.bytes() + 16, std::byte{0xc3});
                    std::vector<std::byte> expected = planes;
                    const auto split = [&](std::vector<std::byte>& to, PlaneMethod method) {
                        return split_bit_planes(layout, std::span(pixels).subspan(odd),
                                                std::span(to).subspan(odd, layout.bytes()), method);
                    };
                    INFO(way.name << ", " << to_string(format) << ", " << shown << " shown, " << columns << " columns");
                    REQUIRE(split(expected, PlaneMethod::Portable) == Status::Ok);
                    REQUIRE(split(planes, way.method) == Status::Ok);
                    REQUIRE(planes == expected);
                }
            }
        }
    }
}

TEST_CASE("every method of bit planes is tested") {
    std::string missing;
    for (const Way& way : kAllWays) {
        if (!has(way.method)) missing += std::string(", ") + way.name;
    }
    if (!missing.empty()) XORVOX_SKIP("this processor has no bit planes " + missing.substr(2));
}

TEST_CASE("only the most significant bit planes are shown") {
    for (const Way& way : ways()) {
        for (const PixelFormat format : kPixelFormats) {
            for (std::uint32_t shown = 1; shown <= bits_per_channel(format); ++shown) {
                const BitPlaneLayout layout{format, 37, 2, shown};
                const auto pixels = noise(layout.pixel_bytes(), shown);
                std::vector<std::byte> planes(layout.bytes());
                INFO(way.name << ", " << to_string(format) << ", " << shown << " shown");
                REQUIRE(split_bit_planes(layout, pixels, planes, way.method) == Status::Ok);
                check(layout, pixels, planes);
            }
        }
    }
}

TEST_CASE("bit planes may begin at any byte, and nothing beyond them is touched") {
    for (const Way& way : ways()) {
        for (const PixelFormat format : kPixelFormats) {
            for (std::size_t odd = 0; odd < 16; ++odd) {
                const BitPlaneLayout layout{format, 77, 2, 8};
                const auto pixels = noise(odd + layout.pixel_bytes(), 1);
                std::vector<std::byte> room(layout.bytes() + 48, std::byte{0xc3});
                const auto planes = std::span(room).subspan(16 - odd, layout.bytes());
                REQUIRE(split_bit_planes(layout, std::span(pixels).subspan(odd), planes, way.method) == Status::Ok);
                INFO(way.name << ", " << to_string(format) << ", " << odd << " bytes off");
                check(layout, std::span(pixels).subspan(odd), planes);
                const auto untouched = [](std::byte byte) { return byte == std::byte{0xc3}; };
                CHECK(std::all_of(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(16 - odd), untouched));
                CHECK(std::all_of(room.end() - static_cast<std::ptrdiff_t>(32 + odd), room.end(), untouched));
            }
        }
    }
}

TEST_CASE("the planes of two rows of rgb332 lie as they are drawn") {
    const BitPlaneLayout layout{PixelFormat::Rgb332, 10, 2, 2};
    CHECK(layout.row_planes() == 6);
    CHECK(layout.plane_bytes() == 2);
    CHECK(layout.bytes() == 24);
    CHECK(layout.offset(0, 1, 1) == 6);
    CHECK(layout.offset(1, 2, 0) == 20);
    std::vector<std::byte> pixels(20);
    pixels[0] = std::byte{0x80};   // R2
    pixels[8] = std::byte{0x40};   // R1
    pixels[9] = std::byte{0x24};   // R0, which is not shown, and G0 likewise
    pixels[10] = std::byte{0x03};  // row 1: B1, B0
    for (const Way& way : ways()) {
        std::vector<std::byte> planes(24);
        REQUIRE(split_bit_planes(layout, pixels, planes, way.method) == Status::Ok);
        std::vector<std::byte> drawing(24);
        drawing[0] = std::byte{0x01};
        drawing[3] = std::byte{0x01};
        drawing[20] = std::byte{0x01};
        drawing[22] = std::byte{0x01};
        CHECK(planes == drawing);
    }
}

TEST_CASE("what is behind the last pixel of a row is not looked at") {
    for (const Way& way : ways()) {
        for (const PixelFormat format :
             {PixelFormat::Mono1, PixelFormat::Mono2, PixelFormat::Rgb111, PixelFormat::Mono4, PixelFormat::Rgb555}) {
            const BitPlaneLayout layout{format, 3, 1, 8};
            const std::vector<std::byte> pixels(layout.pixel_bytes(), std::byte{0xff});
            std::vector<std::byte> planes(layout.bytes());
            REQUIRE(split_bit_planes(layout, pixels, planes, way.method) == Status::Ok);
            INFO(way.name << ", " << to_string(format));
            CHECK(planes == std::vector<std::byte>(layout.bytes(), std::byte{0x07}));
        }
    }
}

TEST_CASE("bit planes are not made where they have no room, nor of what is no layout") {
    const BitPlaneLayout layout{PixelFormat::Rgb565, 16, 2, 3};
    std::vector<std::byte> pixels(layout.pixel_bytes(), std::byte{0xff});
    std::vector<std::byte> planes(layout.bytes());
    const auto refused = [&](const BitPlaneLayout& wrong, std::size_t pixel_bytes, std::size_t plane_bytes) {
        const Status status =
            device::split_bit_planes(wrong, std::span(pixels).first(pixel_bytes), std::span(planes).first(plane_bytes));
        return status == Status::InvalidArgument && planes == std::vector<std::byte>(layout.bytes());
    };
    CHECK(refused(layout, pixels.size() - 1, planes.size()));
    CHECK(refused(layout, pixels.size(), planes.size() - 1));
    CHECK(refused({PixelFormat::Rgb565, 0, 2, 3}, pixels.size(), planes.size()));
    CHECK(refused({PixelFormat::Rgb565, 16, 2, 0}, pixels.size(), planes.size()));
    CHECK(refused({PixelFormat::Rgb565, 1, 1, 9}, pixels.size(), planes.size()));
    CHECK(refused({PixelFormat{0}, 16, 2, 3}, pixels.size(), planes.size()));
    CHECK(refused({PixelFormat::Rgb565, 0x10000, 2, 3}, pixels.size(), planes.size()));
    CHECK(refused({PixelFormat::Rgb888, 16, 0x8000'0000, 8}, pixels.size(), planes.size()));
    CHECK(BitPlaneLayout{PixelFormat::Rgb888, 16, 0x8000'0000, 8}.bytes() == std::size_t{0x8000'0000} * 24 * 2);
    CHECK(device::split_bit_planes(layout, pixels, planes) == Status::Ok);
}
