// Simulation: how a display in this program behaves, from the command line.
#pragma once

#include "driver/display/description.h"
#include "sim/conditions.h"
#include "tools/commands.h"
#include "voxelizer/error.h"

namespace xorvox::tools {

/// What --sim says, and after that what each --fault adds, and the --rotor instead of its own; --seed is that of all.
/// Reads the file.
Expected<sim::Conditions> read_conditions(const SimulationOptions& options);

/// Refuses a rotor on a display that is at rest.
Expected<void> check_rotor(const sim::Conditions& conditions, const DisplayDescription& display);

}  // namespace xorvox::tools
