#include "tools/simulation.h"

#include <string>
#include <utility>

#include <fmt/format.h>

namespace xorvox::tools {

Expected<sim::Conditions> read_conditions(const SimulationOptions& options) {
    sim::Conditions conditions;
    if (!options.file.empty()) {
        Expected<sim::Conditions> read = sim::load_conditions(options.file);
        if (!read) return fail("--sim: " + read.error().message);
        conditions = std::move(*read);
    }
    for (const std::string& text : options.faults) {
        const Expected<sim::Fault> fault = sim::parse_fault(text);
        if (!fault) return fail("--fault: " + fault.error().message);
        conditions.faults.list.push_back(*fault);
    }
    if (!options.rotor.empty()) {
        const Expected<sim::RotorConditions> rotor = sim::parse_rotor(options.rotor);
        if (!rotor) return fail("--rotor: " + rotor.error().message);
        conditions.rotor = *rotor;
    }
    if (options.seed) {
        conditions.faults.seed = *options.seed;
        if (conditions.rotor) conditions.rotor->seed = *options.seed;
    }
    return conditions;
}

Expected<void> check_rotor(const sim::Conditions& conditions, const DisplayDescription& display) {
    const bool moves = display.kind != DisplayKind::StackedPlanes && display.kind != DisplayKind::FreePoints;
    if (!conditions.rotor || moves) return {};
    return fail(
        fmt::format("--rotor: {} is at rest, there is nothing that turns or sweeps; leave it out, and [rotor] in "
                    "the file of --sim",
                    display.name.view()));
}

}  // namespace xorvox::tools
