// Arbitrary text as a calibration file, for a display of panels and one of planes: refused with a message of one line,
// or LEDs that the display has, each once, with gains of 0 … 1.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "driver/host/calibration.h"

namespace {

void check(std::string_view text, const xorvox::DisplayDescription& display, std::uint32_t units) {
    const auto calibration = xorvox::host::Calibration::parse(text, display);
    if (!calibration) {
        const std::string& message = calibration.error().message;
        if (message.empty() || message.size() > 300) std::abort();
        for (const char c : message) {
            if (c < ' ' || c > '~') std::abort();
        }
        return;
    }
    const auto leds = calibration->leds();
    for (std::size_t i = 0; i < leds.size(); ++i) {
        if (leds[i].unit >= units || leds[i].pixel >= xorvox::frame_pixels(display) / display.slices) std::abort();
        for (int c = 0; c < 3; ++c) {
            if (!(leds[i].gain[c] >= 0.0f && leds[i].gain[c] <= 1.0f)) std::abort();
        }
        if (i == 0) continue;
        if (leds[i - 1].unit > leds[i].unit) std::abort();
        if (leds[i - 1].unit == leds[i].unit && leds[i - 1].pixel >= leds[i].pixel) std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    xorvox::DisplayDescription stack;
    stack.slices = 5;
    stack.panels[0] = {.columns = 7, .rows = 3};
    check(text, stack, 5);
    xorvox::DisplayDescription rotor;
    rotor.kind = xorvox::DisplayKind::RotatingPanel;
    rotor.slices = 9;
    rotor.panel_count = 2;
    rotor.panels[0] = {.columns = 4, .rows = 3};
    rotor.panels[1] = {.columns = 2, .rows = 6};
    check(text, rotor, 2);
    return 0;
}
