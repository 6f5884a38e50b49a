// Shutter: what a display in this program does in time, seen through the instruments of sim/ that were asked for.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "sim/conditions.h"
#include "sim/exposure_statistics.h"
#include "sim/optics.h"
#include "sim/simulator.h"
#include "sim/timing.h"
#include "tools/commands.h"
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

/// What the host does while time goes on, at each moment.
using Meanwhile = std::function<void(std::uint64_t now_ns)>;

/// One of the simulated displays that are watched in time.
class Shutter {
public:
    /// What of `options` can be refused before any work.
    static Expected<void> check(const SimulationOptions& options);

    /// Whether `options` or `conditions` ask for one.
    static bool is_wanted(const SimulationOptions& options, const sim::Conditions& conditions);

    /// Begins the files that `options` name.
    static Expected<Shutter> make(const SimulationOptions& options);

    /// Opens it at the next whole cycle after `now_ns`, for the time that was asked for or one cycle, and writes and
    /// measures what comes in. Call it once.
    Expected<SeenInTime> open(sim::Simulator& simulator, std::uint64_t now_ns, const DeliveryOptions& options,
                              const Meanwhile& meanwhile);

private:
    std::optional<io::AtomicFile> trace_;
    std::optional<io::AtomicFile> histogram_;
    std::optional<io::AtomicFile> comparison_;
};

/// Lines for people: what became of frames, and faults.
void print_timing(const sim::Timing& timing);

/// Lines for people; nothing where `seen` is empty.
void print_in_time(const SimulationOptions& options, const std::optional<SeenInTime>& seen);

/// A JSON object, or "null".
std::string in_time_json(const std::optional<SeenInTime>& seen);

}  // namespace xorvox::tools
