// Simulation: how a display in this program behaves, from the command line.
#pragma once

#include "sim/conditions.h"
#include "tools/commands.h"
#include "voxelizer/error.h"

namespace xorvox::tools {

/// What --sim says, and after that what each --fault adds, and the --rotor instead of its own; --seed is that of all. Reads the file.
Expected<sim::Conditions> read_conditions(const SimulationOptions& options);

}  // namespace xorvox::tools
