#include "tools/light_options.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "driver/host/white.h"
#include "tools/console.h"
#include "voxelizer/io/file_name.h"

namespace xorvox::tools {
namespace {

Expected<std::string> read_calibration(const std::string& path) {
    const std::string name = io::printable_name(path);
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        return fail(name + ": is a directory; a calibration file (.csv) was expected");
    }
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (file == nullptr) return fail(name + ": cannot be opened: " + std::generic_category().message(errno));
    std::string text;
    std::array<char, 65536> part;
    while (const std::size_t count = std::fread(part.data(), 1, part.size(), file.get())) {
        text.append(part.data(), count);
        if (text.size() > host::Calibration::kMostBytes) break;
    }
    if (std::ferror(file.get()) != 0) return fail(name + ": cannot be read: " + std::generic_category().message(errno));
    return text;
}

glm::vec3 white_of(const LightOptions& options) {
    if (options.white_kelvin) return host::white_of_temperature(*options.white_kelvin);
    return options.white ? glm::vec3(*options.white) : glm::vec3(1.0f);
}

}  // namespace

Expected<ChosenLight> choose_light(const LightOptions& options, const DisplayDescription& display) {
    ChosenLight light;
    if (options.mode == "uniform") light.settings.mode = host::LightMode::Uniform;
    if (options.mode == "even") light.settings.mode = host::LightMode::Even;
    if (options.dither == "ordered") light.settings.dither = host::Dither::Ordered;
    if (options.dither == "temporal") light.settings.dither = host::Dither::Temporal;
    light.settings.brightness = static_cast<float>(options.brightness_percent / 100.0);
    light.settings.white = white_of(options);
    if (options.calibration.empty()) return light;
    const Expected<std::string> text = read_calibration(options.calibration);
    if (!text) return fail("--calibration: " + text.error().message);
    Expected<host::Calibration> calibration = host::Calibration::parse(*text, display);
    if (!calibration) {
        return fail(
            fmt::format("--calibration: {}: {}", io::printable_name(options.calibration), calibration.error().message));
    }
    light.calibration = std::make_unique<host::Calibration>(std::move(*calibration));
    light.settings.calibration = light.calibration.get();
    return light;
}

Expected<void> check_still(const LightOptions& options) {
    if (options.dither != "temporal") return {};
    return fail(
        "--dither temporal: one frame shows a still, and it takes many to mix levels in time; use --dither "
        "ordered, --spin RPM, or xorvox play");
}

std::string light_settings_json(const LightOptions& options) {
    const glm::vec3 white = white_of(options);
    return fmt::format(
        "{{\"mode\": {}, \"dither\": {}, \"brightness_percent\": {}, \"white\": [{:.4f}, {:.4f}, {:.4f}], "
        "\"calibration\": {}}}",
        json_string(options.mode), json_string(options.dither), options.brightness_percent, white.r, white.g, white.b,
        options.calibration.empty() ? "null" : json_string(options.calibration));
}

}  // namespace xorvox::tools
