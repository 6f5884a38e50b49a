// Pins: which line is which wire of a panel. Scanners set lines by these numbers, traces name them, boards are wired by
// them (docs/displays.md, "Wiring"). Plain structs: assign the fields of a board of your own.
//
//   HUB75         0 clock  1 latch  2 output enable  3 … 7 address A … E  8 … 13 r1 g1 b1 r2 g2 b2 of connector 0,
//                 14 … 19 those of connector 1, and so on
//   74HC595       0 clock (SRCLK)  1 latch (RCLK)  2 output enable (OE)  3 … 10 serial data of connectors 0 … 7
//   LED matrix    0 … G − 1 row groups; from G on a line for each LED of a group: its column
//
// Where bits come to stand. A bit that is shifted in stands at stage 0 of its register, the one at the data input, and
// moves on by a stage with each rise of the clock; so the first bit out stands farthest away. All chains have the same
// clock: one that is shorter than the longest gets zeros first, which leave it at its far end.
//
// HUB75. A panel of C columns and R rows in G groups has six registers: r1 g1 b1 hold the rows g + j·G of its upper
// half, j = 0 … n − 1 with n = R/2/G, where g is the address; r2 g2 b2 those R/2 below. Row j = 0 goes out first, of a
// row column 0. With n = 1, two panels in a chain:
//
//      controller ──► panel at position 0          ──► panel at position 1
//      stage          0      1      …  C − 1           C      C + 1  …  2·C − 1
//      column         C − 1  C − 2  …  0               C − 1  C − 2  …  0
//      goes out       last                                              first
//
// In general column c of row j stands at stage before + (n − 1 − j)·C + C − 1 − c, where `before` is the length of the
// panels nearer to the controller. Line r1 carries the channel that Scan::color_order names first, g1 the second, b1
// the third; of mono formats r1 carries the level, and g1 and b1 are not used. Scan::msb_first means nothing here.
//
// 74HC595. A chain for a layer of N bits and for L layers. Pixel i = row·columns + column is bit i; with three channels
// it is bits 3·i, 3·i + 1 and 3·i + 2, in the order of Scan::color_order. High lights a column, high selects a layer.
// Scan::layers_first says which of the two go out first, Scan::msb_first in which order each of them does: from its
// last bit to bit 0, or from bit 0 to its last. Stage s is output Q(s mod 8), QA … QH, of register s / 8, and register
// 0 is next to the controller:
//
//      pixels first, msb first    stages 0 … L − 1: layers 0 … L − 1    L … L + N − 1: bits 0 … N − 1
//      pixels first, lsb first    stages 0 … L − 1: layers L − 1 … 0    L … L + N − 1: bits N − 1 … 0
//      layers first, msb first    stages 0 … N − 1: bits 0 … N − 1      N … N + L − 1: layers 0 … L − 1
//      layers first, lsb first    stages 0 … N − 1: bits N − 1 … 0      N … N + L − 1: layers L − 1 … 0
//
// A cube of 8 × 8 × 8, pixels first and msb first: QA … QH of the first register select layers 0 … 7, those of the
// second one are columns 0 … 7 of row 0, those of the ninth one columns of row 7.
//
// Freestanding.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "driver/display/description.h"
#include "transport/lines.h"

namespace xorvox::device {

/// Panels with shift registers for their upper and their lower half and a row address. Every panel shares all but data.
struct Hub75Pins {
    std::uint8_t clock = 0;          ///< Data are taken when it rises.
    std::uint8_t latch = 1;          ///< While high, the outputs follow the registers.
    std::uint8_t output_enable = 2;  ///< Low: lit.
    /// A … E: the number of the row group, A its lowest bit. Only as many are used as it has bits.
    std::array<std::uint8_t, 5> address{3, 4, 5, 6, 7};
    /// Of each connector: r1 g1 b1 of the upper half, r2 g2 b2 of the lower one. High: lit.
    std::array<std::array<std::uint8_t, 6>, 8> data = [] {
        std::array<std::array<std::uint8_t, 6>, 8> lines{};
        for (std::size_t c = 0; c < 8; ++c) {
            for (std::size_t i = 0; i < 6; ++i) lines[c][i] = static_cast<std::uint8_t>(8 + 6 * c + i);
        }
        return lines;
    }();
};

/// A chain of 74HC595 at each connector.
struct ShiftRegisterPins {
    std::uint8_t clock = 0;          ///< SRCLK: data are taken when it rises.
    std::uint8_t latch = 1;          ///< RCLK: the outputs take the registers' bits when it rises.
    std::uint8_t output_enable = 2;  ///< OE. Low: the outputs are on.
    std::array<std::uint8_t, 8> data{3, 4, 5, 6, 7, 8, 9, 10};  ///< SER, of each connector.
};

/// LEDs between lines of rows and lines of columns; what drives their currents stands between.
struct MatrixPins {
    /// Row groups first (high: its LEDs light up where their columns are high), then columns (high: lit): panel by
    /// panel, of a panel the rows of a group as they are numbered, of a row its LEDs by column, of an LED its channels
    /// in the order of Scan::color_order.
    std::array<std::uint8_t, kMaxLines> lines = [] {
        std::array<std::uint8_t, kMaxLines> all{};
        for (std::size_t i = 0; i < kMaxLines; ++i) all[i] = static_cast<std::uint8_t>(i);
        return all;
    }();
};

/// 0 for a number that no line has.
constexpr LineMask line_bit(std::uint32_t line) {
    return line < kMaxLines ? LineMask{1} << line : 0;
}

/// Columns of a matrix: LEDs, each channel one, that are lit together.
constexpr std::uint64_t matrix_columns(const DisplayDescription& display) {
    std::uint64_t leds = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        leds += std::uint64_t{display.panels[p].columns} * display.panels[p].rows;
    }
    return leds / display.scan.row_groups * channel_count(display.format);
}

/// The lines that a scanner of `display`, which is valid, sets: what a backend is opened with. Of a matrix with more
/// than kMaxLines: none.
constexpr LineMask used_lines(const DisplayDescription& display, const Hub75Pins& pins) {
    LineMask used = line_bit(pins.clock) | line_bit(pins.latch) | line_bit(pins.output_enable);
    const auto bits = static_cast<std::size_t>(std::bit_width(display.scan.row_groups - 1u));
    for (std::size_t i = 0; i < bits && i < pins.address.size(); ++i) used |= line_bit(pins.address[i]);
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const auto& data = pins.data[display.panels[p].connector];
        for (std::size_t i = 0; i < 6; ++i) {
            if (i % 3 < channel_count(display.format)) used |= line_bit(data[i]);
        }
    }
    return used;
}
constexpr LineMask used_lines(const DisplayDescription& display, const ShiftRegisterPins& pins) {
    return line_bit(pins.clock) | line_bit(pins.latch) | line_bit(pins.output_enable) |
           line_bit(pins.data[display.panels[0].connector]);
}
constexpr LineMask used_lines(const DisplayDescription& display, const MatrixPins& pins) {
    const std::uint64_t count = display.scan.row_groups + matrix_columns(display);
    LineMask used = 0;
    for (std::size_t i = 0; count <= kMaxLines && i < count; ++i) used |= line_bit(pins.lines[i]);
    return used;
}

/// The levels at which nothing can be lit: what a backend sets when it is opened and when it is closed, and what pull
/// resistors must hold while nobody sets the lines.
constexpr LineMask safe_levels(const Hub75Pins& pins) {
    return line_bit(pins.output_enable);
}
constexpr LineMask safe_levels(const ShiftRegisterPins& pins) {
    return line_bit(pins.output_enable);
}
constexpr LineMask safe_levels(const MatrixPins&) {
    return 0;
}

/// The name of a pin: "clock", "latch", "oe", "a" … "e", "r1", "data", "row0", "col12". Connectors but 0 are in it:
/// "b2_1".
struct PinName {
    std::array<char, 12> text{};

    constexpr PinName() = default;
    constexpr explicit PinName(std::string_view name) { add(name); }
    constexpr PinName(std::string_view name, std::uint32_t number) {
        add(name);
        if (number >= 10) add({&"0123456789"[number / 10 % 10], 1});
        add({&"0123456789"[number % 10], 1});
    }
    constexpr std::string_view view() const { return {text.data(), std::string_view(text.data()).size()}; }
    constexpr bool empty() const { return text[0] == '\0'; }

private:
    constexpr void add(std::string_view more) {
        std::size_t end = view().size();
        for (const char c : more) {
            if (end + 1 < text.size()) text[end++] = c;
        }
    }
};

/// What line `line` is; empty: none of the pins.
constexpr PinName pin_name(const Hub75Pins& pins, std::uint32_t line) {
    if (line == pins.clock) return PinName("clock");
    if (line == pins.latch) return PinName("latch");
    if (line == pins.output_enable) return PinName("oe");
    for (std::size_t i = 0; i < pins.address.size(); ++i) {
        if (line == pins.address[i]) return PinName(std::string_view("abcde").substr(i, 1));
    }
    for (std::uint32_t c = 0; c < pins.data.size(); ++c) {
        for (std::size_t i = 0; i < 6; ++i) {
            if (line != pins.data[c][i]) continue;
            const std::string_view names("r1_g1_b1_r2_g2_b2_");
            return c == 0 ? PinName(names.substr(3 * i, 2)) : PinName(names.substr(3 * i, 3), c);
        }
    }
    return {};
}
constexpr PinName pin_name(const ShiftRegisterPins& pins, std::uint32_t line) {
    if (line == pins.clock) return PinName("clock");
    if (line == pins.latch) return PinName("latch");
    if (line == pins.output_enable) return PinName("oe");
    for (std::uint32_t c = 0; c < pins.data.size(); ++c) {
        if (line == pins.data[c]) return c == 0 ? PinName("data") : PinName("data_", c);
    }
    return {};
}
/// Of a display with `row_groups`; columns are counted from 0.
constexpr PinName pin_name(const MatrixPins& pins, std::uint32_t row_groups, std::uint32_t line) {
    for (std::uint32_t i = 0; i < kMaxLines; ++i) {
        if (line == pins.lines[i]) return i < row_groups ? PinName("row", i) : PinName("col", i - row_groups);
    }
    return {};
}

}  // namespace xorvox::device
