// Where voxels go: the lattice that --size or --grid asks for, and a model scaled to stand inside a display.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "tools/commands.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"

namespace xorvox::tools {

/// The lattice of `voxelize`: --grid with --origin and --pitch, or a cube of --size (64 if none is given) around the
/// mesh.
Expected<Lattice> place_grid(const GridOptions& options, const MeshView& mesh, const std::string& source);

/// Refuses work that needs more memory than this machine has free; `what` names it in the message.
Expected<void> check_memory(std::uint64_t bytes, const std::string& what);

/// Refuses a display that this machine has no memory for: frames in the host, the link and the device's pages, the
/// lattice and a volume.
Expected<void> check_display_fits(const DisplayDescription& display);

/// How something turns about the middle of the display.
enum class Turning : std::uint8_t { Not, Upright, Anyhow };

/// From a file's units to a display's millimetres: a uniform scale and a move.
struct Placement {
    glm::dvec3 center{0.0};  ///< In the file's units; it comes to `middle`.
    double scale = 1.0;
    glm::dvec3 middle{0.0};

    glm::dvec3 place(const glm::dvec3& point) const { return (point - center) * scale + middle; }
    glm::dmat4 matrix() const;
};

/// Shows points to its argument, some at a time.
using PointSource = std::function<void(const std::function<void(std::span<const glm::dvec3>)>&)>;

/// The placement of what has its outermost points among `points`, which are asked for twice, so that it fills the
/// display's extent, centred, its z axis up, and stays within it however it turns.
Expected<Placement> fit_to_display(const PointSource& points, const DisplayDescription& display,
                                   const std::string& source, Turning turning = Turning::Not);

}  // namespace xorvox::tools
