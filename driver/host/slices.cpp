#include "driver/host/slices.h"

#include <algorithm>
#include <array>
#include <optional>

#include "driver/host/dither.h"
#include "driver/host/one_color.h"
#include "driver/host/pixel.h"
#include "driver/host/pixel_batch.h"
#include "driver/host/slice_map.h"

namespace xorvox::host {
namespace {

/// Some rows of the wire.
using Rows = std::array<std::uint64_t, kMostRows * kMostWords>;

/// Calls visit(panel, first row, rows, bits) for all rows of `slice`, in the order of the wire.
template <class Visit>
void for_each_rows(const DisplayDescription& display, const WireOrder& order, ConstBitVolumeView volume,
                   std::uint32_t slice, Visit visit) {
    Rows rows;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        for (std::uint32_t row = 0; row < display.panels[p].rows; row += kMostRows) {
            const std::uint32_t count = std::min(kMostRows, display.panels[p].rows - row);
            visit(p, row, count, order.fetch(volume, slice, p, row, count, rows));
        }
    }
}

}  // namespace

FramePainter::FramePainter(const DisplayDescription& display, const LightSettings& settings)
    : display_(display),
      lattice_(display),
      order_(display_, lattice_),
      points_(display_, lattice_, order_),
      encoder_(display_),
      gains_(display_, settings),
      dither_(settings.dither),
      white_(clipped(settings.white)) {
    set_brightness(settings.brightness);
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        slice_words_ += row_words(display.panels[p].columns) * display.panels[p].rows;
    }
    if (settings.mode != LightMode::Uniform) return;
    BitVolume all(lattice_.view());
    std::ranges::fill(all.view().words, ~std::uint64_t{0});
    static_cast<void>(SliceMap(display_, lattice_).thin(all.view()));
    allowed_.reserve(slice_words_ * display.slices);
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for_each_rows(display_, order_, all.view(), slice, [&](auto, auto, auto, std::span<std::uint64_t> bits) {
            allowed_.insert(allowed_.end(), bits.begin(), bits.end());
        });
    }
}

void FramePainter::set_brightness(float brightness) {
    brightness_ = clipped(glm::vec3(brightness)).r;
}

Status FramePainter::paint(ConstBitVolumeView volume, const ColorField& color, std::span<std::byte> frame,
                           std::uint32_t number) const {
    return paint_slices(volume, color, frame, 0, display_.slices, number);
}

Status FramePainter::paint_slices(ConstBitVolumeView volume, const ColorField& color, std::span<std::byte> frame,
                                  std::uint32_t first, std::uint32_t count, std::uint32_t number) const {
    const Lattice lattice = lattice_.view();
    if (volume.nx != lattice.nx || volume.ny != lattice.ny || volume.nz != lattice.nz ||
        volume.words.size() != volume_words(lattice.nx, lattice.ny, lattice.nz) ||
        frame.size() != frame_bytes(display_) || first > display_.slices || count > display_.slices - first) {
        return Status::InvalidArgument;
    }
    const std::size_t bytes_a_slice = slice_bytes(display_);
    std::span<std::byte> rest = frame.subspan(first * bytes_a_slice, count * bytes_a_slice);

    const glm::vec3 gain = brightness_ * white_;
    const std::optional<glm::vec3> constant = color.constant();
    std::optional<OneColor> one;
    PixelBatch batch(color, points_, encoder_, display_.format);
    for (std::uint32_t slice = first; slice < first + count; ++slice) {
        const glm::vec3 slice_gain = gain * gains_.of_slice(slice);
        const glm::vec3* pixel_gains = gains_.of_pixels(slice);
        const bool is_one_code = constant && pixel_gains == nullptr && dither_ == Dither::None;
        if (is_one_code) {
            const std::uint32_t code = encoder_.nearest(clipped(*constant) * slice_gain);
            if (!one || one->code() != code) one.emplace(code, display_.format);
        }
        if (!is_one_code) std::ranges::fill(rest.first(bytes_a_slice), std::byte{0});
        std::size_t allowed_at = slice * slice_words_;
        const auto paint_rows = [&](std::uint32_t p, std::uint32_t begin, std::uint32_t rows,
                                    std::span<std::uint64_t> bits) {
            if (!allowed_.empty()) {
                for (std::uint64_t& word : bits) word &= allowed_[allowed_at++];
            }
            const Panel& panel = display_.panels[p];
            const std::size_t words = row_words(panel.columns);
            const std::size_t length = row_bytes(panel, display_.format);
            if (is_one_code) {
                one->paint(bits, rows, rest.first(rows * length));
                rest = rest.subspan(rows * length);
                return;
            }
            for (std::uint32_t i = 0; i < rows; ++i) {
                const auto row_bits = bits.subspan(i * words, words);
                PixelRow row{slice, p, begin + i, rest.first(length), slice_gain, pixel_gains, std::nullopt};
                if (dither_ != Dither::None) {
                    row.threshold = dither_index(slice, p, begin + i, 0, dither_ == Dither::Temporal ? number : 0);
                }
                batch.add(row, row_bits);
                rest = rest.subspan(length);
                if (pixel_gains != nullptr) pixel_gains += panel.columns;
            }
        };
        for_each_rows(display_, order_, volume, slice, paint_rows);
    }
    batch.flush();
    return Status::Ok;
}

}  // namespace xorvox::host
