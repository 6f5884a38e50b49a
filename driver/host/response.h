// Response: the light of each level of a channel (struct Light of driver/display/description.h), and the way back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "driver/display/description.h"

namespace xorvox::host {

/// The levels of one channel, 0 … most(), and the light that each gives, 0 … 1. The same bits on every machine. Any
/// number of threads may use one.
class ChannelLevels {
public:
    /// Of the `bits` bits a channel that are shown, 1 … 8.
    ChannelLevels(const Light& response, std::uint32_t bits);

    std::uint32_t most() const { return most_; }

    /// Light of a level.
    float light(std::uint32_t level) const { return light_[level]; }

    /// Where `light`, 0 … 1, lies among the levels: the level below it, plus the part of the way in light to the next.
    /// So the nearest level in light is that of place + ½, rounded down.
    float place(float light) const { return is_linear_ ? light * scale_ : curved_place(light); }

private:
    float curved_place(float light) const;

    // Where to begin to look for a level: by the exponent of the light, 2^-32 … 1, and the leading bits of its
    // mantissa.
    static constexpr std::uint32_t kBucketShift = 17;
    static constexpr std::uint32_t kFirstBucket = (127u - 32u) << (23 - kBucketShift);
    static constexpr std::size_t kBuckets = (32u << (23 - kBucketShift)) + 1;

    bool is_linear_;
    std::uint32_t most_;
    float scale_;
    std::array<float, 256> light_{};
    std::array<float, 256> per_light_{};  ///< 1 ÷ the light from this level to the next.
    std::array<std::uint8_t, kBuckets> first_{};
};

}  // namespace xorvox::host
