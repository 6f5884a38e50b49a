// Display files: a DisplayDescription from TOML, and the presets that are built in. docs/displays.md explains the keys;
// driver/display/presets/*.toml show them. Every function may be called from any number of threads.
#pragma once

#include <cstddef>
#include <memory>
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

/// A description with what else its file says. Owns what `points` and `plane_heights_mm` borrow, together with every
/// copy of it: a DisplayDescription that is copied from it must not outlive them all.
struct DisplayFile : DisplayDescription {
    std::string text;                  ///< The file itself, for recordings.
    std::string summary;               ///< One line; may be empty.
    std::vector<std::string> assumed;  ///< Keys whose values have no source: "slices", "panel.rows", "scan.latch_ns".

    std::shared_ptr<const std::vector<PointMm>> points_memory;
    std::shared_ptr<const std::vector<double>> plane_heights_memory;
};

/// A mistake in a display file.
struct DisplayMistake {
    std::size_t line;      ///< From 1.
    std::string message;   ///< Key, what was found and what is allowed; one line, without file and line.
    bool missing = false;  ///< Something that is not there.
    /// Between values that are in order one by one. These are looked for once there are no other mistakes.
    bool contradiction = false;
};

/// Reads and validates a description. `source` names the text in messages ("file.toml"), which give line, key, what was
/// found and what is allowed: the first of find_mistakes(). Unknown keys, and keys that do not apply to the display's
/// kind, are errors.
Expected<DisplayFile> parse_display(std::string_view toml, std::string_view source);

/// Every mistake that one reading finds, by line, what is missing last; none if parse_display() takes `toml`. Of text
/// that is no TOML the first one; where it has no kind that is known, no ranges that depend on the kind. Whether values
/// contradict each other is looked at once each of them is in order: then the mistakes are contradictions.
std::vector<DisplayMistake> find_mistakes(std::string_view toml);

/// The text of a display file, and what messages call it.
struct DisplaySource {
    std::string name;
    std::string text;
};
/// Finds a preset by its name, or reads the TOML file at a path: anything with a '/' or ending in .toml. A file has at
/// most 1 MiB. The message for an unknown name lists the presets.
Expected<DisplaySource> find_display(const std::string& name_or_path);

/// find_display() and parse_display().
Expected<DisplayFile> load_display(const std::string& name_or_path);

/// What is wrong with a description that did not come from TOML; Ok if nothing: all that a display file is checked for.
/// No file involved.
Expected<void> validate_display(const DisplayDescription& display);

}  // namespace xorvox
