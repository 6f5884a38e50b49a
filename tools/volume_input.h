// The volume of a command: read, its threshold chosen, placed in a display.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "tools/commands.h"
#include "voxelizer/lattice.h"
#include "voxelizer/sampled_volume.h"
#include "voxelizer/transfer_function.h"

namespace xorvox::tools {

/// The least and the most value of a volume.
struct ValueRange {
    double least = 0.0;
    double most = 0.0;
};

/// Volumes, and what the options make of them: one threshold and one transfer function for all frames, since what does
/// not change must not flicker.
struct VolumeInput {
    VolumeSequence sequence;
    double threshold = 0.0;                    ///< Of Scalar: what is inside is at least so much.
    bool threshold_found = false;              ///< By Otsu's method, in all frames: nobody gave one.
    std::optional<TransferFunction> transfer;  ///< Of Scalar: the one asked for, or from threshold to most value.
};

/// Reads the volumes at `paths`, at least one, one after the other. With options.frame only that one is left of each
/// file. Errors: everything read_volumes() says; options that are not for volumes of this kind; a frame that is not
/// there.
Expected<VolumeInput> read_volume_input(std::span<const std::string> paths, const VolumeOptions& options);

/// "threshold 102.5, found by Otsu's method; --threshold sets another"; empty when there is nothing to say.
std::string describe_threshold(const VolumeInput& input);

/// "binary", "scalar", "labels" or "colors".
const char* kind_name(VolumeKind kind);

/// Over all frames of Scalar.
ValueRange value_range(const VolumeSequence& sequence);

/// The corners of the boxes around all voxels of all of `frames`, in mm: points for fit_to_display() and bounds.
std::vector<glm::dvec3> box_corners(std::span<const SampledVolume> frames);

/// Takes a place in the display's mm to voxels of `volume`, as resample() has it, when `placed` takes the file's mm to
/// the display's: Placement::matrix(), and a pose after it.
glm::dmat4 display_to_volume(const SampledVolume& volume, const glm::dmat4& placed);

}  // namespace xorvox::tools
