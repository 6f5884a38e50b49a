// LevelScan: strobes of what makes levels by itself: projectors, addressable strings, controllers with a table. Its
// part of strobe_scan; sim/light_times.h draws when what is lit.
#pragma once

#include <memory>

#include "driver/display/description.h"
#include "sim/scan_out.h"

namespace xorvox::sim {

/// As make_strobe_scan(), for displays that are not lit_by_planes().
std::unique_ptr<ScanOut> make_level_scan(const DisplayDescription& display, StrobeSink sink);

}  // namespace xorvox::sim
