// Wiring: what each row of LEDs is given, where faults have it that it is not what was sent for it. In a page, and in
// strobes, where both fidelities meet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/display/description.h"
#include "sim/faults.h"
#include "sim/pixel_rows.h"
#include "sim/strobe.h"

namespace xorvox::sim {

class Wiring {
public:
    /// `display` must be valid, `faults` possible on it (check_faults). `display` is borrowed.
    Wiring(const DisplayDescription& display, const Faults& faults);

    /// What a row of LEDs shows: that row of that panel, as sent.
    struct Row {
        std::uint32_t panel = 0;
        std::uint32_t row = 0;
        bool dark = false;
        bool reversed = false;  ///< From its last column to its first.
    };
    const Row& row(std::uint32_t panel, std::uint32_t row) const { return rows_[panel][row]; }

    /// Bits of a panel's codes that are always 1, or 0.
    struct Stuck {
        std::uint32_t high = 0;
        std::uint32_t low = 0;
    };
    const Stuck& stuck(std::uint32_t panel) const { return stuck_[panel]; }

    /// Whether every row shows what was sent for it.
    bool is_right() const { return right_; }

    /// As for_each_row() of sim/pixel_rows.h, with the pixels that the LEDs show; none of a dark row. `pixels` is valid
    /// in the call.
    template <class Visit>
    void for_each_row(std::span<const std::byte> page, const Visit& visit) const {
        if (right_) return sim::for_each_row(display_, page, visit);
        std::vector<std::byte> shown;
        for (std::uint32_t slice = 0; slice < display_.slices; ++slice) {
            const auto sent = page.subspan(slice * slice_bytes(display_), slice_bytes(display_));
            for (std::uint32_t p = 0; p < display_.panel_count; ++p) {
                for (std::uint32_t r = 0; r < display_.panels[p].rows; ++r) {
                    const Row& from = row(p, r);
                    const std::size_t length = row_bytes(display_.panels[p], display_.format);
                    shown.assign(from.dark ? 0 : length, std::byte{0});
                    if (!from.dark) {
                        show_pixels(p, from, sent.subspan(first_byte_[from.panel] + from.row * length, length), shown);
                    }
                    visit(slice, p, r, std::span<const std::byte>(shown));
                }
            }
        }
    }

    /// Writes what the LEDs of `panel` make of a row of pixels, `sent`: as many bytes of `shown`, which are 0.
    void show_pixels(std::uint32_t panel, const Row& row, std::span<const std::byte> sent,
                     std::span<std::byte> shown) const;

private:
    void add(const Fault& fault);
    void swap_lines(const Fault& fault);

    const DisplayDescription& display_;
    bool right_ = true;
    std::vector<std::vector<Row>> rows_;  ///< Of each panel.
    std::vector<Stuck> stuck_;
    std::vector<std::size_t> first_byte_;  ///< Of each panel in a slice.
};

/// A sink that gives `sink` each strobe as it is with these faults in the wiring: one, or where row lines are swapped
/// one for each row group that lights up. Without such faults `sink` itself. `display` must be valid, `faults` possible
/// on it; `display` is copied, and what it borrows must outlive the result.
StrobeSink with_wiring_faults(const DisplayDescription& display, const Faults& faults, StrobeSink sink);

}  // namespace xorvox::sim
