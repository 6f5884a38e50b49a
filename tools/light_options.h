// LightOptions: --light, --dither, --brightness, --white and --calibration, as typed, and what they mean.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "driver/host/calibration.h"
#include "driver/host/light.h"
#include "voxelizer/error.h"

namespace xorvox::tools {

struct LightOptions {
    std::string mode = "bright";         ///< Or "uniform" or "even".
    std::string dither = "none";         ///< Or "ordered" or "temporal".
    double brightness_percent = 100.0;   ///< 0 … 100.
    std::optional<glm::dvec3> white;     ///< Gains, 0 … 1.
    std::optional<double> white_kelvin;  ///< Instead: 1500 … 15000.
    std::string calibration;             ///< A file; empty: none.
};

/// The settings, and what they borrow.
struct ChosenLight {
    host::LightSettings settings;
    std::unique_ptr<host::Calibration> calibration;
};

/// Reads the calibration file, if one is named. Messages begin with the option.
Expected<ChosenLight> choose_light(const LightOptions& options, const DisplayDescription& display);

/// An Error, which says what to do instead, where the options want frames that follow each other.
Expected<void> check_still(const LightOptions& options);

/// The options as an object of JSON.
std::string light_settings_json(const LightOptions& options);

}  // namespace xorvox::tools
