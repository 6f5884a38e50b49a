// Display files: a DisplayDescription from TOML, and the presets that are built in. driver/display/presets/*.toml show
// the keys; docs/displays.md explains them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "driver/display/description.h"
#include "voxelizer/error.h"

namespace xorvox {

/// A display file that is compiled in.
struct Preset {
    std::string_view name;     ///< As given to `--display`; the file's name without .toml.
    std::string_view summary;  ///< One line for `xorvox displays`.
    std::string_view text;     ///< The whole TOML file.
};

/// Every preset, by name. Static storage.
const std::vector<Preset>& presets();

/// Reads and validates a description. `source` names the text in messages ("file.toml"), which give line, key, what was
/// found and what is allowed. Unknown keys are errors, with the nearest known one.
Expected<DisplayDescription> parse_display(std::string_view toml, std::string_view source);

/// A preset's name, or the path of a TOML file (anything with a '/' or ending in .toml). The message for an unknown
/// name lists the presets.
Expected<DisplayDescription> load_display(const std::string& name_or_path);

/// What is wrong with a description that did not come from TOML; Ok if nothing. Freestanding in spirit: no file
/// involved.
Expected<void> validate_display(const DisplayDescription& display);

}  // namespace xorvox
