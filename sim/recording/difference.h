// Difference: where two frames, or two recordings, first show something else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "driver/display/description.h"
#include "sim/recording/reader.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

/// A pixel whose codes differ.
struct PixelDifference {
    std::uint32_t slice = 0;
    std::uint32_t panel = 0;
    std::uint32_t row = 0;
    std::uint32_t column = 0;  ///< The panel's columns: none of them, but the padding behind the row.
    std::uint32_t code_a = 0;
    std::uint32_t code_b = 0;

    bool operator==(const PixelDifference&) const = default;
};

/// How two frames of a display differ.
struct FrameDifference {
    PixelDifference first;   ///< In scan-out order.
    std::size_t pixels = 0;  ///< How many differ.
};

/// Both are frame_bytes(display) long. Nothing: they are equal.
std::optional<FrameDifference> compare_frames(const DisplayDescription& display, std::span<const std::byte> a,
                                              std::span<const std::byte> b);

/// How two recordings first differ.
struct RecordingDifference {
    enum class What : std::uint8_t {
        Geometry,  ///< They are of different displays.
        Frame,     ///< `frame` differs: see `pixels`.
        MoreInA,   ///< B ends after `frame` frames, A does not;
        MoreInB,   ///< the other way round.
    };
    What what{};
    std::uint64_t frame = 0;  ///< Number, from 0.
    FrameDifference pixels;
};

/// Compares the whole frames that were sent, one by one. Times, the cutting and compression of packets, deltas, what
/// the devices answered, controls and pings do not matter. Nothing: equal. An Error: one of them is damaged, or neither
/// has a frame.
Expected<std::optional<RecordingDifference>> compare_recordings(RecordingReader& a, RecordingReader& b);

/// One line: "frame 3, slice 12, panel 0, row 5, column 7: code 0xe0 in a.xvr, 0x1c in b.xvr; 214 pixels differ".
std::string describe(const RecordingDifference& difference, const RecordingReader& a, const RecordingReader& b);

}  // namespace xorvox::sim
