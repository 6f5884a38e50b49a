// Faults: wraps a link and damages what passes, the same way on every machine for the same seed. For tests.
#pragma once

#include <cstdint>

#include "transport/link.h"

namespace xorvox::transport {

/// Directions that faults are put into; may be combined.
enum FaultDirections : std::uint32_t { kFaultSent = 1, kFaultReceived = 2 };

/// Probabilities, 0 … 1, each of one packet and independent of the others.
struct FaultOptions {
    std::uint64_t seed = 1;
    std::uint32_t directions = kFaultSent | kFaultReceived;
    double drop = 0;     ///< The packet vanishes.
    double repeat = 0;   ///< It comes twice.
    double reorder = 0;  ///< It comes after the next one; while there is no next one, it is held back.
    double cut = 0;      ///< Its end is missing: at least one byte stays, at least one goes.
    double flip = 0;     ///< One bit is wrong.
};

/// What was done so far, in both directions together.
struct FaultCounts {
    std::uint64_t packets = 0;  ///< Packets that were looked at.
    std::uint64_t dropped = 0;
    std::uint64_t repeated = 0;
    std::uint64_t reordered = 0;
    std::uint64_t cut = 0;
    std::uint64_t flipped = 0;
};

/// Takes over `inner`, which must be open. The result has its info(), and its thread rules.
UniqueLink with_faults(UniqueLink inner, const FaultOptions& options);

/// The counts of a link that with_faults() made; zeros of any other. Call it from the link's thread.
FaultCounts fault_counts(Link link);

}  // namespace xorvox::transport
