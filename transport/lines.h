// Lines: levels on wires, and edges that come in on them. The contract, operation by operation.
//
// What scans a panel out sets lines, holds them, and strobes its output enable; it has no clock of its own, so the
// order in which it asks for these is the order in time. On a microcontroller they go to ports, a timer and DMA, on
// Linux to libgpiod, in tests and in the simulator to VirtualLines (transport/virtual_lines.h).
//
//   set     now, and lasts            ────┐        ┌───── the next set of the same line
//   hold    nothing changes           ····└────────┘····· for at least so long
//   strobe  for a while, by itself        └──┐ ns ┌─┘      while other lines are set
//
// A backend is a LinesOperations table and an object; Lines is the borrowed pair. Operations marked optional may be
// null: the functions of Lines then do what their comments say. Freestanding: a microcontroller implements the same
// table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "voxelizer/status.h"

namespace xorvox {

/// Bit i is line i.
using LineMask = std::uint64_t;
inline constexpr std::uint32_t kMaxLines = 64;

/// An input that changed.
struct LineEdge {
    std::uint64_t time_ns = 0;  ///< By the clock of the backend.
    std::uint32_t line = 0;
    bool rising = false;
};

/// What the lines are; constant while they are open.
struct LinesInfo {
    const char* name = "";     ///< "virtual", "gpiod", …; static storage.
    LineMask outputs = 0;      ///< Lines that may be set.
    LineMask inputs = 0;       ///< Lines of which edges come.
    std::uint32_t set_hz = 0;  ///< Sets a second in write(); 0: unknown.
};

/// The operations of a backend. `self` is the object that Lines::self points to. None may throw. One thread at a time
/// may call them for one object. Lines outside of `outputs` in a mask: InvalidArgument, and nothing changes. An error
/// of the hardware: Closed; what the lines then carry is unknown, and the caller goes dark as far as it can.
struct LinesOperations {
    LinesInfo (*info)(const void* self);

    /// The lines of `mask` get their levels of `levels`, as far as possible at once. Ends a strobe of any of them.
    Status (*set)(void* self, LineMask mask, LineMask levels);

    /// Optional. As set() with one element of `levels` after the other, at the pace of LinesInfo::set_hz. Null: set()
    /// for each.
    Status (*write)(void* self, LineMask mask, std::span<const LineMask> levels);

    /// Nothing changes for at least `ns`, but strobes that run out. May block for so long.
    Status (*hold)(void* self, std::uint64_t ns);

    /// Optional. The lines of `mask` get their levels of `levels` now, and the other ones by themselves after `ns`;
    /// what is called meanwhile goes on beside it. A strobe that still runs is ended first. Null: set, hold, set.
    Status (*strobe)(void* self, LineMask mask, LineMask levels, std::uint64_t ns);

    /// Returns when no strobe runs any more. May block for as long as it takes. Null: where strobe is null, for then
    /// none ever runs; lines that strobe must join, or scanners refuse them.
    Status (*join)(void* self);

    /// The levels of all lines: of inputs what they carry, of outputs what they were set to.
    Status (*get)(void* self, LineMask& levels);

    /// Optional. The oldest edges of inputs that were not given yet, in order: as many as there are and fit into
    /// `edges`; `count` says how many. Ok, also for none. Corrupt: some were lost before these.
    Status (*edges)(void* self, std::span<LineEdge> edges, std::size_t& count);

    /// Optional. Blocks until an edge is there or `timeout_ns` has passed: Ok or Timeout.
    Status (*wait)(void* self, std::int64_t timeout_ns);

    /// Outputs get the levels that are safe (each backend is told them when it is opened), and the object is freed.
    void (*close)(void* self);
};

/// Borrowed lines; copy it freely. The functions mean what LinesOperations says.
struct Lines {
    const LinesOperations* operations = nullptr;
    void* self = nullptr;

    explicit operator bool() const { return operations != nullptr; }
    LinesInfo info() const { return operations->info(self); }
    Status set(LineMask mask, LineMask levels) const { return operations->set(self, mask, levels); }
    Status write(LineMask mask, std::span<const LineMask> levels) const {
        if (operations->write != nullptr) return operations->write(self, mask, levels);
        for (const LineMask level : levels) {
            if (const Status status = set(mask, level); status != Status::Ok) return status;
        }
        return Status::Ok;
    }
    Status hold(std::uint64_t ns) const { return operations->hold(self, ns); }
    Status strobe(LineMask mask, LineMask levels, std::uint64_t ns) const {
        if (operations->strobe != nullptr) return operations->strobe(self, mask, levels, ns);
        Status status = set(mask, levels);
        if (status == Status::Ok) status = hold(ns);
        const Status ended = set(mask, ~levels);  // Also after an error: nothing may stay lit.
        return status == Status::Ok ? ended : status;
    }
    Status join() const { return operations->join != nullptr ? operations->join(self) : Status::Ok; }
    Status get(LineMask& levels) const { return operations->get(self, levels); }
    Status edges(std::span<LineEdge> edges, std::size_t& count) const {
        return operations->edges != nullptr ? operations->edges(self, edges, count) : Status::Unsupported;
    }
    Status wait(std::int64_t timeout_ns) const {
        return operations->wait != nullptr ? operations->wait(self, timeout_ns) : Status::Unsupported;
    }
};

/// Owns lines and closes them; movable. Freestanding (the backend's close() knows how its object is freed).
class UniqueLines {
public:
    UniqueLines() = default;
    explicit UniqueLines(Lines lines) : lines_(lines) {}
    UniqueLines(UniqueLines&& other) noexcept : lines_(other.lines_) { other.lines_ = {}; }
    UniqueLines& operator=(UniqueLines&& other) noexcept {
        if (this != &other) {
            reset();
            lines_ = other.lines_;
            other.lines_ = {};
        }
        return *this;
    }
    UniqueLines(const UniqueLines&) = delete;
    UniqueLines& operator=(const UniqueLines&) = delete;
    ~UniqueLines() { reset(); }

    void reset() {
        if (lines_) lines_.operations->close(lines_.self);
        lines_ = {};
    }
    Lines get() const { return lines_; }
    const Lines* operator->() const { return &lines_; }
    explicit operator bool() const { return static_cast<bool>(lines_); }

private:
    Lines lines_;
};

}  // namespace xorvox
