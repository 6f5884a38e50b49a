// Exposure: what a shutter that is open for a while sees of a display: the light of all strobes in that time, each
// where the display really was in the middle of the strobe.
//
//   Exposure exposure(display, display, [&](std::uint64_t time_ns) { return rotor.cycles_at(time_ns); }, from, to);
//   scan = make_strobe_scan(display, [&](const Strobe& strobe) { exposure.add(strobe); });
//   …
//   render_perspective(display, exposure.light());
//
// Light is measured in what an LED that is fully on gives in the same time when the display runs as it is declared to
// (full_light_ns() in each cycle): steady full light is 1, however long the shutter is open. LEDs rise and fall as
// emitted_ns() says; what makes levels of codes by itself (Strobe::kLevels) has that in its levels, and counts for its
// whole length. Of a strobe that the shutter cuts, the part counts that it leaves.
//
// Memory. What is kept is rows of pixels: of each row in each slice the different patterns of bits that were lit, and
// for each its light and where that was. Places within an eighth of a slice are one; further than half a slice from
// where the row should be, those that differ by less than half of that distance. Frames that stay, or come again, take
// nothing more: 100 bytes a row, its bits, and 24 bytes for each pattern and place. Of a row that has had 64 of them,
// light is added up by pixel, at up to 8 places (the nearest are joined), which take 12 bytes a pixel each (mono: 4).
// That bounds it, however long the shutter is open and whatever the display does: most_bytes().
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "sim/faults.h"
#include "sim/optics.h"
#include "sim/strobe.h"

namespace xorvox::sim {

/// The light of one row of pixels of one slice, at one place of the display's movement.
struct ExposedRow {
    std::uint32_t slice = 0;  ///< That the device meant.
    std::uint32_t panel = 0;
    std::uint32_t row = 0;
    bool mirrored = false;  ///< Of half turns: LED `column` as mounted is pixel columns − 1 − column on the wire.
    /// Where it was, as Seats' second constructor takes it: the middle of slice s is s + ½, in every second half turn S
    /// + s + ½. Slices that are swapped (FaultKind::SwappedSlices) are.
    double at = 0.5;
    double late = 0.0;  ///< By how many slices that is after the middle of the slice; before: negative.
    /// Of each LED as mounted; linear, steady full light is 1. Of a mono format all channels are equal. Borrowed for
    /// the call.
    std::span<const glm::vec3> light;
};

/// One thread. Everything follows from the strobes and places given.
class Exposure {
public:
    /// Where the display is at a time, in cycles of its description: whole ones count frames.
    using CyclesAt = std::function<double(std::uint64_t time_ns)>;

    /// The shutter is open from `from_ns` to `to_ns`, later. `display` is what the device goes by, and `built` what is
    /// really there (they have the same layout: SimulatorOptions::built); both valid and copied, and what they borrow
    /// must outlive the exposure. `cycles_at` empty: as declared, from time 0 on. Of `faults`, possible on `built`,
    /// those of its pose count (sim/faults.h); those of its wiring are in the strobes.
    Exposure(const DisplayDescription& display, const DisplayDescription& built, CyclesAt cycles_at,
             std::uint64_t from_ns, std::uint64_t to_ns, Faults faults = {});
    Exposure(Exposure&&) noexcept;
    Exposure& operator=(Exposure&&) noexcept;
    ~Exposure();

    /// Adds a strobe's light. All strobes of slices of which some are lit while the shutter is open are given, so that
    /// due() can tell which it cut. Strobes are given when they have ended, so go on until those that are lit at to_ns
    /// have: at most a cycle, and the time that a string takes to be sent a frame. Throws std::bad_alloc.
    void add(const Strobe& strobe);

    using VisitRow = std::function<void(const ExposedRow&)>;

    /// The shutter closes at `to_ns` instead, after from_ns(). Strobes that go on for longer must not have been added.
    void close(std::uint64_t to_ns);

    /// Calls visit(row) for every row that was lit, by slice, panel and row; of one, by place.
    void for_each_row(const VisitRow& visit) const;
    /// The same for one row of the display alone.
    void for_each_place(std::uint32_t slice, std::uint32_t panel, std::uint32_t row, const VisitRow& visit) const;

    /// The light of one row of pixels wherever it was: adds to `light`, one entry for each column on the wire. Whether
    /// there was any.
    bool add_row_light(std::uint32_t slice, std::uint32_t panel, std::uint32_t row, std::span<glm::vec3> light) const;

    /// All of it as flashes, for pictures, statistics and rebuild: of each LED that was lit one for each slice of its
    /// way that it was lit in, at the mean place, with its light in LightField::measured, Flash::time a slice that the
    /// device meant and no code; by panel, row and slice of the way. 44 bytes a flash, and the light of one row of all
    /// slices meanwhile.
    LightField light() const;

    /// For how many cycles of the display, as it is declared to run, the shutter is open.
    double cycles() const;
    /// The steady light that `slice` was due in that time: 1 of whole cycles. Of others a slice is due the turns that
    /// it had, ⌊cycles⌋ of them to ⌈cycles⌉, ÷ cycles. 0: it had none, or the shutter cut one, so that its light says
    /// nothing. What is sent steadily (keeps_light()) is always due 1.
    double due(std::uint32_t slice) const;

    /// What it holds, in bytes, and what one of a valid `display` can hold at most: of `vortex` 0.9 GB, though frames
    /// that stay take a tenth of that.
    std::size_t bytes() const;
    static std::size_t most_bytes(const DisplayDescription& display);

    const DisplayDescription& display() const;
    const DisplayDescription& built() const;
    const Faults& faults() const;
    std::uint64_t from_ns() const;
    std::uint64_t to_ns() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace xorvox::sim
