// The bit planes as a processor without SSE2 makes them, which this one may have.
#pragma once

#include "driver/device/bit_planes.h"

namespace xorvox::device {

Status split_bit_planes_portable(const BitPlaneLayout& layout, std::span<const std::byte> pixels,
                                 std::span<std::byte> planes);

}  // namespace xorvox::device
