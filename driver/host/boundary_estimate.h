// BoundaryEstimate: where the boundaries of the display's cycle are, from those at which it presented frames. A part of
// FrameStream.
#pragma once

#include <cstdint>

namespace xorvox::host {

class BoundaryEstimate {
public:
    /// `nominal_ns` is the cycle's length by description; the display's own may be a quarter longer or a fifth shorter.
    explicit BoundaryEstimate(double nominal_ns) : nominal_ns_(nominal_ns), cycle_ns_(nominal_ns) {}

    /// A boundary was at this time of the device's clock.
    void observe(std::uint64_t boundary_ns);
    /// The device's clock is another one: where boundaries were means nothing any more, how far apart they are does.
    void forget() { known_ = false; }

    bool known() const { return known_; }
    double cycle_ns() const { return cycle_ns_; }
    /// The boundary nearest to `device_ns`, once one is known.
    std::uint64_t nearest(std::uint64_t device_ns) const;

private:
    double nominal_ns_;
    double cycle_ns_;
    bool known_ = false;
    std::uint64_t last_ns_ = 0;
};

}  // namespace xorvox::host
