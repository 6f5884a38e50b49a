// Calibration: how bright the LEDs of one display are beside each other, measured, as a text file tells it.
//
//   # LEDs not named are 1
//   panel,row,column,red,green,blue
//   0,12,63,0.93,1,0.88
//
// The first line that is neither empty nor a comment (#) names the columns, each once, in any order. On stacked planes
// there is `plane` instead of `panel`, since every plane has LEDs of its own; on other displays a panel's LED is the
// same in every slice. Rows and columns count from 0 as on the wire (driver/display/description.h). A gain, 0 … 1, is
// what the light of that channel is multiplied by: the least bright LED has 1, brighter ones less. On mono formats the
// luminance of the three counts, so give all three the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "voxelizer/error.h"

namespace xorvox::host {

class Calibration {
public:
    /// Bytes of text that parse() takes at most: more than a million LEDs.
    static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

    struct Led {
        std::uint32_t unit = 0;   ///< Panel, or plane.
        std::uint32_t pixel = 0;  ///< Of its slice, in the order of the wire, over all panels.
        glm::vec3 gain{1.0f};
    };

    /// Reads `text`, made for `display`, which must be valid. An Error says the line and what is wrong with it: an
    /// unknown or missing column, no number, an LED that the display has not, a gain beyond 0 … 1, an LED that was
    /// named before, more than kMostBytes. Memory is in proportion to the text. Throws std::bad_alloc.
    static Expected<Calibration> parse(std::string_view text, const DisplayDescription& display);

    /// By unit and pixel; each once.
    std::span<const Led> leds() const { return leds_; }

private:
    std::vector<Led> leds_;
};

}  // namespace xorvox::host
