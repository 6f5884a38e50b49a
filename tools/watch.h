// Watch: strobes and pins of a simulated display while a shutter is open.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "sim/exposure.h"
#include "sim/simulator.h"
#include "sim/strobe.h"
#include "sim/vcd.h"
#include "transport/lines.h"
#include "voxelizer/error.h"
#include "voxelizer/io/atomic_file.h"

namespace xorvox::tools {

/// What the host does while time goes on, at each moment.
using Meanwhile = std::function<void(std::uint64_t now_ns)>;

/// The shutter opens with the second cycle that the device begins while it shows a frame (in the first one, strings of
/// LEDs are sent it), for the time that was asked for or for that cycle.
class Watch {
public:
    /// From now on `simulator` is watched; it is borrowed. `trace`: where its pins go, may be null, and is borrowed.
    Watch(sim::Simulator& simulator, const std::optional<double>& exposure_s, io::AtomicFile* trace);
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;
    ~Watch();

    /// Whether all that the shutter saw is there, at `now_ns`.
    bool is_over(std::uint64_t now_ns);

    /// Lets time go on from `now_ns` until it is over, with `meanwhile`, or until a signal. A display that stands, or
    /// shows nothing, is waited for some cycles.
    void wait(std::uint64_t now_ns, const Meanwhile& meanwhile);

    /// Call it when it is over. The trace is complete then; when it ended because it was full, `trace_ended_ms` says
    /// after how long.
    Expected<void> finish(std::optional<double>& trace_ended_ms);
    const sim::Exposure& exposure() const { return *exposure_; }

private:
    static constexpr std::uint64_t kNever = ~std::uint64_t{0} / 2;

    void look();
    void open_at(std::uint64_t from_ns);
    void expose();
    void on_strobe(const sim::Strobe& strobe);
    void on_pins(std::uint64_t time_ns, LineMask levels, LineMask changed);

    sim::Simulator& simulator_;
    std::optional<double> exposure_s_;
    io::AtomicFile* file_;
    std::uint64_t begin_ns_;  ///< Of the device's cycle when it was last looked at.
    int begun_ = 0;
    bool is_open_ = false;
    std::uint64_t from_ns_ = 0;
    std::uint64_t to_ns_ = kNever;
    std::optional<sim::Exposure> exposure_;
    std::optional<sim::VcdWriter> trace_;
    LineMask levels_ = 0;
    bool tracing_ = false;
};

}  // namespace xorvox::tools
