// Simulator: the far end of the wire. The real device half behind a link, a panel that it scans out to, and the light
// that the panel gives at each place. It knows the display's description and the bytes that arrive; never the host's
// volume.
//
//   link ─► device::Device ─► page ─► panel (pixels) ─► optics (flashes: place, colour, time) ─► picture, statistics
//
// That is one whole cycle of light, as it should be. What really happens in time follows from watch(): a rotor with
// conditions of its own (sim/rotor.h) gives index pulses, the device follows them, and what it orders becomes strobes.
//
//   rotor ─► device::ScanControl ─► orders ─► ScanOut ─► strobes ─► sinks, at cycles_at(time)
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "driver/device/device.h"
#include "driver/display/description.h"
#include "sim/optics.h"
#include "sim/rotor.h"
#include "sim/scan_out.h"
#include "sim/strobe.h"
#include "sim/timing.h"
#include "transport/link.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

/// How exactly orders become light.
enum class Fidelity : std::uint8_t {
    Strobes,  ///< Row and plane events; fast.
    Edges,    ///< The device half's scanner sets pins, and models of the chips say what is lit; the same light.
};

struct SimulatorOptions {
    std::uint32_t pages = 3;
    std::uint32_t max_packet_bytes = 65536;
    std::uint32_t boot_nonce = 1;  ///< The same in every run, for tests; give a random one where hosts may come again.
    Faults faults;                 ///< What is wrong with this display, beside `built`; nothing.
    /// The display as it is really built, where that is not as its description says: the device goes by `display`, and
    /// the light is where the pixels of this one are, turned or raised by as many whole slices as its index mark comes
    /// at another phase. Its frames must have the same layout: kind, format, slices, and columns and rows of each
    /// panel. When and how the device lights (dead zone, both ways, scan) stays as `display` says. Copied; what it
    /// borrows must outlive the simulator.
    std::optional<DisplayDescription> built;
    /// How it really turns; none: it keeps to the device's clock. With conditions the device hears the index that its
    /// description names, and shows nothing until it has found the rotation.
    std::optional<RotorConditions> rotor;
    Fidelity fidelity = Fidelity::Strobes;
    bool keeps_time = false;  ///< Keeps the account that timing() gives.
};

/// Deterministic: everything follows from the packets and the times given to poll(). One thread.
class Simulator {
public:
    /// A display that is switched on at time 0 with `link` at its plug (empty: see set_link). `display` is copied; what
    /// it borrows must outlive the simulator. Fails for a display that validate_display() refuses, with its words, for
    /// an `options.built` whose frames have another layout, for faults that it cannot have, and for sizes that no
    /// device has; for Fidelity::Edges also for displays without models of their chips (make_edge_scan). Throws
    /// std::bad_alloc.
    static Expected<Simulator> make(const DisplayDescription& display, Link link, const SimulatorOptions& options = {});
    Simulator(Simulator&&) noexcept;
    Simulator& operator=(Simulator&&) noexcept;
    ~Simulator();

    /// Turns the display on to `now_ns`: a boundary for each whole cycle that began since the last call. Then lets the
    /// device receive what has come, and look at its watchdog. Answers as Device::poll. Where there is a rotor, a sink
    /// or an account of time, it goes from event to event, a millisecond at most: that takes time in proportion, also
    /// from 0 to the first call.
    Status poll(std::uint64_t now_ns);

    /// From the next order of the device on, gives `sink` all strobes, as the LEDs are lit: with the faults of wiring.
    /// It is called in poll(). Null: no more. It must not call the simulator, but for what is const.
    void watch(StrobeSink sink);
    /// The same with all changes of the pins, whose names pin_names(display()) tells. Fidelity::Edges only: else there
    /// are none. Each call of watch() and watch_pins() begins the scan-out anew, dark.
    void watch_pins(PinSink sink);

    /// Where the display really is at a time that poll() was given, or before: in cycles of its description, of which
    /// the whole ones count frames. Where built().sync.index_phase is another, that is in it.
    double cycles_at(std::uint64_t time_ns) const;

    /// When the device began the cycle that it is in; in a sink: that of the strobe, or an earlier one's end. Only of
    /// cycles that began while somebody watched.
    std::uint64_t cycle_begin_ns() const;

    /// What was made of the frames in time, until the last poll(); zeros without SimulatorOptions::keeps_time.
    const TimingWatch& timing() const;

    /// Another client; see Device::set_link.
    void set_link(Link link);

    /// When to poll() again at the latest: when the next boundary is due; with a rotor in a millisecond at most.
    std::uint64_t next_boundary_ns() const;

    /// The light of one whole cycle of what is shown now.
    LightField light() const;

    const device::Device& device() const;
    /// What the device goes by.
    const DisplayDescription& display() const;
    /// Where the light is: display(), or what it is really built like; without its faults.
    const DisplayDescription& built() const;
    const Faults& faults() const;

private:
    struct Impl;
    explicit Simulator(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace xorvox::sim
