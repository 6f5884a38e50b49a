// The header of a PLY file: which elements follow, and what is in them. Private to voxelizer/io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "voxelizer/error.h"

namespace xorvox::io {

enum class PlyEncoding : std::uint8_t { Ascii, BinaryLittleEndian, BinaryBigEndian };
enum class PlyType : std::uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

constexpr std::size_t size_of(PlyType type) {
    switch (type) {
        case PlyType::Int8:
        case PlyType::Uint8: return 1;
        case PlyType::Int16:
        case PlyType::Uint16: return 2;
        case PlyType::Int32:
        case PlyType::Uint32:
        case PlyType::Float32: return 4;
        case PlyType::Float64: return 8;
    }
    return 0;
}
constexpr bool is_integer(PlyType type) {
    return type != PlyType::Float32 && type != PlyType::Float64;
}

/// What a property means to us.
enum class PlyRole : std::uint8_t { Skipped, X, Y, Z, Red, Green, Blue, Corners };

struct PlyProperty {
    PlyRole role = PlyRole::Skipped;
    bool is_list = false;
    PlyType count_type = PlyType::Uint8;  ///< Of a list's length; always an integer.
    PlyType type = PlyType::Float32;
};

struct PlyElement {
    std::string_view name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::Ascii;
    std::vector<PlyElement> elements;
    std::uint64_t vertex_count = 0;
    bool has_colors = false;      ///< Vertices have all of Red, Green and Blue.
    std::size_t data_offset = 0;  ///< The first byte after the header.
    std::size_t data_line = 0;    ///< Its line, counted from 1.
};

/// Reads the header at the beginning of `bytes`. The result has exactly one element `vertex`, with roles X, Y and Z,
/// and one element `face`, with the role Corners; the names are borrowed from `bytes`.
Expected<PlyHeader> parse_ply_header(std::string_view bytes, std::string_view source);

}  // namespace xorvox::io
