// Names: what the values of a description's enumerations are called in display files and in C++.
#pragma once

#include <span>
#include <string_view>

#include "driver/display/description.h"

namespace xorvox::display {

/// One value of an enumeration.
template <class Enum>
struct Named {
    Enum value;
    std::string_view name;  ///< In a display file.
    std::string_view cpp;   ///< The enumerator.
};

inline constexpr Named<DisplayKind> kKindNames[] = {
    {DisplayKind::StackedPlanes, "stacked-planes", "StackedPlanes"},
    {DisplayKind::RotatingPanel, "rotating-panel", "RotatingPanel"},
    {DisplayKind::SweptPlane, "swept-plane", "SweptPlane"},
    {DisplayKind::Helix, "helix", "Helix"},
    {DisplayKind::FreePoints, "free-points", "FreePoints"},
};

inline constexpr Named<PixelFormat> kFormatNames[] = {
    {PixelFormat::Mono1, to_string(PixelFormat::Mono1), "Mono1"},
    {PixelFormat::Mono2, to_string(PixelFormat::Mono2), "Mono2"},
    {PixelFormat::Rgb111, to_string(PixelFormat::Rgb111), "Rgb111"},
    {PixelFormat::Mono4, to_string(PixelFormat::Mono4), "Mono4"},
    {PixelFormat::Rgb332, to_string(PixelFormat::Rgb332), "Rgb332"},
    {PixelFormat::Rgb555, to_string(PixelFormat::Rgb555), "Rgb555"},
    {PixelFormat::Rgb565, to_string(PixelFormat::Rgb565), "Rgb565"},
    {PixelFormat::Rgb888, to_string(PixelFormat::Rgb888), "Rgb888"},
};

inline constexpr Named<MotionProfile> kProfileNames[] = {
    {MotionProfile::Constant, "constant", "Constant"},
    {MotionProfile::Sine, "sine", "Sine"},
    {MotionProfile::Table, "table", "Table"},
};

inline constexpr Named<IndexSource> kIndexNames[] = {
    {IndexSource::None, "none", "None"},
    {IndexSource::Pulses, "pulses", "Pulses"},
    {IndexSource::Encoder, "encoder", "Encoder"},
};

inline constexpr Named<DriverChip> kDriverNames[] = {
    {DriverChip::Direct, "direct", "Direct"},
    {DriverChip::Hub75, "hub75", "Hub75"},
    {DriverChip::ShiftRegister595, "74hc595", "ShiftRegister595"},
    {DriverChip::Ws2812, "ws2812", "Ws2812"},
    {DriverChip::Apa102, "apa102", "Apa102"},
    {DriverChip::Dlp, "dlp", "Dlp"},
};

inline constexpr Named<Response> kResponseNames[] = {
    {Response::Linear, "linear", "Linear"},
    {Response::Gamma, "gamma", "Gamma"},
    {Response::Srgb, "srgb", "Srgb"},
    {Response::Cie1931, "cie1931", "Cie1931"},
};

inline constexpr Named<bool> kBitOrderNames[] = {{true, "msb-first", "true"}, {false, "lsb-first", "false"}};
inline constexpr Named<bool> kRegisterOrderNames[] = {{false, "pixels-first", "false"}, {true, "layers-first", "true"}};

/// The entry of `value`; nullptr if it has none.
template <class Enum, std::size_t N>
constexpr const Named<Enum>* find_named(const Named<Enum> (&names)[N], Enum value) {
    for (const Named<Enum>& named : names) {
        if (named.value == value) return &named;
    }
    return nullptr;
}

/// What `value` is called in a display file; "unknown" if it has no name.
template <class Enum, std::size_t N>
constexpr std::string_view name_of(const Named<Enum> (&names)[N], Enum value) {
    const Named<Enum>* named = find_named(names, value);
    return named == nullptr ? "unknown" : named->name;
}

constexpr std::string_view kind_name(DisplayKind kind) {
    return name_of(kKindNames, kind);
}

}  // namespace xorvox::display
