// The options of how colours become light.
#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "driver/host/white.h"
#include "tools/command_line.h"

namespace xorvox::tools {
namespace {

/// "0.9,1,0.85" or "5000" into `light`.
void parse_white(const std::string& text, LightOptions& light) {
    const std::vector<double> numbers = parse_numbers(text);
    const auto is_gain = [](double number) { return number >= 0.0 && number <= 1.0; };
    light.white.reset();
    light.white_kelvin.reset();
    if (numbers.size() == 1 && numbers[0] >= host::kLeastKelvin && numbers[0] <= host::kMostKelvin) {
        light.white_kelvin = numbers[0];
    } else if (numbers.size() == 3 && std::ranges::all_of(numbers, is_gain)) {
        light.white = glm::dvec3(numbers[0], numbers[1], numbers[2]);
    } else {
        throw CLI::ValidationError(
            "--white", fmt::format("'{}' is neither three gains from 0 to 1, as in 1,0.8,0.7, nor one number of "
                                   "kelvin from {:g} to {:g}, as in 5000",
                                   text, host::kLeastKelvin, host::kMostKelvin));
    }
}

}  // namespace

void add_light(CLI::App& app, LightOptions& light) {
    app.add_option(
           "--light", light.mode,
           "bright: every sample inside is lit in full (the default); uniform: each voxel once a panel, so that a "
           "rotor is as bright at its rim as at its axis; even: all of them, dimmed where they stand close together")
        ->check(CLI::IsMember({"bright", "uniform", "even"}).description(""))
        ->type_name("bright|uniform|even");
    app.add_option(
           "--dither", light.dither,
           "Light between two levels of the display: none, the nearest level (the default); ordered, mixed over "
           "neighbours; temporal, mixed over 64 frames as well, for what moves")
        ->check(CLI::IsMember({"none", "ordered", "temporal"}).description(""))
        ->type_name("none|ordered|temporal");
    app.add_option_function<std::string>(
           "--brightness",
           [&light](const std::string& text) {
               const std::vector<double> numbers = parse_numbers(text);
               if (numbers.size() != 1 || !(numbers[0] >= 0.0 && numbers[0] <= 100.0)) {
                   throw CLI::ValidationError("--brightness", fmt::format("'{}' is not a number from 0 to 100", text));
               }
               light.brightness_percent = numbers[0];
           },
           "Of all light, 0 to 100 (the default)")
        ->type_name("PERCENT");
    app.add_option_function<std::string>(
           "--white", [&light](const std::string& text) { parse_white(text, light); },
           "White balance: gains of red, green and blue from 0 to 1, or a colour temperature from 1500 to 15000")
        ->type_name("R,G,B|KELVIN");
    app.add_option("--calibration", light.calibration,
                   "How bright each LED is beside the others, measured; docs/light.md has the format")
        ->type_name("FILE.csv");
}

}  // namespace xorvox::tools
