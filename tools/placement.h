// Where voxels go: the lattice that --size or --grid asks for, and a mesh scaled to stand inside a display.
#pragma once

#include "driver/display/description.h"
#include "tools/commands.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"

namespace xorvox::tools {

/// The lattice of `voxelize`: --grid with --origin and --pitch, or a cube of --size (64 if none is given) around the
/// mesh.
Expected<Lattice> place_grid(const GridOptions& options, const MeshView& mesh, const std::string& source);

/// Bytes that this process can still get without swapping; all of them where the system does not say.
std::uint64_t available_bytes();

/// Refuses work that needs more memory than this machine has free; `what` names it in the message.
Expected<void> check_memory(std::uint64_t bytes, const std::string& what);

/// Refuses a display that this machine has no memory for: frames in the host, the link and the device's pages, the
/// lattice and a volume.
Expected<void> check_display_fits(const DisplayDescription& display);

/// Scales the mesh uniformly and moves it so that it fills the display's extent, centred, its z axis up. One that
/// `turns` about the middle of the display stays within it.
Expected<void> fit_to_display(Mesh& mesh, const DisplayDescription& display, const std::string& source,
                              bool turns = false);

}  // namespace xorvox::tools
