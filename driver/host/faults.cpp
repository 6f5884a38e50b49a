#include "driver/host/faults.h"

namespace xorvox::host {

const char* describe(wire::Fault fault) {
    using wire::Fault;
    switch (fault) {
        case Fault::None: return "it has no fault";
        case Fault::SilentHost: return "its host fell silent; it lights again when a host is back";
        case Fault::LateScan:
            return "its scan-out came too late for a slice; let it turn more slowly or show fewer bits a pixel, then "
                   "clear fault 2";
        case Fault::LostIndex:
            return "its index pulses are missing or do not fit the turn: it stands, is still gaining speed, or the "
                   "sensor, its magnet or the wiring is at fault; mend that, then clear fault 3";
        case Fault::Stall:
            return "its rotor stands or turns too slowly; check that nothing holds it and that the motor has power, "
                   "then clear fault 4";
        case Fault::Overspeed: return "its rotor turned too fast; bring the motor's speed down, then clear fault 5";
        case Fault::Reversed:
            return "its rotor turned backwards; check the motor's wiring and the display's clockwise, then clear fault "
                   "6";
        case Fault::Interlock: return "its interlock was opened; close the guard, then clear fault 7";
    }
    return "it has a fault that this program does not know; update it";
}

}  // namespace xorvox::host
