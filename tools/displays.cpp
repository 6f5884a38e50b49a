#include <algorithm>

#include <fmt/format.h>

#include "driver/display/toml.h"
#include "tools/commands.h"
#include "tools/console.h"

namespace xorvox::tools {

Expected<void> displays(const DisplaysOptions& options) {
    std::size_t width = 0;
    for (const Preset& preset : presets()) width = std::max(width, preset.name.size());
    const char* separator = "";
    if (options.json) fmt::print("[");
    for (const Preset& preset : presets()) {
        if (options.json) {
            fmt::print("{}\n  {{\"name\": {}, \"summary\": {}}}", separator, json_string(preset.name),
                       json_string(preset.summary));
            separator = ",";
        } else {
            fmt::print("{:<{}}  {}\n", preset.name, width, preset.summary);
        }
    }
    if (options.json) fmt::print("\n]\n");
    return {};
}

}  // namespace xorvox::tools
