// LedMatrix: LEDs on lines of their own, in row groups that take turns.
//
//   the first row_groups lines     high selects row group g: rows r of every panel with r mod row_groups = g
//   the others                     a line for each LED of a group, high lights it: panel by panel, row by row from the
//                                  top, column by column, channel by channel in scan.color_order
//
// A group is lit while it is selected, with the bits that its columns then carry; several groups that are selected
// show the same. Whatever changes while a group is lit ends its light and begins it anew.
#pragma once

#include <cstdint>
#include <vector>

#include "driver/device/scan/pins.h"
#include "driver/display/description.h"
#include "sim/pin_model.h"
#include "sim/plane_rows.h"
#include "sim/strobe.h"

namespace xorvox::sim {

class LedMatrix final : public PinModel {
public:
    /// Of a valid display that has no more than kMaxLines lines (device::matrix_columns). Copied.
    LedMatrix(const DisplayDescription& display, const device::MatrixPins& pins, StrobeSink sink);

    void on_pins(std::uint64_t time_ns, LineMask levels, LineMask changed) override;

private:
    struct Led {
        LineMask line = 0;
        std::uint32_t panel = 0;
        std::uint32_t row = 0;  // Of row group 0.
        std::uint32_t column = 0;
        std::uint32_t channel = 0;
    };

    void end_light(std::uint64_t time_ns);

    StrobeSink sink_;
    std::vector<LineMask> groups_;
    std::vector<Led> leds_;
    LineMask select_lines_ = 0;
    LineMask column_lines_ = 0;
    LineMask was_ = 0;
    std::uint64_t since_ns_ = 0;
    PlaneRows rows_;
};

}  // namespace xorvox::sim
