// Options of displays that are simulated.
#include "sim/faults.h"
#include "tools/command_line.h"

namespace xorvox::tools {

void add_simulation(CLI::App& app, SimulationOptions& options) {
    std::string kinds;
    for (const sim::FaultKindInfo& info : sim::fault_kinds()) {
        kinds += (kinds.empty() ? "" : ", ") + std::string(info.name);
    }
    app.add_option("--fault", options.faults,
                   "Something that is wrong with the simulated display, as in off-axis:panel=1,mm=1.5; may be given "
                   "again. Kinds: " +
                       kinds + "; docs/bring-up.md shows each")
        ->allow_extra_args(false)
        ->type_name("KIND:KEY=VALUE,…");
    app.add_option("--sim", options.file,
                   "How the simulated display behaves: [[fault]] tables, [rotor] and seed; see docs/bring-up.md")
        ->type_name("FILE.toml");
}

}  // namespace xorvox::tools
