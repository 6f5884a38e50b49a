// Orders of slices, as ScanControl gives them, without one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "driver/device/scan_order.h"
#include "driver/display/description.h"

namespace xorvox::test {

/// A frame of random bits.
inline std::vector<std::byte> random_page(const DisplayDescription& display, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<std::byte> page(frame_bytes(display));
    for (std::byte& byte : page) byte = static_cast<std::byte>(random());
    return page;
}

/// Slice `slice` of `page` from `begin_ns` until `end_ns`.
inline device::ScanOrder lit_order(const DisplayDescription& display, std::span<const std::byte> page,
                                   std::uint32_t slice, std::uint64_t begin_ns, std::uint64_t end_ns) {
    device::ScanOrder order;
    order.dark = device::Dark::No;
    order.slice = slice;
    order.brightness = 255;
    order.bytes = page.subspan(slice * slice_bytes(display), slice_bytes(display));
    order.begin_ns = begin_ns;
    order.end_ns = end_ns;
    return order;
}

inline device::ScanOrder dark_order(std::uint64_t begin_ns) {
    device::ScanOrder order;
    order.dark = device::Dark::NoPicture;
    order.begin_ns = begin_ns;
    order.end_ns = begin_ns + 1'000'000;
    return order;
}

}  // namespace xorvox::test
