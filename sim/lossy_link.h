// LossyLink: a link that is somebody else's, of whose packets to the display some vanish (FaultKind::LostPackets).
#pragma once

#include "sim/faults.h"
#include "transport/link.h"

namespace xorvox::sim {

class LossyLink {
public:
    LossyLink() = default;
    LossyLink(LossyLink&& other) = delete;
    ~LossyLink();

    /// `link` itself where `faults` lose nothing; else one that loses packets received over it, until the next call or
    /// the end of this object. `link` is borrowed, and may be gone by then. Throws std::bad_alloc.
    Link over(Link link, const Faults& faults);

private:
    class Borrowed;

    Borrowed* borrowed_ = nullptr;  ///< Within lossy_.
    UniqueLink lossy_;
};

}  // namespace xorvox::sim
