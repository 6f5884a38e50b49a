#include "driver/host/response.h"

#include <algorithm>
#include <bit>

#include "voxelizer/elementary.h"

namespace xorvox::host {
namespace {

/// The light of v = level ÷ highest level.
double response(const Light& light, double v) {
    switch (light.response) {
        case Response::Linear: break;
        case Response::Gamma: return v > 0.0 ? elementary::pow(v, light.gamma) : 0.0;
        case Response::Srgb: return v <= 0.04045 ? v / 12.92 : elementary::pow((v + 0.055) / 1.055, 2.4);
        case Response::Cie1931: {
            const double lightness = 100.0 * v;
            const double root = (lightness + 16.0) / 116.0;
            return lightness <= 8.0 ? lightness * 27.0 / 24389.0 : root * root * root;
        }
    }
    return v;
}

}  // namespace

ChannelLevels::ChannelLevels(const Light& of, std::uint32_t bits)
    : is_linear_(of.response == Response::Linear), most_((1u << bits) - 1), scale_(static_cast<float>(most_)) {
    for (std::uint32_t level = 0; level <= most_; ++level) {
        light_[level] = static_cast<float>(response(of, static_cast<double>(level) / most_));
    }
    light_[most_] = 1.0f;
    for (std::uint32_t level = 0; level < most_; ++level) {
        per_light_[level] = 1.0f / (light_[level + 1] - light_[level]);
    }
    std::uint8_t level = 0;
    for (std::uint32_t bucket = 1; bucket < kBuckets; ++bucket) {
        const float least = std::bit_cast<float>((kFirstBucket + bucket) << kBucketShift);
        while (level < most_ && light_[level + 1u] <= least) ++level;
        first_[bucket] = level;
    }
}

float ChannelLevels::curved_place(float light) const {
    if (!(light > 0.0f)) return 0.0f;  // Of -0, too, whose bits are those of no bucket.
    const std::uint32_t bucket = std::bit_cast<std::uint32_t>(light) >> kBucketShift;
    std::uint32_t level =
        first_[bucket > kFirstBucket ? std::min<std::size_t>(bucket - kFirstBucket, kBuckets - 1) : 0];
    while (level < most_ && light_[level + 1] <= light) ++level;
    return static_cast<float>(level) + (light - light_[level]) * per_light_[level];
}

}  // namespace xorvox::host
