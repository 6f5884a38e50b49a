// VirtualLines: lines without wires, with a clock of their own. What a program does to them takes as long as it would
// on hardware that does nothing else, to the nanosecond and always the same; an observer sees every change.
//
//   set, strobe   no time; a strobe ends by itself while other operations go on
//   write         element i of n is set at start + i·1e9 / set_hz, rounded down; it ends at start + n·1e9 / set_hz,
//                 rounded up. With set_hz = 0 it takes no time
//   hold(ns)      ns
//   join          until the end of the strobe
//   wait          its timeout, where no edge is there
//
// The program can be ahead of the world: with a limit, what it does later than that is kept back, and what is kept back
// can be cut off, as an interrupt cuts a transfer off. Then its clock is at the limit, and a strobe that has begun
// still runs:
//
//   lines.limit(now);
//   while (lines.time_ns() <= now && !scanner.finished()) scanner.step();   // its last step may end later
//   lines.cut();                                                            // … but the new order comes now
//   scanner.begin(order, order.end_ns - now);
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>

#include "transport/lines.h"

namespace xorvox::transport {

struct VirtualLinesOptions {
    /// All levels from `time_ns` on; `changed` are the lines that have others than before. Changes come in the order of
    /// their times, each in a call of its own; what changes at once comes in one. The first call, at start_ns and from
    /// the constructor, tells all lines that there are.
    using Observer = std::function<void(std::uint64_t time_ns, LineMask levels, LineMask changed)>;

    LineMask outputs = 0;
    LineMask inputs = 0;  ///< No line may be both. They begin low.
    std::uint32_t set_hz = 0;
    LineMask safe_levels = 0;  ///< Of outputs: at the beginning, and when the lines are closed.
    std::uint64_t start_ns = 0;
    std::size_t edges_kept = 1024;  ///< Edges of inputs that wait to be taken; of more, the oldest are lost.
    Observer observer;
};

/// One thread. The object is the caller's: closing its Lines sets the safe levels, and every operation after that
/// answers Closed.
class VirtualLines {
public:
    explicit VirtualLines(VirtualLinesOptions options);
    VirtualLines(const VirtualLines&) = delete;
    VirtualLines& operator=(const VirtualLines&) = delete;
    /// Closes, if nobody did.
    ~VirtualLines();

    /// Borrowed; may also be owned by a UniqueLines that goes before this object. info().name is "virtual".
    Lines lines();

    /// The program's clock: when its next operation begins.
    std::uint64_t time_ns() const;
    /// Holds until `time_ns`, where that is later.
    void advance_to(std::uint64_t time_ns);
    /// The levels that the world sees: at time_ns(), or at the limit where that is earlier.
    LineMask levels() const;

    /// The world's time: what the program does later than this happens when the limit is raised. It begins without.
    static constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();
    void limit(std::uint64_t time_ns);
    /// What was kept back does not happen, and the program's clock goes back to the limit.
    void cut();

    /// Someone else puts a level on input `line`, now. An edge, where it is another one than before.
    void drive(std::uint32_t line, bool level);

    /// After `after` more that succeed, `count` calls of set(), write() or strobe() fail with Closed, and change
    /// nothing. Replaces what was asked for before.
    void fail_sets(std::uint64_t after, std::uint64_t count = 1);
    /// Successful calls of set(), write() and strobe() so far.
    std::uint64_t sets() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace xorvox::transport
