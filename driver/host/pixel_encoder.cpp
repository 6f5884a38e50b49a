#include "driver/host/pixel_encoder.h"

#include <algorithm>
#include <cstddef>

#include "driver/host/pixel.h"

namespace xorvox::host {
namespace {

/// The levels of channel `index` that `display` shows.
ChannelLevels shown_levels(const DisplayDescription& display, std::size_t index) {
    return {display.light, std::min(channel_bits(display.format)[index].bits, shown_bit_planes(display))};
}

}  // namespace

PixelEncoder::PixelEncoder(const DisplayDescription& display)
    : is_mono_(is_mono(display.format)),
      levels_{shown_levels(display, 0), shown_levels(display, 1), shown_levels(display, 2)} {
    const std::array<ChannelBits, 3> channels = channel_bits(display.format);
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const std::uint32_t shown = std::min(channels[i].bits, shown_bit_planes(display));
        shifts_[i] = channels[i].shift + channels[i].bits - shown;
    }
}

std::uint32_t PixelEncoder::code(const glm::vec3& light, float round_up) const {
    if (is_mono_) {
        const float gray = std::min(luminance(light), 1.0f);
        return static_cast<std::uint32_t>(levels_[0].place(gray) + round_up) << shifts_[0];
    }
    return static_cast<std::uint32_t>(levels_[0].place(light.r) + round_up) << shifts_[0] |
           static_cast<std::uint32_t>(levels_[1].place(light.g) + round_up) << shifts_[1] |
           static_cast<std::uint32_t>(levels_[2].place(light.b) + round_up) << shifts_[2];
}

std::uint32_t PixelEncoder::faintest(const glm::vec3& light) const {
    const float strongest = std::max({light.r, light.g, light.b});
    if (!(strongest > 0.0f)) return 0;
    if (is_mono_) return 1u << shifts_[0];
    std::uint32_t code = 0;
    for (int i = 0; i < 3; ++i) {
        if (light[i] >= 0.5f * strongest) code |= 1u << shifts_[static_cast<std::size_t>(i)];
    }
    return code;
}

std::uint32_t PixelEncoder::nearest(const glm::vec3& light) const {
    const std::uint32_t found = code(light, 0.5f);
    return found != 0 ? found : faintest(light);
}

std::uint32_t PixelEncoder::dithered(const glm::vec3& light, float threshold) const {
    return code(light, 1.0f - threshold);
}

void PixelEncoder::nearest(std::span<const glm::vec3> lights, std::span<std::uint32_t> codes) const {
    for (std::size_t i = 0; i < lights.size(); ++i) codes[i] = nearest(lights[i]);
}

void PixelEncoder::dithered(std::span<const glm::vec3> lights, std::span<const float> thresholds,
                            std::span<std::uint32_t> codes) const {
    for (std::size_t i = 0; i < lights.size(); ++i) codes[i] = dithered(lights[i], thresholds[i]);
}

}  // namespace xorvox::host
