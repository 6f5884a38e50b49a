// The names that a NRRD header may have: of its fields, types, spaces and units;
// https://teem.sourceforge.net/nrrd/format.html. Private to voxelizer/io.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include <glm/vec3.hpp>

#include "voxelizer/io/voxel_numbers.h"

namespace xorvox::io::nrrd {

/// Fields that say nothing about what is where.
inline constexpr std::array<std::string_view, 17> kPassedOver{
    "number",    "min",         "max",         "old min",    "oldmin",
    "old max",   "oldmax",      "thicknesses", "axis mins",  "axismins",
    "axis maxs", "axismaxs",    "centers",     "centerings", "measurement frame",
    "labels",    "sample units"};
/// Fields that are read.
inline constexpr std::array<std::string_view, 18> kUsed{
    "content",         "dimension",   "type",         "block size",       "blocksize", "encoding",
    "endian",          "kinds",       "sizes",        "spacings",         "space",     "units",
    "space dimension", "space units", "space origin", "space directions", "data file", "datafile"};
inline constexpr std::array<std::string_view, 4> kSkips{"line skip", "lineskip", "byte skip", "byteskip"};

struct TypeName {
    std::string_view name;
    NumberType type;
};
inline constexpr TypeName kTypes[] = {
    {"signed char", NumberType::Int8},
    {"int8", NumberType::Int8},
    {"int8_t", NumberType::Int8},
    {"uchar", NumberType::UInt8},
    {"unsigned char", NumberType::UInt8},
    {"uint8", NumberType::UInt8},
    {"uint8_t", NumberType::UInt8},
    {"short", NumberType::Int16},
    {"short int", NumberType::Int16},
    {"signed short", NumberType::Int16},
    {"signed short int", NumberType::Int16},
    {"int16", NumberType::Int16},
    {"int16_t", NumberType::Int16},
    {"ushort", NumberType::UInt16},
    {"unsigned short", NumberType::UInt16},
    {"unsigned short int", NumberType::UInt16},
    {"uint16", NumberType::UInt16},
    {"uint16_t", NumberType::UInt16},
    {"int", NumberType::Int32},
    {"signed int", NumberType::Int32},
    {"int32", NumberType::Int32},
    {"int32_t", NumberType::Int32},
    {"uint", NumberType::UInt32},
    {"unsigned int", NumberType::UInt32},
    {"uint32", NumberType::UInt32},
    {"uint32_t", NumberType::UInt32},
    {"longlong", NumberType::Int64},
    {"long long", NumberType::Int64},
    {"long long int", NumberType::Int64},
    {"signed long long", NumberType::Int64},
    {"signed long long int", NumberType::Int64},
    {"int64", NumberType::Int64},
    {"int64_t", NumberType::Int64},
    {"ulonglong", NumberType::UInt64},
    {"unsigned long long", NumberType::UInt64},
    {"unsigned long long int", NumberType::UInt64},
    {"uint64", NumberType::UInt64},
    {"uint64_t", NumberType::UInt64},
    {"float", NumberType::Float32},
    {"double", NumberType::Float64},
};

/// What turns an anatomical space into right-anterior-superior, axis by axis.
struct SpaceName {
    std::string_view name;
    std::string_view abbreviation;
    glm::dvec3 turn;
};
inline constexpr SpaceName kSpaces[] = {
    {"right-anterior-superior", "ras", {1, 1, 1}},
    {"left-anterior-superior", "las", {-1, 1, 1}},
    {"left-posterior-superior", "lps", {-1, -1, 1}},
    {"scanner-xyz", "", {1, 1, 1}},
    {"3d-right-handed", "", {1, 1, 1}},
};

/// Millimetres of a unit.
inline constexpr std::pair<std::string_view, double> kUnits[] = {
    {"mm", 1.0},  {"cm", 10.0}, {"m", 1000.0}, {"um", 1e-3},     {"µm", 1e-3},
    {"nm", 1e-6}, {"in", 25.4}, {"", 1.0},     {"micron", 1e-3}, {"microns", 1e-3}};

}  // namespace xorvox::io::nrrd
