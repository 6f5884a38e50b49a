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
    app.add_option("--rotor", options.rotor,
                   "How the simulated display really turns or sweeps, and what its sensor sees: speed=1.1, spin_up=S, "
                   "acceleration=PART, jitter=PART, missed=PART, doubled=PART, noise=PART, stall=S, seed=N; it is then "
                   "watched in time")
        ->type_name("KEY=VALUE,…");
    app.add_option_function<std::string>(
           "--seed", [&options](const std::string& text) { options.seed = parse_count("--seed", text, 0xffffffff); },
           "Of all that is left to chance: packets that are lost, jitter, pulses (default 1)")
        ->type_name("N");
}

void add_instruments(CLI::App& app, SimulationOptions& options) {
    app.add_option("--fidelity", options.fidelity,
                   "Watch the simulated display in time: strobes, row by row and bit plane by bit plane, or edges, by "
                   "every edge of its driver's pins (slower, the same light)")
        ->check(CLI::IsMember({"strobes", "edges"}).description(""))
        ->type_name("strobes|edges");
    app.add_option_function<std::string>(
           "--exposure",
           [&options](const std::string& text) { options.exposure_s = parse_positive("--exposure", text); },
           "Watch it for so long, up to 60 s, instead of one cycle; --png and the report are then of that")
        ->type_name("S");
    app.add_option("--trace", options.trace,
                   "The pins while it is watched, as a value change dump for GTKWave, PulseView and sigrok-cli")
        ->type_name("OUT.vcd");
    app.add_option("--histogram", options.histogram, "How many voxels had how much light: numbers, or a chart")
        ->type_name("OUT.csv|OUT.png");
    app.add_option("--compare", options.compare,
                   "A picture of what was sent and what was lit, side by side, with differences in colours")
        ->type_name("OUT.png");
}

}  // namespace xorvox::tools
