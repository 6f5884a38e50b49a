#include "driver/host/slices.h"

#include <algorithm>
#include <array>
#include <bit>

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

/// Calls visit(x) for every set voxel of `words` with begin ≤ x < end, upwards.
template <class Visit>
void for_each_set(std::span<const std::uint64_t> words, std::uint32_t begin, std::uint32_t end, Visit visit) {
    for (std::uint32_t first = begin / 64 * 64; first < end; first += 64) {
        std::uint64_t word = words[first / 64];
        if (first < begin) word &= ~std::uint64_t{0} << (begin - first);
        if (end - first < 64) word &= (std::uint64_t{1} << (end - first)) - 1;
        for (; word != 0; word &= word - 1) visit(first + static_cast<std::uint32_t>(std::countr_zero(word)));
    }
}

}  // namespace

FramePainter::FramePainter(const DisplayDescription& display)
    : display_(display), lattice_(display), extent_(extent(display)) {
    std::size_t offset = 0;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        std::uint32_t x = 0;
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            for (std::uint32_t row = 0; row < panel.rows; ++row) {
                const bool rotates = display.kind == DisplayKind::RotatingPanel;
                const std::uint32_t y = rotates ? slice : row;
                const std::uint32_t k = rotates ? panel.rows - 1 - row : slice;
                rows_.push_back({offset, x, y, k, panel.columns});
                offset += row_bytes(panel, display.format);
            }
            x += panel.columns;
        }
    }
}

Status FramePainter::paint(ConstBitVolumeView volume, const ColorField& color, std::span<std::byte> frame) const {
    const Lattice lattice = lattice_.view();
    if (volume.nx != lattice.nx || volume.ny != lattice.ny || volume.nz != lattice.nz ||
        volume.words.size() != volume_words(lattice.nx, lattice.ny, lattice.nz) ||
        frame.size() != frame_bytes(display_)) {
        return Status::InvalidArgument;
    }
    std::ranges::fill(frame, std::byte{0});
    const glm::dvec3 scale = 1.0 / (extent_.upper - extent_.lower);
    Batch batch(color, display_.format);
    for (const PixelRow& row : rows_) {
        const auto bytes = frame.subspan(row.offset_bytes);
        for_each_set(volume.row(row.y, row.k), row.x, row.x + row.columns, [&](std::uint32_t x) {
            const glm::dvec3 place = sample_position(lattice, x, row.y, row.k);
            batch.add(glm::vec3((place - extent_.lower) * scale), bytes, x - row.x);
        });
    }
    batch.flush();
    return Status::Ok;
}

}  // namespace xorvox::host
