// Shutter: what a display in this program does in time, seen through the instruments of sim/ that were asked for.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "sim/conditions.h"
#include "sim/exposure_statistics.h"
#include "sim/optics.h"
#include "sim/simulator.h"
#include "sim/timing.h"
#include "tools/commands.h"
#include "tools/watch.h"
#include "voxelizer/error.h"
#include "voxelizer/io/atomic_file.h"

namespace xorvox::tools {

/// What a shutter that was open saw, and what the display made of its frames until then.
struct SeenInTime {
    sim::ExposureStatistics exposure;
    sim::Timing timing;
    std::optional<double> trace_ended_ms;  ///< After so long, since it was full; none: it is whole, or there is none.
    sim::LightField light;
};

/// The instruments of one simulated display. A moved Shutter must not have been opened.
class Shutter {
public:
    /// What of `options` can be refused before any work.
    static Expected<void> check(const SimulationOptions& options);

    /// Whether `options` or `conditions` ask for one.
    static bool is_wanted(const SimulationOptions& options, const sim::Conditions& conditions);

    /// How closely it looks.
    static sim::Fidelity fidelity(const SimulationOptions& options);

    /// Begins the files that `options` name.
    static Expected<Shutter> make(const SimulationOptions& options);

    /// Has `simulator`, which is borrowed until close(), watched from its next frame on: see Watch.
    void open(sim::Simulator& simulator, const SimulationOptions& options);
    /// Whether close() has nothing to wait for.
    bool is_over(std::uint64_t now_ns);
    /// Opens it if that was not done, lets time go on until it has seen all, and measures and writes that; what was
    /// sent is what is shown at `now_ns`. Call it once.
    Expected<SeenInTime> close(sim::Simulator& simulator, std::uint64_t now_ns, const DeliveryOptions& options,
                               const Meanwhile& meanwhile);

private:
    std::optional<io::AtomicFile> trace_;
    std::optional<io::AtomicFile> histogram_;
    std::optional<io::AtomicFile> comparison_;
    std::unique_ptr<Watch> watch_;  ///< After the files, which it writes to.
};

/// Lines for people: what became of frames, and faults.
void print_timing(const sim::Timing& timing);

/// Lines for people; nothing where `seen` is empty.
void print_in_time(const SimulationOptions& options, const std::optional<SeenInTime>& seen);

/// A JSON object, what was asked for included, or "null".
std::string in_time_json(const SimulationOptions& options, const std::optional<SeenInTime>& seen);

}  // namespace xorvox::tools
