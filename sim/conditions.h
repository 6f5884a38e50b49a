// Conditions: how a simulated display behaves, from a file or a command line.
//
//   seed = 7                   # of everything that is left to chance; 1
//
//   [rotor]                    # keys as the fields of RotorConditions (sim/rotor.h)
//   jitter = 0.01
//   stall_s = 3
//
//   [[fault]]                  # kinds and keys as of parse_fault() (sim/faults.h)
//   kind = "off-axis"
//   panel = 1
//   mm = 1.5
//
// No global state: any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sim/faults.h"
#include "sim/rotor.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

struct Conditions {
    std::optional<RotorConditions> rotor;  ///< None: the file has no [rotor].
    Faults faults;
};

/// Reads the text of a file. `source` names it in messages ("file.toml"), which give line, key, what was found and what
/// is allowed.
Expected<Conditions> parse_conditions(std::string_view toml, std::string_view source);

/// Reads a file of at most 1 MiB.
Expected<Conditions> load_conditions(const std::string& path);

/// Reads KEY=VALUE,KEY=VALUE: speed, spin_up, acceleration, jitter, missed, doubled, noise, stall and seed, the times
/// in seconds and with _s behind their names or without. "jitter=0.01,missed=0.1,stall=3".
Expected<RotorConditions> parse_rotor(std::string_view text);

}  // namespace xorvox::sim
