#include "driver/device/scan/slice_planes.h"

namespace xorvox::device {

void SlicePlanes::init(const SliceConfig& config, std::span<std::byte> buffer) {
    buffer_ = buffer;
    panel_count_ = config.panel_count;
    std::size_t first = 0;
    for (std::uint32_t p = 0; p < panel_count_; ++p) {
        layouts_[p] = config.layout(p);
        first_[p] = first;
        first += layouts_[p].bytes();
    }
}

Status SlicePlanes::split(const ScanOrder& order) {
    std::span<const std::byte> pixels = order.bytes;
    for (std::uint32_t p = 0; p < panel_count_; ++p) {
        if (const Status status = split_bit_planes(layouts_[p], pixels, buffer_.subspan(first_[p]));
            status != Status::Ok) {
            return status;
        }
        pixels = pixels.subspan(layouts_[p].pixel_bytes());
    }
    slice_ = order.slice;
    mirrored_ = order.mirrored;
    return Status::Ok;
}

}  // namespace xorvox::device
