// ScanOut: makes strobes of what the device half orders. Two of them, which give the same light:
//
//   strobe_scan   row and plane events by the modulation (driver/device/scan/modulation.h): fast
//   edge_scan     the device half's own scanner sets pins, and models of the chips behind them say what is lit
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "driver/device/scan_order.h"
#include "driver/display/description.h"
#include "sim/strobe.h"
#include "transport/lines.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

/// One thread. What strobes borrow is valid in the sink's call alone.
class ScanOut {
public:
    virtual ~ScanOut() = default;

    /// Gives all strobes that end until `now_ns`, which never goes back.
    virtual void run_until(std::uint64_t now_ns) = 0;

    /// A new order, at `now_ns`, to which it was run: what is lit ends, and the order's slice begins, or it goes dark.
    /// The order's bytes are copied. `frame` is the id that its strobes tell.
    virtual void begin(const device::ScanOrder& order, std::uint32_t frame, std::uint64_t now_ns) = 0;
};

/// For every valid display. Of LEDs that keep their light, of projectors, of responses that are not linear, and where
/// the driver is not known and has one row group: strobes of kLevels. `display` is copied; what it borrows must outlive
/// the result.
std::unique_ptr<ScanOut> make_strobe_scan(const DisplayDescription& display, StrobeSink sink);

/// All levels from `time_ns` on; `changed` says which lines have others than before (the first time: all that there
/// are).
using PinSink = std::function<void(std::uint64_t time_ns, LineMask levels, LineMask changed)>;

/// For displays whose pins there are models of: HUB75, 74HC595, and Direct with more than one row group, all with a
/// linear response; an Error names what this one has. `display` must be valid, and is copied. Lines change at twice the
/// pixel clock; where that is 0, data are shifted in no time, as in the modulation. Rows, bits, times and the layer of
/// a cube are what the pins say; the plane is that of the order's slot at the time. `pins` may be empty; it is called
/// before the strobe is given that a change ends, and first in this function.
Expected<std::unique_ptr<ScanOut>> make_edge_scan(const DisplayDescription& display, StrobeSink sink, PinSink pins);

/// Names of the lines that edge_scan sets, by number: "clock", "latch", "r1" …; for traces.
std::vector<std::string> pin_names(const DisplayDescription& display);

}  // namespace xorvox::sim
