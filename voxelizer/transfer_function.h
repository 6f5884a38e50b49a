// TransferFunction: the colour of a value, as for volumes of densities or temperatures.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "voxelizer/error.h"

namespace xorvox {

class TransferFunction {
public:
    struct Stop {
        double value = 0.0;     ///< Finite; in the volume's own units.
        glm::dvec3 color{0.0};  ///< Linear light.
        double opacity = 1.0;   ///< 0 … 1; what is less opaque is dimmer.
    };

    /// Of one stop at least, their values increasing.
    explicit TransferFunction(std::vector<Stop> stops);

    /// Reads `VALUE:COLOR[:OPACITY],…`, as in "0:black,0.3:#ff8000,1:white:0.5"; values increase, at most 256 stops.
    /// `parse_color` reads one colour. Errors say which stop is wrong, and why.
    static Expected<TransferFunction> parse(std::string_view text,
                                            const std::function<Expected<glm::dvec3>(std::string_view)>& parse_color);

    /// The colour of `value` times its opacity: between two stops in proportion, in linear light; beyond them as there.
    /// Thread-safe.
    glm::vec3 at(double value) const;

private:
    struct Node {
        double value;
        glm::dvec3 light;  // Colour times opacity.
    };
    std::vector<Node> nodes_;
};

}  // namespace xorvox
