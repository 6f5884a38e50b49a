// Stage: all that a frame needs, read and checked: where it goes, the display, what is shown, and its colour.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "driver/display/toml.h"
#include "driver/host/color.h"
#include "tools/commands.h"
#include "tools/content.h"
#include "tools/delivery.h"
#include "tools/frame_maker.h"
#include "tools/placement.h"
#include "transport/address.h"
#include "voxelizer/io/atomic_file.h"

namespace xorvox::tools {

struct Stage {
    transport::Address address;
    DisplayFile display;
    std::unique_ptr<host::ColorField> color;
    std::unique_ptr<Content> content;
    std::unique_ptr<FrameMaker> maker;
    std::optional<io::AtomicFile> png;              ///< Of --png.
    std::optional<sim::RecordingWriter> recording;  ///< Of --record.

    io::AtomicFile* picture() { return png ? &*png : nullptr; }
    sim::RecordingWriter* recorder() { return recording ? &*recording : nullptr; }
};

/// Sets it, for something that turns like `turning`. What is wrong with the options is found before any file is made,
/// and those of --png and --record are made before the model is read: only what the model itself says against them is
/// found later, and then none is left.
Expected<std::unique_ptr<Stage>> set_stage(const StageOptions& options, Turning turning);

/// What a person wants to know of the light: how far it was dimmed, and of a display in this program what was lit.
void print_light(const StageOptions& options, const Stage& stage, const std::optional<LightSeen>& light);

/// Members of a JSON object: what the report of a stage begins with, `inside` samples being inside, and what it ends
/// with.
std::string stage_json(const StageOptions& options, const Stage& stage, std::size_t inside);

}  // namespace xorvox::tools
