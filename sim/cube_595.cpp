#include "sim/cube_595.h"

#include <string_view>
#include <utility>

namespace xorvox::sim {
namespace {

constexpr std::string_view kChannels = "rgb";

std::size_t leds_of(const DisplayDescription& display) {
    return std::size_t{display.panels[0].columns} * display.panels[0].rows * channel_count(display.format);
}

}  // namespace

Cube595::Cube595(const DisplayDescription& display, const device::ShiftRegisterPins& pins, StrobeSink sink)
    : display_(display),
      leds_(leds_of(display)),
      sink_(std::move(sink)),
      chain_(leds_ + display.slices,
             {pins.data[display.panels[0].connector], pins.clock, pins.latch, pins.output_enable}),
      layers_(display.slices),
      rows_(display) {}

std::size_t Cube595::led_stage(std::size_t led) const {
    const std::size_t before = display_.scan.layers_first ? 0 : display_.slices;
    return before + (display_.scan.msb_first ? led : leds_ - 1 - led);
}

std::size_t Cube595::layer_stage(std::size_t layer) const {
    const std::size_t before = display_.scan.layers_first ? leds_ : 0;
    return before + (display_.scan.msb_first ? layer : display_.slices - 1 - layer);
}

void Cube595::on_pins(std::uint64_t time_ns, LineMask levels, LineMask changed) {
    if (!chain_.on_pins(levels, changed)) return;
    if (lit_since_ns_) end_light(time_ns);
    if (!chain_.enabled()) return;
    lit_since_ns_ = time_ns;
    copy_outputs();
}

void Cube595::copy_outputs() {
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) layers_[layer] = chain_.output(layer_stage(layer));
    const std::uint32_t columns = display_.panels[0].columns;
    const std::uint32_t channels = channel_count(display_.format);
    for (std::size_t led = 0; led < leds_; ++led) {
        const auto pixel = static_cast<std::uint32_t>(led / channels);
        const std::size_t channel = kChannels.find(display_.scan.color_order[led % channels]);
        rows_.set(0, pixel / columns, static_cast<std::uint32_t>(channel), pixel % columns,
                  chain_.output(led_stage(led)));
    }
}

void Cube595::end_light(std::uint64_t time_ns) {
    Strobe strobe;
    strobe.on_ns = *std::exchange(lit_since_ns_, std::nullopt);
    strobe.off_ns = time_ns;
    strobe.panels = rows_.panels();
    if (strobe.on_ns == strobe.off_ns || !sink_) return;
    for (std::uint32_t layer = 0; layer < display_.slices; ++layer) {
        if (!layers_[layer]) continue;
        strobe.slice = layer;
        sink_(strobe);
    }
}

}  // namespace xorvox::sim
