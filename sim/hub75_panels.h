// Hub75Panels: LED panels with HUB75 connectors, in chains.
//
//   controller ─► panel at position 0 ─► position 1 ─► …       a chain; chains share clock, latch, output enable,
//   address
//
// In each panel r1 g1 b1 (upper half of the rows) and r2 g2 b2 (lower half) are the inputs of shift registers, which
// take a bit each when the clock rises, and whose ends are the inputs of the next panel. A register of a panel has a
// stage for each column of each row that is lit at the same time in its half. What enters first gets furthest: of a
// panel the first column, of several rows that are lit together the uppermost; of a chain the last panel.
//
//   latch high    the LED drivers follow the registers       latch falls: they keep what is there
//   output enable low     the LEDs of the rows that the address selects are lit: rows r with r mod row_groups =
//   address;
//                         none where the address is no row group's
//
// A change of latch or address while the output is enabled is seen as it is: the light of the old bits or rows ends,
// that of the new ones begins.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "driver/device/scan/pins.h"
#include "driver/display/description.h"
#include "sim/pin_model.h"
#include "sim/plane_rows.h"
#include "sim/shift_registers.h"
#include "sim/strobe.h"

namespace xorvox::sim {

class Hub75Panels final : public PinModel {
public:
    /// Of a valid display with driver "hub75" and at most 32 row groups. Copied. A panel of one colour is wired to r1
    /// and r2 alone; of one of three, r1 leads to the LEDs of scan.color_order's first channel.
    Hub75Panels(const DisplayDescription& display, const device::Hub75Pins& pins, StrobeSink sink);

    void on_pins(std::uint64_t time_ns, LineMask levels, LineMask changed) override;

private:
    /// One row of one half of one panel in a register.
    struct Run {
        std::size_t from_end = 0;  // Stages from that of its first column to the end at the controller, both counted.
        std::array<LineMask, 3> lines{};  // By channel.
        std::uint32_t panel = 0;
        std::uint32_t row = 0;  // Of row group 0.
        std::uint32_t columns = 0;
    };

    void wire(std::uint32_t panel, const device::Hub75Pins& pins, std::size_t stages_before);
    std::uint32_t address(LineMask levels) const;
    void light(std::uint64_t time_ns, std::uint32_t group);
    void end_light(std::uint64_t time_ns);
    void decode(const Run& run, std::uint32_t group);

    DisplayDescription display_;
    StrobeSink sink_;
    LineMask clock_;
    LineMask latch_;
    LineMask output_enable_;
    LineMask colors_ = 0;
    std::vector<LineMask> address_;  // Those that count the row groups.
    std::vector<Run> runs_;
    ShiftRegisters registers_;
    std::vector<LineMask> drivers_;  // Oldest first, as the registers.
    bool started_ = false;

    struct Lit {
        std::uint64_t since_ns = 0;
        std::uint32_t group = 0;
    };
    std::optional<Lit> lit_;
    std::vector<LineMask> lit_bits_;  // Oldest first.
    PlaneRows rows_;
};

}  // namespace xorvox::sim
