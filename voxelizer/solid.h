// Solid voxelization by parity along columns: a sample is inside when the number of faces below it is odd.
//
// Every face flips all samples of a column that lie above it (XOR; Rueda, Ogáyar, Segura, Feito: "Fast and Simple
// Hardware Accelerated Voxelizations Using Simplicial Coverings", section 3, with the apex at infinity below). Vertices
// are snapped once to the integer grid of voxelizer/snap.h; from there on everything is integer, so the result is the
// exact answer for the snapped mesh. Ties are settled as if the sample stood at (x + ε, y + ε², z + ε³).
//
// A polygon with all its rings is the mod-2 fan from its lexicographically smallest snapped vertex, so that the same
// polygon gives the same bits whatever its first vertex. Faces below the lattice count; faces beside or above do not.
// Closed meshes (every edge in an even number of faces, by snapped position) give the bits of every other method of
// xorvox; for open meshes this method, counted from below, is the reference.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "voxelizer/bit_volume.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"
#include "voxelizer/status.h"

namespace xorvox {

/// What voxelize_solid() found on the way.
struct SolidReport {
    std::size_t bad_vertex = 0;  ///< After OutOfRange: the first vertex beyond the grid or not finite; see below.
    std::size_t bad_index = 0;   ///< After InvalidArgument by the mesh: see validate() in mesh.h.
    std::size_t crossings = 0;   ///< After Ok: times that a face crossed a column at or below its top sample.
};

/// Bytes of scratch memory that voxelize_solid() needs for this mesh and lattice, valid or not: about 12 a vertex, and
/// on table lattices 20 a column and 4 a layer.
std::size_t solid_scratch_bytes(const MeshView& mesh, const Lattice& lattice);

/// Sets the bits of `out` to the samples of `lattice` that are inside `mesh`.
///
/// @param mesh     polygons, in the units of the lattice; must be well formed (mesh.h): indices below positions.size(),
///                 tables increasing. A mesh of no faces gives a volume of zeros.
/// @param lattice  sample points; must pass validate().
/// @param scratch  at least solid_scratch_bytes(mesh, lattice), aligned to 16 bytes. Borrowed for the call.
/// @param out      shape of the lattice. Overwritten, padding bits zero.
/// @param report   may be null.
///
/// Ok; InvalidArgument (lattice, shapes, alignment or indices wrong); OutOfRange (the lattice exceeds its limits, or a
/// face uses a vertex further from the lattice than 2^30 units of the snapping grid, or not finite:
/// report->bad_vertex); OutOfMemory (scratch too small). `out` is untouched after a failure. No allocation, no
/// exceptions; calls on different outputs and scratch may run at the same time.
Status voxelize_solid(const MeshView& mesh, const Lattice& lattice, std::span<std::byte> scratch, BitVolumeView out,
                      SolidReport* report = nullptr);

}  // namespace xorvox
