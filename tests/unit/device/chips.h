// What hangs on the pins, by the truth tables of its data sheets: HUB75 panels, chains of 74HC595, LED matrices. They
// know levels and edges alone, and say which LEDs are lit. They share nothing with the scanners but the pins' numbers.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "driver/device/scan/pins.h"
#include "driver/display/description.h"

namespace xorvox::test {

struct Led {
    std::uint32_t panel = 0;
    std::uint32_t row = 0;
    std::uint32_t column = 0;
    std::uint32_t channel = 0;  ///< 0 red, 1 green, 2 blue.
};

class Chips {
public:
    virtual ~Chips() = default;
    virtual void see(LineMask levels, LineMask changed) = 0;

    /// Whether this LED is lit; of a cube, in which layer is layer().
    virtual bool lit(const Led& led) const = 0;
    /// Whether anything can be lit: the output enable, or any row of a matrix.
    virtual bool output_on() const = 0;
    /// The row group or layer that is selected; −1: none, −2: several.
    virtual int selected() const = 0;
    /// No column is on, whatever is selected.
    virtual bool columns_clear() const = 0;
    /// No row is selected, or the one that stands for none.
    virtual bool rows_released() const = 0;
};

inline bool is_high(LineMask levels, std::uint32_t line) {
    return (levels >> line & 1u) != 0;
}

/// A shift register of any length: stage 0 is the one at the data input.
struct Register {
    explicit Register(std::size_t stages) : bits(stages, true), outputs(stages, true) {}  // Power-on: anything.
    void shift(bool bit) {
        bits.push_front(bit);
        bits.pop_back();
    }
    std::deque<bool> bits;
    std::deque<bool> outputs;
};

class Hub75Chips : public Chips {
public:
    Hub75Chips(const DisplayDescription& display, const device::Hub75Pins& pins) : display_(display), pins_(pins) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            // The far end of one panel's register is the input of the next one's: each connector is one long register.
            lengths_[display.panels[p].connector] += length(p);
        }
        for (std::size_t c = 0; c < 8; ++c) {
            for (int line = 0; line < 6; ++line) registers_.emplace_back(lengths_[c]);
        }
    }

    void see(LineMask levels, LineMask changed) override {
        levels_ = levels;
        if (is_high(changed, pins_.clock) && is_high(levels, pins_.clock)) {
            for (std::size_t i = 0; i < registers_.size(); ++i) {
                if (lengths_[i / 6] > 0) registers_[i].shift(is_high(levels, pins_.data[i / 6][i % 6]));
            }
        }
        if (!is_high(levels, pins_.latch)) return;
        for (Register& r : registers_) r.outputs = r.bits;
    }

    bool lit(const Led& led) const override {
        const Panel& panel = display_.panels[led.panel];
        const std::uint32_t groups = display_.scan.row_groups;
        const std::uint32_t half = panel.rows / 2u;
        if (!output_on() || static_cast<int>(led.row % groups) != selected()) return false;
        const std::string_view order(display_.scan.color_order.data(), 3);
        const std::size_t line = order.find("rgb"[led.channel]) + (led.row >= half ? 3 : 0);
        // From the far end of its panel: rows of the group, top first, of a row column 0 first.
        const std::size_t from_far = led.row % half / groups * panel.columns + led.column;
        std::size_t nearer = 0;
        for (std::uint32_t p = 0; p < display_.panel_count; ++p) {
            const Panel& other = display_.panels[p];
            if (other.connector == panel.connector && other.chain_position < panel.chain_position) nearer += length(p);
        }
        const std::size_t stage = nearer + length(led.panel) - 1 - from_far;
        return registers_[6u * panel.connector + line].outputs[stage];
    }
    bool output_on() const override { return !is_high(levels_, pins_.output_enable); }
    int selected() const override {
        int address = 0;
        for (std::size_t i = 0; i < 5; ++i) address |= is_high(levels_, pins_.address[i]) ? 1 << i : 0;
        return address;
    }
    bool columns_clear() const override {
        for (const Register& r : registers_) {
            for (const bool bit : r.outputs) {
                if (bit) return false;
            }
        }
        return true;
    }
    bool rows_released() const override { return selected() == 0; }

private:
    std::size_t length(std::uint32_t p) const {
        return std::size_t{display_.panels[p].columns} * display_.panels[p].rows / 2 / display_.scan.row_groups;
    }

    DisplayDescription display_;
    device::Hub75Pins pins_;
    LineMask levels_ = 0;
    std::size_t lengths_[8] = {};
    std::vector<Register> registers_;
};

/// One chain of 74HC595: SRCLK and RCLK act when they rise, OE is low for on.
class ShiftRegisterChips : public Chips {
public:
    ShiftRegisterChips(const DisplayDescription& display, const device::ShiftRegisterPins& pins)
        : display_(display),
          pins_(pins),
          pixel_bits_(std::size_t{display.panels[0].columns} * display.panels[0].rows * channel_count(display.format)),
          chain_(pixel_bits_ + display.slices) {}

    void see(LineMask levels, LineMask changed) override {
        // A 595 whose both clocks rise together latches what stood before; nobody should do that.
        if (is_high(changed & levels, pins_.latch)) chain_.outputs = chain_.bits;
        if (is_high(changed & levels, pins_.clock)) {
            chain_.shift(is_high(levels, pins_.data[display_.panels[0].connector]));
        }
        levels_ = levels;
    }

    bool lit(const Led& led) const override {
        if (!output_on() || selected() < 0) return false;
        const std::string_view order(display_.scan.color_order.data(), 3);
        std::size_t bit = std::size_t{led.row} * display_.panels[0].columns + led.column;
        if (!is_mono(display_.format)) bit = 3 * bit + order.find("rgb"[led.channel]);
        return chain_.outputs[pixel_stage(bit)];
    }
    bool output_on() const override { return !is_high(levels_, pins_.output_enable); }
    int selected() const override {
        int layer = -1;
        for (std::uint32_t i = 0; i < display_.slices; ++i) {
            if (chain_.outputs[layer_stage(i)]) layer = layer == -1 ? static_cast<int>(i) : -2;
        }
        return layer;
    }
    bool columns_clear() const override {
        for (std::size_t i = 0; i < pixel_bits_; ++i) {
            if (chain_.outputs[pixel_stage(i)]) return false;
        }
        return true;
    }
    bool rows_released() const override { return selected() == -1; }

private:
    /// The table in pins.h, line by line.
    std::size_t pixel_stage(std::size_t bit) const {
        const std::size_t from = display_.scan.msb_first ? bit : pixel_bits_ - 1 - bit;
        return display_.scan.layers_first ? from : display_.slices + from;
    }
    std::size_t layer_stage(std::size_t layer) const {
        const std::size_t from = display_.scan.msb_first ? layer : display_.slices - 1 - layer;
        return display_.scan.layers_first ? pixel_bits_ + from : from;
    }

    DisplayDescription display_;
    device::ShiftRegisterPins pins_;
    std::size_t pixel_bits_;
    Register chain_;
    LineMask levels_ = 0;
};

class MatrixChips : public Chips {
public:
    MatrixChips(const DisplayDescription& display, const device::MatrixPins& pins) : display_(display), pins_(pins) {}

    void see(LineMask levels, LineMask) override { levels_ = levels; }

    bool lit(const Led& led) const override {
        const std::uint32_t groups = display_.scan.row_groups;
        if (!is_high(levels_, pins_.lines[led.row % groups])) return false;
        const std::uint32_t channels = channel_count(display_.format);
        std::size_t at = groups;
        for (std::uint32_t p = 0; p < led.panel; ++p) {
            at += std::size_t{display_.panels[p].rows} / groups * display_.panels[p].columns * channels;
        }
        at += (std::size_t{led.row} / groups * display_.panels[led.panel].columns + led.column) * channels;
        if (channels == 3) at += std::string_view(display_.scan.color_order.data(), 3).find("rgb"[led.channel]);
        return is_high(levels_, pins_.lines[at]);
    }
    bool output_on() const override { return selected() != -1; }
    int selected() const override {
        int group = -1;
        for (std::uint32_t g = 0; g < display_.scan.row_groups; ++g) {
            if (is_high(levels_, pins_.lines[g])) group = group == -1 ? static_cast<int>(g) : -2;
        }
        return group;
    }
    bool columns_clear() const override {
        for (std::uint32_t i = display_.scan.row_groups; i < kMaxLines; ++i) {
            if (is_high(levels_, pins_.lines[i])) return false;
        }
        return true;
    }
    bool rows_released() const override { return selected() == -1; }

private:
    DisplayDescription display_;
    device::MatrixPins pins_;
    LineMask levels_ = 0;
};

}  // namespace xorvox::test
