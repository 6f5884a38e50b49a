// PixelEncoder: from the light that is wanted of a pixel to its code, through the display's response and the bits that
// it shows.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "driver/host/response.h"

namespace xorvox::host {

/// Any number of threads may use one. Light is 0 … 1 a channel; mono formats show its luminance. Of a display that
/// shows fewer bits than its format has, the others stay 0.
class PixelEncoder {
public:
    explicit PixelEncoder(const DisplayDescription& display);

    /// The code whose light is nearest, channel by channel. Unless the light is black, it is not 0: of light that is
    /// too faint, the strongest channel and those at least half as strong have their faintest level, so that no set
    /// voxel is lost and grey stays grey.
    std::uint32_t nearest(const glm::vec3& light) const;

    /// In each channel the level above where the light is further than `threshold`, above 0 and below 1, on the way
    /// from the level below to it.
    std::uint32_t dithered(const glm::vec3& light, float threshold) const;

    /// The same for many; all spans have one size.
    void nearest(std::span<const glm::vec3> lights, std::span<std::uint32_t> codes) const;
    void dithered(std::span<const glm::vec3> lights, std::span<const float> thresholds,
                  std::span<std::uint32_t> codes) const;

private:
    std::uint32_t code(const glm::vec3& light, float round_up) const;
    std::uint32_t faintest(const glm::vec3& light) const;

    bool is_mono_;
    std::array<std::uint32_t, 3> shifts_{};  ///< Of red, green and blue: of the lowest bit that is shown.
    std::array<ChannelLevels, 3> levels_;
};

}  // namespace xorvox::host
