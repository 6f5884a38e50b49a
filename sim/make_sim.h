// make_sim: a display for tests, in one line.
//
//   auto rig = make_sim().rotating(360).panel(128, 64).jitter(0.01).build().value();
//   host::Session session(rig.host_end(), rig.display());
//   rig.set_host([&](std::uint64_t now_ns) { (void)session.poll(now_ns); });
//   (void)session.submit(frame);
//   rig.run_until([&] { return session.last_presented() != 0; }, 2'000'000'000);
//   for (const SeenStrobe& strobe : rig.strobes()) …
//
// A host is not needed: rig.show(page) sends a page as one would. docs/testing.md has a whole example.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "driver/display/description.h"
#include "sim/simulator.h"
#include "sim/strobe.h"
#include "transport/link.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

/// A strobe, but for its bits, and where the display was.
struct SeenStrobe {
    std::uint64_t on_ns = 0;
    std::uint64_t off_ns = 0;
    std::uint32_t frame = 0;
    std::uint32_t slice = 0;
    std::uint32_t row_group = 0;
    std::uint32_t plane = 0;
    double cycles = 0.0;  ///< Where the display really was in the middle of it.
    /// By how many slices that was before (negative) or behind the stretch of the cycle that is the slice's; 0: in it.
    double slices_off = 0.0;

    bool operator==(const SeenStrobe&) const = default;
};

/// By how many slices a display at `cycles` is off the stretch of the cycle in which `slice` is lit, as SeenStrobe
/// tells it; of a plane that is lit both ways, off the nearer of the two.
double slices_off(const DisplayDescription& display, std::uint32_t slice, double cycles);

/// A simulated display on a desk: a link to it, a clock, and an eye. Movable. One thread.
class SimRig {
public:
    static constexpr std::uint64_t kStep_ns = 1'000'000;

    SimRig(SimRig&&) noexcept;
    SimRig& operator=(SimRig&&) noexcept;
    ~SimRig();

    const DisplayDescription& display() const;
    Simulator& simulator();
    const Simulator& simulator() const;

    /// The host's end of the link, for a Session; lives as long as the rig.
    Link host_end();
    /// Is called at least every millisecond of the rig's time, with that time, and again while packets come: poll the
    /// session in it.
    void set_host(std::function<void(std::uint64_t now_ns)> host);
    /// Instead of a host of your own: sends a page (frame_bytes(display) in scan-out order), to be shown as soon as
    /// possible or at `present_at_ns`. From then on the rig keeps the display's watchdog quiet. The frame's id; 0: not
    /// sent, because the size is wrong.
    std::uint32_t show(std::span<const std::byte> page, std::uint64_t present_at_ns = 0);

    std::uint64_t now_ns() const;
    void run_for(std::uint64_t ns);
    /// Until `done`, which is asked every millisecond; false: that did not come within `at_most_ns`.
    bool run_until(const std::function<bool()>& done, std::uint64_t at_most_ns);

    /// The strobes that ended since the beginning, or since forget(), in the order of their beginnings.
    const std::vector<SeenStrobe>& strobes() const;
    void forget();
    /// Also gives each strobe, with its bits, to `sink`.
    void watch(StrobeSink sink);

private:
    friend class MakeSim;
    struct Impl;
    explicit SimRig(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// Says what display, bit by bit; the order does not matter, but that display() comes first. Nothing is checked until
/// build().
class MakeSim {
public:
    /// A whole description to begin with; it is copied, and what it borrows must outlive the rig.
    MakeSim& display(const DisplayDescription& display);

    // What it is. The moving ones have one index pulse a turn, and 20 cycles a second.
    MakeSim& rotating(std::uint32_t slices);
    MakeSim& stacked(std::uint32_t planes);
    MakeSim& swept(std::uint32_t slices, MotionProfile profile = MotionProfile::Constant);
    MakeSim& helix(std::uint32_t slices, std::uint32_t blades = 1);
    /// One more panel, with pixels of `pitch_mm` each way. One of a rotor stands on the axis, several stand evenly
    /// about it, two back to back. Planes are as far apart as the first one's pixels.
    MakeSim& panel(std::uint16_t columns, std::uint16_t rows, double pitch_mm = 2.0);
    MakeSim& format(PixelFormat format);
    MakeSim& cycles_per_second(double cycles);
    MakeSim& scan(const Scan& scan);
    MakeSim& index_pulses(std::uint32_t pulses_per_turn);
    MakeSim& encoder(std::uint32_t steps_per_turn);
    MakeSim& index_phase(double cycles);
    /// Anything else: `change` is called with the whole description, at the end.
    MakeSim& change(std::function<void(DisplayDescription&)> change);

    // How it really turns: RotorConditions. Without any of these the display keeps to the device's clock.
    MakeSim& rotor(const RotorConditions& conditions = {});
    MakeSim& speed(double times);
    MakeSim& spin_up(double seconds);
    MakeSim& acceleration(double part_per_second);
    MakeSim& jitter(double part);
    MakeSim& missed(double probability);
    MakeSim& doubled(double probability);
    MakeSim& noise(double part_of_turn);
    MakeSim& stall_at(double seconds);
    /// Of all that is left to chance; 1.
    MakeSim& seed(std::uint64_t seed);

    /// One more thing that is wrong with it.
    MakeSim& fault(const Fault& fault);
    MakeSim& fidelity(Fidelity fidelity);
    /// How it is really built: SimulatorOptions::built.
    MakeSim& built_like(const DisplayDescription& built);

    /// The rig, with time at 0 and the display switched on; or what is wrong with the display, in the words of
    /// validate_display() or Simulator::make(). Throws std::bad_alloc.
    Expected<SimRig> build() const;

private:
    RotorConditions& conditions();
    DisplayDescription description() const;

    DisplayDescription display_;
    std::optional<std::uint32_t> panels_;  ///< Given by panel().
    double pitch_mm_ = 2.0;                ///< Of the first of them.
    std::function<void(DisplayDescription&)> change_;
    std::optional<RotorConditions> rotor_;
    std::uint64_t seed_ = 1;
    SimulatorOptions options_;
};

inline MakeSim make_sim() {
    return {};
}

}  // namespace xorvox::sim
