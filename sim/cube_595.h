// Cube595: an LED cube behind 74HC595 shift registers: outputs for the LEDs of a layer, which all layers share, and one
// for each layer, high selects it. (sim/chain_595.h is the chips.)
//
// LED k of a layer is channel k mod n, in scan.color_order, of pixel k ÷ n, and that is column i mod columns of row
// i ÷ columns. Where they are in the chain follows from what was shifted out last, which is next to the controller, in
// stage 0:
//
//   msb_first   pixels first                           layers first
//   yes         … LED 1, LED 0, … layer 1, layer 0     … layer 1, layer 0, … LED 1, LED 0
//   no          LED 0, LED 1 … layer 0, layer 1 …      layer 0, layer 1 … LED 0, LED 1 …
//
// A layer is lit while it is selected and the outputs are enabled; several that are selected show the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "driver/device/scan/pins.h"
#include "driver/display/description.h"
#include "sim/chain_595.h"
#include "sim/pin_model.h"
#include "sim/plane_rows.h"
#include "sim/strobe.h"

namespace xorvox::sim {

class Cube595 final : public PinModel {
public:
    /// Of a valid stack with driver "74hc595" and one row group. Copied. `Strobe::slice` is the layer.
    Cube595(const DisplayDescription& display, const device::ShiftRegisterPins& pins, StrobeSink sink);

    void on_pins(std::uint64_t time_ns, LineMask levels, LineMask changed) override;

private:
    std::size_t led_stage(std::size_t led) const;
    std::size_t layer_stage(std::size_t layer) const;
    void end_light(std::uint64_t time_ns);
    void copy_outputs();

    DisplayDescription display_;
    std::size_t leds_;  // Of a layer.
    StrobeSink sink_;
    Chain595 chain_;
    std::optional<std::uint64_t> lit_since_ns_;
    std::vector<bool> layers_;  // That are selected.
    PlaneRows rows_;
};

}  // namespace xorvox::sim
