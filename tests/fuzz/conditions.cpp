// Arbitrary text as a file of conditions, a fault and a rotor as typed: refused with a message of one line, or numbers
// in range; and a fault that a display can have makes light of bounded size.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "driver/display/toml.h"
#include "sim/conditions.h"
#include "sim/optics.h"
#include "sim/wiring.h"

namespace {

using namespace xorvox;

void check_message(const Error& error) {
    if (error.message.empty() || error.message.find('\n') != std::string::npos) std::abort();
}

DisplayFile small(std::string_view name) {
    DisplayFile display = load_display(std::string(name)).value();
    for (std::uint32_t p = 0; p < display.panel_count; ++p) display.panels[p].columns = 3;
    if (display.slices > 6) display.slices = 6;
    return display;
}

void use(const sim::Faults& faults) {
    static const std::vector<DisplayFile> displays{small("vortex"), small("cube8-595"), small("perspecta")};
    for (const DisplayFile& display : displays) {
        if (const auto possible = sim::check_faults(display, faults); !possible) {
            check_message(possible.error());
            continue;
        }
        const std::vector<std::byte> page(frame_bytes(display), std::byte{0x5a});
        const sim::LightField light = sim::expose(display, page, 255, faults);
        if (light.flashes.size() > frame_pixels(display)) std::abort();
        if (light.flashes.size() != sim::count_lit(display, page, faults)) std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto conditions = sim::parse_conditions(text, "fuzz.toml");
    if (!conditions) {
        check_message(conditions.error());
    } else if (conditions->faults.list.size() <= 20) {  // More are only slower.
        use(conditions->faults);
    }
    const auto fault = sim::parse_fault(text);
    if (!fault) {
        check_message(fault.error());
    } else {
        use({{*fault}});
    }
    const auto rotor = sim::parse_rotor(text);
    if (!rotor) {
        check_message(rotor.error());
    } else if (!(rotor->speed > 0.0 && rotor->jitter >= 0.0 && rotor->jitter <= 0.5)) {
        std::abort();
    }
    return 0;
}
