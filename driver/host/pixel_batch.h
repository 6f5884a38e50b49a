// PixelBatch: set voxels on their way into a frame, many at a time: their points, colours, light, codes, and bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "driver/host/color.h"
#include "driver/host/pixel_encoder.h"
#include "driver/host/sample_points.h"

namespace xorvox::host {

/// A row of the wire, where it is, and what becomes of its light.
struct PixelRow {
    std::uint32_t slice = 0;
    std::uint32_t panel = 0;
    std::uint32_t number = 0;
    std::span<std::byte> bytes;              ///< All dark.
    glm::vec3 gain{1.0f};                    ///< Of all of its pixels.
    const glm::vec3* gains = nullptr;        ///< Besides, of each; null: all 1.
    std::optional<std::uint32_t> threshold;  ///< dither_index() of its first pixel; none: not dithered.
};

/// Lives as long as one painting; one thread.
class PixelBatch {
public:
    /// All are borrowed.
    PixelBatch(const ColorField& color, const SamplePoints& points, const PixelEncoder& encoder, PixelFormat format);
    PixelBatch(const PixelBatch&) = delete;
    PixelBatch& operator=(const PixelBatch&) = delete;

    /// The pixels of `row` whose bits are set in `bits`. All rows are dithered, or none.
    void add(const PixelRow& row, std::span<const std::uint64_t> bits);

    /// Writes what was added and not yet written.
    void flush();

private:
    static constexpr std::size_t kMost = 256;

    void add(const PixelRow& row, std::span<const std::uint32_t> columns);
    void write();

    const ColorField& color_;
    const std::optional<glm::vec3> constant_;
    const SamplePoints& sample_points_;
    const PixelEncoder& encoder_;
    PixelFormat format_;
    bool is_dithered_ = false;
    std::size_t size_ = 0;
    std::array<glm::vec3, kMost> points_;
    std::array<glm::vec3, kMost> colors_;  ///< Then the light.
    std::array<glm::vec3, kMost> gains_;
    std::array<float, kMost> thresholds_;
    std::array<std::uint32_t, kMost> codes_;
    std::array<std::byte*, kMost> rows_;
    std::array<std::uint32_t, kMost> columns_;
};

}  // namespace xorvox::host
