// Solid voxelization by a simplicial covering (Rueda, Ogáyar, Segura, Feito: "Fast and Simple Hardware Accelerated
// Voxelizations Using Simplicial Coverings", sections 3 and 4).
//
// An apex, any point, makes a tetrahedron with every face. A sample is inside of the solid when an odd number of these
// tetrahedra cover it, so each of them flips the samples that it covers (XOR). Faces come in any order, one at a time,
// without topology. Each tetrahedron is scan-converted exactly on the snapping grid (voxelizer/snap.h), slice by slice
// along any axis, with the table of the paper's section 4 corrected (voxelizer/tetrahedron.h); ties are settled as if
// the sample stood at (x + ε, y + ε², z + ε³).
//
// On meshes that are closed mod 2 (every edge in an even number of faces, by snapped position) the bits are those of
// voxelize_solid(), for every apex and every sweep. On open meshes they depend on the apex: each hole adds the cone
// from the apex to it. Only the apex and not the sweep matters then.
//
// Regular lattices only: a slice is a plane of samples in straight rows, which table lattices do not have. They are
// answered with Unsupported; voxelize_solid() takes any lattice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "voxelizer/bit_volume.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"
#include "voxelizer/snap.h"
#include "voxelizer/status.h"

namespace xorvox {

enum class Axis : std::uint8_t { X, Y, Z };

struct SimplicialOptions {
    /// In the units of the lattice; rounded to the snapping grid. None: the centroid, the mean of the faces' corners on
    /// the snapping grid, each counted as often as faces have it (so that welding a mesh does not move it), rounded.
    /// The further the apex, the more samples the tetrahedra cover, and the longer it takes.
    std::optional<glm::dvec3> apex;
    /// The axis along which the slices follow each other; the paper's is y. Rows of slices run along x, or along y when
    /// the sweep is along x, which is slower: the samples of a row are then in different words.
    Axis sweep = Axis::Y;
};

/// What was beyond its range when a call answered OutOfRange.
enum class SimplicialFault : std::uint8_t {
    None,
    Lattice,  ///< It exceeds the limits of voxelizer/lattice.h.
    Vertex,   ///< A face uses a vertex that is not finite or beyond 2^30 units of the snapping grid.
    Apex,     ///< The apex is.
    Counter,  ///< A signed sum left the range of its 16 bits.
};

struct SimplicialReport {
    SimplicialFault fault = SimplicialFault::None;
    std::size_t bad_vertex = 0;    ///< After SimplicialFault::Vertex: the first such vertex.
    std::size_t bad_index = 0;     ///< After InvalidArgument by the mesh: see validate() in mesh.h.
    glm::ivec3 apex{0};            ///< After Ok: the apex on the snapping grid; of a mesh without faces (0, 0, 0).
    std::uint64_t tetrahedra = 0;  ///< After Ok: those that may cover samples: of some volume, and near the lattice.
    std::uint64_t covered = 0;     ///< After Ok: samples that they covered, each counted as often as it was.
};

/// Bytes of scratch memory that the functions below need for this mesh, valid or not: about 12 a vertex.
std::size_t simplicial_scratch_bytes(const MeshView& mesh);

/// Sets the bits of `out` to the samples of `lattice` that an odd number of tetrahedra cover.
///
/// @param mesh     polygons, in the units of the lattice; must be well formed (mesh.h). Polygons are the mod-2 fans of
///                 voxelizer/solid.h. A mesh of no faces gives a volume of zeros.
/// @param lattice  regular; must pass validate().
/// @param scratch  at least simplicial_scratch_bytes(mesh), aligned to 16 bytes. Borrowed for the call.
/// @param out      shape of the lattice. Overwritten, padding bits zero.
/// @param report   may be null.
///
/// Ok; InvalidArgument (lattice, shapes, alignment or indices wrong); Unsupported (a table lattice); OutOfRange (see
/// report->fault); OutOfMemory (scratch too small). `out` is untouched after a failure. No allocation, no exceptions;
/// calls on different outputs and scratch may run at the same time. Time: proportional to the rows of samples that the
/// tetrahedra cross.
Status voxelize_simplicial(const MeshView& mesh, const Lattice& lattice, const SimplicialOptions& options,
                           std::span<std::byte> scratch, BitVolumeView out, SimplicialReport* report = nullptr);

/// The same, one triangle at a time, for soups that are never in memory as a whole. One thread at a time.
class SimplicialCovering {
public:
    /// Clears `volume`, which has the shape of the regular `lattice` and is borrowed until the last add(). Must be
    /// called first, and may be called again. Ok, InvalidArgument, Unsupported (a table lattice), or OutOfRange (the
    /// lattice, or the apex: not finite, or beyond 2^30 units of the snapping grid); volume and covering are untouched
    /// after a failure.
    Status start(const Lattice& lattice, const glm::dvec3& apex, Axis sweep, BitVolumeView volume);

    /// The same with an apex on the snapping grid, snap_grid(lattice), each coordinate within kSnapLimit.
    Status start_snapped(const Lattice& lattice, const glm::ivec3& apex, Axis sweep, BitVolumeView volume);

    /// Flips the samples in the tetrahedron of the apex and this triangle, in either orientation. OutOfRange, and
    /// nothing flipped, when a corner is not finite or beyond 2^30 units of the snapping grid; else Ok. After the last
    /// triangle of the mesh the volume has the bits that voxelize_simplicial() gives.
    Status add(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

    /// The same for corners on the snapping grid, each coordinate within kSnapLimit.
    void add_snapped(const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c);

    /// As in SimplicialReport, since start().
    std::uint64_t tetrahedra() const { return tetrahedra_; }
    std::uint64_t covered() const { return covered_; }

private:
    SnapGrid grid_;
    glm::ivec3 apex_{0};
    Axis sweep_ = Axis::Y;
    BitVolumeView volume_;
    std::uint64_t tetrahedra_ = 0;
    std::uint64_t covered_ = 0;
};

/// The signed inclusion sum of every sample, the paper's first formula: each tetrahedron that covers a sample adds 1
/// when its face, seen from the side where the apex is not, runs counter-clockwise, and -1 when clockwise.
///
/// In a closed mesh whose faces all run counter-clockwise seen from outside, the sum is how often the solid contains
/// the sample: 0 outside, 1 inside, 2 where two solids overlap (and parity gives 0). -1: the surface there is inside
/// out. Where a face runs against its neighbours, all samples in its tetrahedron are off by 2, so that sums other than
/// 0 and 1 appear wherever the tetrahedron covers samples; another apex shows faces that this one sees edge-on.
/// Polygons: the rings of holes run against the outer ring. On orientable closed meshes the sums are the same for every
/// apex.
///
/// `sums` has lattice.sample_count() entries, sample (x, y, k) at (k·ny + y)·nx + x, and is overwritten; all else as
/// for voxelize_simplicial(). When a counter would leave its range on the way, which takes more than 32767 tetrahedra
/// over one sample, the answer is OutOfRange with SimplicialFault::Counter, and `sums` is all zeros.
Status sum_inclusions(const MeshView& mesh, const Lattice& lattice, const SimplicialOptions& options,
                      std::span<std::byte> scratch, std::span<std::int16_t> sums, SimplicialReport* report = nullptr);

/// Samples by their signed sum.
struct InclusionReport {
    std::size_t outside = 0;   ///< 0.
    std::size_t inside = 0;    ///< 1.
    std::size_t negative = 0;  ///< Below 0: inside out, or a fault of orientation.
    std::size_t multiple = 0;  ///< Above 1: overlapping solids, or a fault of orientation.
    std::int16_t lowest = 0;
    std::int16_t highest = 0;

    /// Whether every sample is plainly outside or inside: no fault of orientation and no overlap was seen.
    constexpr bool is_consistent() const { return negative == 0 && multiple == 0; }
};
InclusionReport inspect_inclusions(std::span<const std::int16_t> sums);

/// Sets the bits of `out` to the samples whose sum is above 0: the paper's test for inclusion. `sums` as from
/// sum_inclusions(), one entry for each sample of `out`. Ok or InvalidArgument (shapes that do not match), and `out` is
/// untouched then.
Status positive_inclusions(std::span<const std::int16_t> sums, BitVolumeView out);

}  // namespace xorvox
