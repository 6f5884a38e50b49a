#include "driver/host/slices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "driver/host/pixel.h"
#include "driver/host/slice_map.h"

namespace xorvox::host {
namespace {

/// Set voxels on their way into the frame. Colours are evaluated for many at a time.
class Batch {
public:
    Batch(const ColorField& color, PixelFormat format) : color_(color), format_(format) {}

    void add(const glm::vec3& point, std::span<std::byte> row, std::uint32_t column) {
        points_[size_] = point;
        places_[size_] = {row, column};
        if (++size_ == kMost) flush();
    }

    void flush() {
        color_.evaluate(std::span(points_).first(size_), std::span(colors_).first(size_));
        for (std::size_t i = 0; i < size_; ++i) {
            put_pixel(places_[i].row, places_[i].column, format_, visible_code(colors_[i], format_));
        }
        size_ = 0;
    }

private:
    static constexpr std::size_t kMost = 256;

    struct Place {
        std::span<std::byte> row;
        std::uint32_t column;
    };

    const ColorField& color_;
    PixelFormat format_;
    std::size_t size_ = 0;
    std::array<glm::vec3, kMost> points_;
    std::array<glm::vec3, kMost> colors_;
    std::array<Place, kMost> places_;
};

/// Calls visit(column) for every set bit of a row, upwards.
template <class Visit>
void for_each_set(std::span<const std::uint64_t> row, Visit visit) {
    for (std::size_t i = 0; i < row.size(); ++i) {
        for (std::uint64_t word = row[i]; word != 0; word &= word - 1) {
            visit(static_cast<std::uint32_t>(i * 64) + static_cast<std::uint32_t>(std::countr_zero(word)));
        }
    }
}

/// Entry b has bit i of b at bit i·bits.
constexpr std::array<std::uint64_t, 256> make_spread(std::uint32_t bits) {
    std::array<std::uint64_t, 256> spread{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        for (std::uint32_t i = 0; i < 8; ++i) spread[byte] |= std::uint64_t{byte >> i & 1u} << (i * bits);
    }
    return spread;
}

/// Rows in one colour. Of formats of at most 8 bits, eight pixels at a time.
class OneColor {
public:
    OneColor(std::uint32_t code, PixelFormat format)
        : code_(code), format_(format), bits_(bits_per_pixel(format)), spread_(bits_ <= 8 ? table(bits_) : nullptr) {}

    /// `bytes` are all zero.
    void paint(std::span<const std::uint64_t> row, std::span<std::byte> bytes) const {
        if (spread_ == nullptr) {
            for_each_set(row, [&](std::uint32_t column) { put_pixel(bytes, column, format_, code_); });
            return;
        }
        for (std::size_t i = 0; i < row.size(); ++i) {
            std::size_t at = i * 8 * bits_;
            for (std::uint64_t word = row[i]; word != 0; word >>= 8, at += bits_) {
                // A code has no more bits than its place, so that the products do not meet.
                const std::uint64_t pixels = (*spread_)[word & 0xff] * code_;
                std::memcpy(bytes.data() + at, &pixels, std::min<std::size_t>(bits_, bytes.size() - at));
            }
        }
    }

private:
    static const std::array<std::uint64_t, 256>* table(std::uint32_t bits) {
        static constexpr std::array kSpread{make_spread(1), make_spread(2), make_spread(3), make_spread(4),
                                            make_spread(5), make_spread(6), make_spread(7), make_spread(8)};
        return &kSpread[bits - 1];
    }

    std::uint32_t code_;
    PixelFormat format_;
    std::uint32_t bits_;
    const std::array<std::uint64_t, 256>* spread_;
};

/// A row of the wire, and which of its pixels are lit.
struct Row {
    std::uint32_t slice, panel, number;
    std::span<const std::uint64_t> bits;
};

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
    : display_(display), lattice_(display), order_(display_, lattice_), extent_(extent(display)) {
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

Status FramePainter::paint(ConstBitVolumeView volume, const ColorField& color, std::span<std::byte> frame,
                           std::uint32_t number) const {
    return paint_slices(volume, color, frame, 0, display_.slices, number);
}

Status FramePainter::paint_slices(ConstBitVolumeView volume, const ColorField& color, std::span<std::byte> frame,
                                  std::uint32_t first, std::uint32_t count, std::uint32_t) const {
    const Lattice lattice = lattice_.view();
    if (volume.nx != lattice.nx || volume.ny != lattice.ny || volume.nz != lattice.nz ||
        volume.words.size() != volume_words(lattice.nx, lattice.ny, lattice.nz) ||
        frame.size() != frame_bytes(display_) || first > display_.slices || count > display_.slices - first) {
        return Status::InvalidArgument;
    }
    const std::size_t bytes_a_slice = slice_bytes(display_);
    std::span<std::byte> rest = frame.subspan(first * bytes_a_slice, count * bytes_a_slice);
    std::ranges::fill(rest, std::byte{0});

    const glm::dvec3 scale = 1.0 / (extent_.upper - extent_.lower);
    const std::optional<glm::vec3> constant = color.constant();
    const OneColor one(constant ? visible_code(*constant, display_.format) : 0, display_.format);
    Batch batch(color, display_.format);
    const auto paint_row = [&](const Row& row, std::span<std::byte> bytes) {
        if (constant) return one.paint(row.bits, bytes);
        for_each_set(row.bits, [&](std::uint32_t column) {
            const Sample sample = order_.sample(row.slice, row.panel, row.number, column);
            const glm::dvec3 place = sample_position(lattice, sample.x, sample.y, sample.k);
            batch.add(glm::vec3((place - extent_.lower) * scale), bytes, column);
        });
    };
    for (std::uint32_t slice = first; slice < first + count; ++slice) {
        std::size_t allowed_at = slice * slice_words_;
        for_each_rows(display_, order_, volume, slice,
                      [&](std::uint32_t p, std::uint32_t begin, std::uint32_t rows, std::span<std::uint64_t> bits) {
                          if (!allowed_.empty()) {
                              for (std::uint64_t& word : bits) word &= allowed_[allowed_at++];
                          }
                          const std::size_t words = row_words(display_.panels[p].columns);
                          const std::size_t length = row_bytes(display_.panels[p], display_.format);
                          for (std::uint32_t i = 0; i < rows; ++i) {
                              paint_row({slice, p, begin + i, bits.subspan(i * words, words)}, rest.first(length));
                              rest = rest.subspan(length);
                          }
                      });
    }
    batch.flush();
    return Status::Ok;
}

}  // namespace xorvox::host
