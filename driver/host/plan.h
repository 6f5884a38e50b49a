// Plan: whether a display's frames fit its link, its scan-out, its supply and its controller. Arithmetic on a
// description; nothing is opened or sent.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "driver/display/description.h"
#include "driver/host/example_frames.h"
#include "driver/host/slice_map.h"
#include "voxelizer/error.h"

namespace xorvox::host {

/// What a link carries at best.
struct LinkCeiling {
    std::string_view name;  ///< As on the command line.
    std::string_view what;
    double bytes_per_second = 0.0;  ///< 0 in the table for gpio: that depends on its rate.
};
/// Every link, in the order of the help. Static storage.
std::span<const LinkCeiling> link_ceilings();

/// The link of this name; gpio with its rate: how often a second its 8 lines change, one byte each time, from 1 to
/// 1e10. The message for another name lists the links; a rate that is missing, of another link or out of range is
/// refused.
Expected<LinkCeiling> find_link(std::string_view name, std::optional<double> gpio_rate_hz);

enum class Fit : std::uint8_t { No, Compressed, Raw };

/// Frames on the link. Rates are bytes a second, of a frame every cycle of the display.
struct LinkPlan {
    Fit fit = Fit::No;                        ///< Compressed: the example's moving frames, in either colouring.
    double frame_wire_bytes = 0.0;            ///< Raw, with packet headers.
    double compressed_frame_bytes = 0.0;      ///< The larger of the example's moving frames.
    double rate_raw = 0.0;                    ///< Needed.
    double rate_compressed = 0.0;             ///< Needed.
    double frames_per_second_raw = 0.0;       ///< That the link allows.
    double frames_per_second_compressed = 0;  ///< That the link allows.
    std::uint32_t slices_raw = 0;             ///< Most of the display's slices at its rate; 0: not even one.
    std::uint32_t slices_compressed = 0;      ///< The same, taking the example's slices for like.
    std::vector<PixelFormat> formats_raw;     ///< Of at most as many bits as the display's: those that fit raw.
};

/// One slice on the panel. 0: unknown.
struct ScanPlan {
    double slice_ns = 0.0;           ///< That a slice has; where LEDs keep their light, that a frame has.
    double scan_ns = 0.0;            ///< That it takes.
    std::uint32_t planes_shown = 0;  ///< Bit planes a channel.
    std::uint32_t planes_fit = 0;    ///< The most that the slice's time has room for.
    double slices_fit = 0.0;         ///< The most slices of planes_shown; 0 as well where LEDs keep their light.
    double projector_hz = 0.0;       ///< Dlp: RGB frames of the projector a second.
};

/// All pixels white. 0: unknown.
struct CurrentPlan {
    std::uint64_t lit_leds = 0;  ///< At the same time; a pixel of three colours counts three.
    double all_white_ma = 0.0;
    double limit_ma = 0.0;
    double white_part = 1.0;  ///< The part of the pixels that may be white at once before the device dims.
};

/// Memory of the device half.
struct MemoryPlan {
    std::uint64_t page_bytes = 0;
    std::uint64_t packet_bytes = 0;
    std::uint64_t state_bytes = 0;
    std::uint64_t two_pages_bytes = 0;  ///< All of it.
    std::uint64_t three_pages_bytes = 0;
};

struct MotionPlan {
    double turns_per_second = 0.0;  ///< Of rotors and helices.
    double rim_mm = 0.0;            ///< Radius of what turns, as far as pixels reach.
    double fastest_m_per_s = 0.0;   ///< Of the rim, or of a swept plane.
};

struct Plan {
    std::uint64_t samples = 0;                      ///< Of a frame.
    std::array<std::uint32_t, 3> cartesian_size{};  ///< Of cartesian_grid().
    SliceCoverage bright;                           ///< How its voxels are lit when all samples are,
    SliceCoverage uniform;                          ///< and in uniform mode.
    double frames_per_second = 0.0;
    LinkPlan link;
    ScanPlan scan;
    CurrentPlan current;
    MemoryPlan memory;
    MotionPlan motion;
};

/// `display` must be valid (validate_display). `device_state_bytes`: sizeof of what the device half keeps besides pages
/// and packet.
Plan make_plan(const DisplayDescription& display, const LinkCeiling& link, const ExampleFrames& example,
               std::uint64_t device_state_bytes);

/// A format in which the display could be driven, and at what rate.
struct FormatRate {
    PixelFormat format{};
    double frames_per_second = 0.0;
};

/// In each format of at most as many bits as the display's, from the most bits on: the frames a second that the link
/// allows, compressed as measure_example(…, most_samples) makes them; no more than the display shows. `display` must be
/// valid. Fails, and throws, like measure_example().
Expected<std::vector<FormatRate>> compressed_rates(const DisplayDescription& display, const LinkCeiling& link,
                                                   std::uint64_t most_samples);

/// A controller that people build displays with.
struct Controller {
    std::string_view name;
    std::uint64_t ram_bytes;
};
/// From the smallest on. Static storage.
std::span<const Controller> common_controllers();

/// Whether `bytes` leave a quarter of the RAM to the program.
constexpr bool fits(const Controller& controller, std::uint64_t bytes) {
    return bytes <= controller.ram_bytes / 4 * 3;
}

}  // namespace xorvox::host
