// Description: what a display is, in plain constexpr structs that firmware, host and simulator share.
//
// The world's frame is in millimetres, right-handed, z up. A display is a set of LEDs or projected pixels on flat
// panels; what makes it volumetric is where the panels are at each phase of its cycle, which gives one frame:
//
//   stacked planes   `slices` copies of panel 0, one above the other, `plane_pitch_mm` apart, the stack's centre at the
//                    origin; or, where they are not even, at plane_heights_mm. Plane 0 is the lowest. Columns run along
//                    +x, rows along +y. No motion.
//
//   swept plane      Panel 0 lies flat, columns along +x, rows along +y, and moves up and down along z; `slices` images
//                    are lit at equal steps of time in the lit part of an upward sweep. Slice s is the s-th from below
//                    and stands at  z = stroke·(h(u) − ½),  u = dead + (s + ½)/S·(1 − 2·dead),  where h is the motion
//                    profile: h(u) = u (constant), (1 − cos πu)/2 (sine), or a measured table. With `both_ways` the
//                    downward sweep, which mirrors the upward one in time, lights the same slices from the top one on;
//                    without, the plane flies back dark. One frame is one cycle: up, and down or back.
//
//   rotating panel   `panel_count` panels that turn about the z axis. At phase 0 a panel with angle_deg = 0 stands
//                    in the xz plane: columns run along +x, rows downwards (row 0 is the top one), its normal is -y.
//
//                                 z, axis
//                      row 0   ┌────┼────┐          From above, turning counter-clockwise by θ = phase + angle_deg:
//                              │    │    │            along  u = ( cos θ, sin θ)
//                      row 63  └────┼────┘            normal n = ( sin θ, -cos θ)    towards who looks at it
//                         column 0 … 127              LED    = u·(shift_mm + a) + n·(offset_mm + o + b·sin tilt)
//                                                              + z·(lift_mm + b·cos tilt)
//
//                    (a, b) is the LED's place on the panel's face, a to the right and b upwards as seen by who looks
//                    at it; `o` is skew_mm on odd columns, and 0 on even ones. Of column c and row r:
//                      a = (c − (columns−1)/2)·column_pitch_mm     negated where the panel is mirrored
//                      b = ((rows−1)/2 − r)·row_pitch_mm
//                    and then (a, b) turned counter-clockwise about the panel's centre by `turned` quarter turns:
//                    one of them makes (−b, a).
//                    Slice s of S is lit while the phase is between s and s + 1 S-ths of sweep_deg; its samples stand
//                    where the LEDs are in the middle of that, at (s + ½)/S of it. One frame is one sweep: a turn, or
//                    half a turn (sweep_deg = 180), after which the device shows it again, mirrored. With `clockwise`
//                    the phase runs the other way: θ = −phase + angle_deg.
//
//   helix            A screen of `blades` equal helical surfaces, each as high as `stroke_mm` and 1/blades of a turn
//                    wide, turns about z under a projector that looks along z. Panel 0 is the projector's image:
//                    columns along +x, rows along +y, its centre on the axis. Where the image meets the screen at the
//                    polar angle α, at phase φ (of 0 … 1 in 1/blades of a turn), the height is
//                      z = stroke·(frac(blades·α/2π − φ) − ½)      counter-clockwise, rising with α; `clockwise` + φ
//                    Slice s of S is lit at φ = (s + ½)/S. One frame is 1/blades of a turn.
//
//   free points      LEDs glued anywhere: `points`, columns × rows of panel 0, row after row. One slice. No motion.
//
// A frame on the wire, and a page of the device, is in scan-out order:
//
//   slice 0: panel 0: row 0: column 0, 1, 2 …, row 1 …; panel 1 …; slice 1 …
//
// Pixels of a row follow each other without gaps, least significant bit first; each row begins at a byte. Column c of a
// row has the bits c·bpp … c·bpp + bpp − 1. Bits within a pixel, least significant first:
//
//   mono1   lit                      mono2, mono4  the level        rgb111  R, G, B
//   rgb332  B1 B0, G2…G0, R2…R0      (a byte RRRGGGBB)
//   rgb555  B4…B0, G4…G0, R4…R0      (15 bits RRRRRGGGGGBBBBB, no padding bit)
//   rgb565  B4…B0, G5…G0, R4…R0      (a little-endian 16-bit word RRRRRGGGGGGBBBBB)
//   rgb888  R7…R0, G7…G0, B7…B0      (bytes R, G, B)
//
// How much light a code gives: struct Light. Freestanding; everyone may include this file.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "voxelizer/status.h"

namespace xorvox {

/// What the panels do. The numbers are part of the geometry digest: never renumber.
enum class DisplayKind : std::uint8_t {
    StackedPlanes = 1,
    RotatingPanel = 2,
    SweptPlane = 3,
    Helix = 4,
    FreePoints = 5
};

/// Bits of a pixel; the drawing at the head of this file. The numbers are on the wire: never renumber.
enum class PixelFormat : std::uint8_t {
    Mono1 = 1,
    Rgb111 = 2,
    Rgb332 = 3,
    Rgb565 = 4,
    Rgb888 = 5,
    Rgb555 = 6,
    Mono2 = 7,
    Mono4 = 8,
};
/// Every format, from the fewest bits on.
inline constexpr std::array kPixelFormats{PixelFormat::Mono1,  PixelFormat::Mono2,  PixelFormat::Rgb111,
                                          PixelFormat::Mono4,  PixelFormat::Rgb332, PixelFormat::Rgb555,
                                          PixelFormat::Rgb565, PixelFormat::Rgb888};

constexpr std::uint32_t bits_per_pixel(PixelFormat format) {
    switch (format) {
        case PixelFormat::Mono1: return 1;
        case PixelFormat::Mono2: return 2;
        case PixelFormat::Rgb111: return 3;
        case PixelFormat::Mono4: return 4;
        case PixelFormat::Rgb332: return 8;
        case PixelFormat::Rgb555: return 15;
        case PixelFormat::Rgb565: return 16;
        case PixelFormat::Rgb888: return 24;
    }
    return 0;
}

/// Bits of the channel that has most of them: the bit planes of a panel that shows all of a pixel.
constexpr std::uint32_t bits_per_channel(PixelFormat format) {
    switch (format) {
        case PixelFormat::Mono1: return 1;
        case PixelFormat::Mono2: return 2;
        case PixelFormat::Rgb111: return 1;
        case PixelFormat::Mono4: return 4;
        case PixelFormat::Rgb332: return 3;
        case PixelFormat::Rgb555: return 5;
        case PixelFormat::Rgb565: return 6;
        case PixelFormat::Rgb888: return 8;
    }
    return 0;
}

/// Whether a pixel is one LED of one colour.
constexpr bool is_mono(PixelFormat format) {
    return bits_per_pixel(format) == bits_per_channel(format);
}
constexpr std::uint32_t channel_count(PixelFormat format) {
    return is_mono(format) ? 1 : 3;
}

constexpr std::string_view to_string(PixelFormat format) {
    switch (format) {
        case PixelFormat::Mono1: return "mono1";
        case PixelFormat::Mono2: return "mono2";
        case PixelFormat::Rgb111: return "rgb111";
        case PixelFormat::Mono4: return "mono4";
        case PixelFormat::Rgb332: return "rgb332";
        case PixelFormat::Rgb555: return "rgb555";
        case PixelFormat::Rgb565: return "rgb565";
        case PixelFormat::Rgb888: return "rgb888";
    }
    return "unknown";
}

/// A name of at most 31 bytes of UTF-8, zero-padded: it has a fixed place in firmware and on the wire.
struct DisplayName {
    std::array<char, 32> text{};

    constexpr DisplayName() = default;
    /// Cuts after 31 bytes.
    constexpr DisplayName(std::string_view from) {
        for (std::size_t i = 0; i < from.size() && i + 1 < text.size(); ++i) text[i] = from[i];
    }
    constexpr std::string_view view() const {
        std::size_t n = 0;
        while (n < text.size() && text[n] != '\0') ++n;
        return {text.data(), n};
    }
};

/// One flat panel of columns × rows pixels and its place on the display; the drawing at the head of this file. From
/// shift_mm to turned, only rotating panels may differ from the defaults.
struct Panel {
    std::uint16_t columns = 0;     ///< 1 … 4096.
    std::uint16_t rows = 0;        ///< 1 … 4096.
    double column_pitch_mm = 1.0;  ///< Between neighbours of a row; positive.
    double row_pitch_mm = 1.0;     ///< Between rows; positive.
    double shift_mm = 0.0;         ///< Of the panel's centre along u: half a pitch where the axis is on an LED.
    double offset_mm = 0.0;        ///< Of the light from the axis, along the panel's normal.
    double lift_mm = 0.0;          ///< Of the panel's centre along z.
    double angle_deg = 0.0;        ///< How it is mounted about the axis: 180 for the back one of a pair.
    double tilt_deg = 0.0;         ///< How far its upper edge leans towards who looks at it; between −90 and 90.
    double skew_mm = 0.0;          ///< By how much odd columns stand further out along the normal than even ones.
    bool mirrored = false;         ///< Its columns run from right to left.
    std::uint8_t turned = 0;  ///< Quarter turns, counter-clockwise as seen by who looks at it, after mirroring; 0 … 3.
    std::uint8_t connector = 0;       ///< The plug of the controller, 0 … 7, that its chain begins at.
    std::uint8_t chain_position = 0;  ///< Its place in the chain at that plug, 0 … 7, 0 next to the controller.
};

/// How a plane moves over one upward sweep.
enum class MotionProfile : std::uint8_t { Constant = 1, Sine = 2, Table = 3 };
inline constexpr std::size_t kMaxMotionTable = 64;

/// The movement of a swept plane, or the height of a helix.
struct Motion {
    double stroke_mm = 0.0;  ///< From the lowest to the highest place; positive.
    MotionProfile profile = MotionProfile::Constant;
    bool both_ways = false;  ///< Lit on the way down as well.
    double dead_zone = 0.0;  ///< The part of a sweep, at each of its ends, in which nothing is lit; 0 … 0.45.
    /// Table: heights as parts of the stroke, increasing from 0 to 1, at equal steps of time; straight between them.
    std::uint32_t table_size = 0;
    std::array<double, kMaxMotionTable> table{};
};

/// What tells the device where the display is in its turn or sweep.
enum class IndexSource : std::uint8_t {
    None = 0,    ///< Free-running: nothing moves, or the device's clock is the master.
    Pulses = 1,  ///< `index_pulses` a turn, equally spaced; one per half turn is 2. On a swept plane: a cycle.
    Encoder = 2  ///< A counter of `index_pulses` steps a turn with one mark, and a direction.
};

struct Sync {
    IndexSource index = IndexSource::None;
    std::uint32_t index_pulses = 1;          ///< 1 … 65536.
    double index_phase = 0.0;                ///< Phase of the cycle at the (first) mark, in cycles: 0 to below 1.
    double slowest_cycles_per_second = 0.0;  ///< Slower is a stall. 0: half of cycles_per_second.
    double fastest_cycles_per_second = 0.0;  ///< Faster is an overspeed. 0: a quarter more than cycles_per_second.
};

/// What drives the LEDs or mirrors.
enum class DriverChip : std::uint8_t {
    Direct = 0,            ///< Every pixel has its own wire, or nothing is known.
    Hub75 = 1,             ///< Shift registers for each half of the rows, and a row address.
    ShiftRegister595 = 2,  ///< 74HC595 in chains: the pixels of a layer, and a bit a layer to select it.
    Ws2812 = 3,            ///< Addressable strings; the LEDs keep their colour.
    Apa102 = 4,            ///< Addressable strings with a clock.
    Dlp = 5,               ///< A projector of switching mirrors.
};

/// How a slice is shown. 0 in a time or rate: unknown, and then not reckoned with.
struct Scan {
    DriverChip driver = DriverChip::Direct;
    std::uint32_t pixel_clock_hz = 0;  ///< Shifts a second of one chain; bits a second of one string.
    std::uint32_t latch_ns = 0;        ///< From the last shift to light; the pause that ends a string's data.
    std::uint32_t min_on_ns = 0;       ///< The shortest light: output enable of the least bit plane.
    std::uint32_t rise_ns = 0;
    std::uint32_t fall_ns = 0;
    std::uint16_t row_groups =
        1;  ///< Scan multiplexing: rows are lit in so many groups, one after the other; 1 … 4096.
    std::uint8_t bit_planes = 0;        ///< Bits a channel that are shown, the most significant ones; 0: all.
    std::uint8_t strings = 1;           ///< Data lines of addressable LEDs that are fed at the same time.
    std::uint8_t planes_per_frame = 1;  ///< Dlp: one-bit slices in one RGB frame of the projector; 1 … 24.
    bool msb_first = true;              ///< Bits go out most significant first.
    bool layers_first = false;          ///< ShiftRegister595: the layer's bits are shifted out before the pixels'.
    bool serpentine = false;            ///< Strings: every other row runs backwards.
    std::array<char, 3> color_order{'r', 'g', 'b'};  ///< In which channels go out; each once.
};

/// What light a code of a channel gives, as a part of the most. v is level ÷ highest level, of the bits that are shown
/// (shown_bit_planes).
enum class Response : std::uint8_t {
    Linear = 0,  ///< v: LEDs that are lit for a time proportional to the code.
    Gamma = 1,   ///< v to the power of `gamma`: a table in the controller or projector.
    Srgb = 2,    ///< IEC 61966-2-1.
    Cie1931 = 3  ///< The luminance whose lightness is v: steps that look equal (CIE 1976 L*, of 1931's observer).
};

struct Light {
    Response response = Response::Linear;
    double gamma = 2.2;  ///< Of Response::Gamma: 1 … 4.
};

/// What light draws. 0: unknown, and then not limited.
struct Power {
    double led_ma = 0.0;    ///< Of one channel of one LED while it is lit.
    double max_duty = 1.0;  ///< The part of the time for which an LED may be lit, above 0 to 1.
    double limit_ma = 0.0;  ///< What the supply gives, with led_ma known: the device dims a slice that would draw
                            ///< more on average.
};

/// A place in millimetres.
struct PointMm {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
};

inline constexpr std::size_t kMaxPanels = 8;
inline constexpr std::uint32_t kMaxSlices = 4096;

/// A whole display. Build one in firmware as a constexpr (`xorvox displays NAME --cpp` writes it), or read it from TOML
/// (driver/display/toml.h).
struct DisplayDescription {
    DisplayName name;
    DisplayKind kind = DisplayKind::StackedPlanes;
    PixelFormat format = PixelFormat::Mono1;
    std::uint32_t slices = 0;        ///< Of a frame. 1 … kMaxSlices; 1 of free points.
    double cycles_per_second = 0.0;  ///< Frames that the display shows a second: turns, half turns, sweeps, refreshes.
    double plane_pitch_mm = 1.0;     ///< Stacked planes only, where they are even.
    double sweep_deg = 360.0;        ///< Rotating panels only: 360 or 180, the latter with offset, shift and skew 0.
    bool clockwise = false;          ///< Seen from above. Rotating panels and helix only.
    std::uint32_t blades = 1;        ///< Helix only; 1 … 8.
    Motion motion;                   ///< Swept plane; of a helix stroke_mm alone.
    std::uint32_t panel_count = 1;   ///< 1 … kMaxPanels; 1 except on rotating panels.
    std::array<Panel, kMaxPanels> panels{};
    /// Free points only: columns × rows of panel 0. Borrowed: must outlive every copy of the description.
    std::span<const PointMm> points;
    /// Stacked planes that are not even only: z of each, increasing. Borrowed likewise; empty: plane_pitch_mm counts.
    std::span<const double> plane_heights_mm;

    // How it is driven; not part of the geometry.
    Sync sync;
    Scan scan;
    Light light;
    Power power;
};

/// Turns, or sweeps up and back, a second.
constexpr double turns_per_second(const DisplayDescription& display) {
    switch (display.kind) {
        case DisplayKind::RotatingPanel: return display.cycles_per_second * display.sweep_deg / 360.0;
        case DisplayKind::Helix: return display.cycles_per_second / display.blades;
        default: return display.cycles_per_second;
    }
}
/// Whether its LEDs are addressable strings.
constexpr bool has_strings(const DisplayDescription& display) {
    return display.scan.driver == DriverChip::Ws2812 || display.scan.driver == DriverChip::Apa102;
}
/// Whether its LEDs keep their colour until the next frame, so that they are sent a frame at once and a slice has no
/// time of its own: strings that do not move.
constexpr bool keeps_light(const DisplayDescription& display) {
    const bool moves = display.kind != DisplayKind::StackedPlanes && display.kind != DisplayKind::FreePoints;
    return has_strings(display) && !moves;
}
/// Bits a channel that are shown.
constexpr std::uint32_t shown_bit_planes(const DisplayDescription& display) {
    return display.scan.bit_planes == 0 ? bits_per_channel(display.format) : display.scan.bit_planes;
}
/// The part of the time for which an LED is lit that is fully on, at full brightness: rows take turns, and so do the
/// planes of a stack, but for those of a projector.
constexpr double full_duty(const DisplayDescription& display) {
    const double duty = 1.0 / display.scan.row_groups;
    const bool planes_take_turns = display.kind == DisplayKind::StackedPlanes && !keeps_light(display);
    return planes_take_turns && display.scan.driver != DriverChip::Dlp ? duty / display.slices : duty;
}
/// The most brightness, of 255, that power.max_duty allows an LED that is fully on; 0: it would never be lit.
constexpr std::uint8_t most_brightness(const DisplayDescription& display) {
    const double most = 255.0 * display.power.max_duty / full_duty(display);
    return static_cast<std::uint8_t>(most < 255.0 ? most : 255.0);
}
/// Bytes of one row of `panel`.
constexpr std::size_t row_bytes(const Panel& panel, PixelFormat format) {
    return (std::size_t{panel.columns} * bits_per_pixel(format) + 7) / 8;
}
/// Bytes of one slice: every row of every panel.
constexpr std::size_t slice_bytes(const DisplayDescription& display) {
    std::size_t bytes = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        bytes += row_bytes(display.panels[p], display.format) * display.panels[p].rows;
    }
    return bytes;
}
/// Bytes of one frame, which is one page of the device.
constexpr std::size_t frame_bytes(const DisplayDescription& display) {
    return slice_bytes(display) * display.slices;
}
/// Pixels of one frame.
constexpr std::size_t frame_pixels(const DisplayDescription& display) {
    std::size_t pixels = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        pixels += std::size_t{display.panels[p].columns} * display.panels[p].rows;
    }
    return pixels * display.slices;
}
/// Length of a cycle, which shows one frame, in nanoseconds.
constexpr std::uint64_t cycle_ns(const DisplayDescription& display) {
    return static_cast<std::uint64_t>(1e9 / display.cycles_per_second + 0.5);
}

/// A number that differs when the meaning of a frame's bytes differs: kind, format, slices and every pose, but neither
/// the name, the speed nor how it is driven. Host and device compare it before a frame is sent. FNV-1a over the fields,
/// 64 bits, as driver/PROTOCOL.md lists them.
constexpr std::uint64_t geometry_digest(const DisplayDescription& display) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&hash](std::uint64_t value) {
        for (int byte = 0; byte < 8; ++byte) {
            hash = (hash ^ ((value >> (8 * byte)) & 0xff)) * 0x100000001b3u;
        }
    };
    // -0 is 0; told apart by its bits, because firmware computes this without floating point.
    const auto add_mm = [&add](double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        add(bits == std::uint64_t{1} << 63 ? 0 : bits);
    };
    add(static_cast<std::uint64_t>(display.kind));
    add(static_cast<std::uint64_t>(display.format));
    add(display.slices);
    add_mm(display.plane_pitch_mm);
    add_mm(display.sweep_deg);
    add(display.clockwise ? 1 : 0);
    add(display.blades);
    add_mm(display.motion.stroke_mm);
    add(static_cast<std::uint64_t>(display.motion.profile));
    add(display.motion.both_ways ? 1 : 0);
    add_mm(display.motion.dead_zone);
    add(display.motion.table_size);
    for (std::uint32_t i = 0; i < display.motion.table_size; ++i) add_mm(display.motion.table[i]);
    add(display.panel_count);
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        add(panel.columns);
        add(panel.rows);
        add_mm(panel.column_pitch_mm);
        add_mm(panel.row_pitch_mm);
        add_mm(panel.shift_mm);
        add_mm(panel.offset_mm);
        add_mm(panel.lift_mm);
        add_mm(panel.angle_deg);
        add_mm(panel.tilt_deg);
        add_mm(panel.skew_mm);
        add(panel.mirrored ? 1 : 0);
        add(panel.turned);
    }
    add(display.plane_heights_mm.size());
    for (const double height : display.plane_heights_mm) add_mm(height);
    add(display.points.size());
    for (const PointMm& point : display.points) {
        add_mm(point.x);
        add_mm(point.y);
        add_mm(point.z);
    }
    return hash;
}

}  // namespace xorvox
