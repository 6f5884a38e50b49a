// Delivery: one frame to a display, in this program or at the other end of a link.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "driver/display/description.h"
#include "driver/host/session.h"
#include "sim/statistics.h"
#include "tools/commands.h"
#include "transport/address.h"
#include "voxelizer/io/atomic_file.h"

namespace xorvox::tools {

/// What became of the frame.
struct Delivery {
    host::SessionStatistics session;
    std::optional<sim::Statistics> light;  ///< Of the display in this program, on loopback.
    double picture_covered = 0.0;
};

/// Sends `frame`, in which `voxels` pixels are lit, and waits until the display shows it, or a link without a way back
/// has taken it. `png`, on loopback: where a picture of the light goes; null for none.
Expected<Delivery> deliver(const ShowOptions& options, const transport::Address& address,
                           const DisplayDescription& display, std::span<const std::byte> frame, std::size_t voxels,
                           io::AtomicFile* png);

}  // namespace xorvox::tools
