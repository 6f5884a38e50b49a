// SolidVoxelizer: the fast exact solid voxelizer. Its bits are those of voxelize_solid() (voxelizer/solid.h), for every
// kernel, number of threads, region and way of asking.
//
//   set_mesh        indices are checked once; positions may change later
//   set_lattice     sample points; tables are sorted once
//   solid           bits on the lattice, or on a region of it         nothing is allocated again where it was larger
//   before crossings       crossing lists slabs           a volume larger than memory, a few layers at a time
//
// Parity along columns, with the apex of the simplicial covering (Rueda, Ogáyar, Segura, Feito: "Fast and Simple
// Hardware Accelerated Voxelizations Using Simplicial Coverings", section 3) at infinity below. Vertices are snapped
// and packed; triangles that cover no column are dropped by their packed vertices; the others become events (column,
// first sample above), binned by layer; layer by layer the events of a bin flip bits of one running layer of parities,
// which stays in the cache and is copied to the volume. What is set up once serves any resolution and any part of the
// solid, as in section 5 of the paper: set_mesh() once, then set_lattice() and regions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>

#include <glm/vec3.hpp>

#include "voxelizer/bit_volume.h"
#include "voxelizer/crossings.h"
#include "voxelizer/kernels/kernel.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"
#include "voxelizer/region.h"
#include "voxelizer/solid.h"
#include "voxelizer/status.h"

namespace xorvox {

/// The most threads that a SolidVoxelizer works with.
inline constexpr unsigned kMaxSolidThreads = 256;

struct SolidOptions {
    Kernel kernel = best_kernel();
    unsigned threads = 1;  ///< 1 to kMaxSolidThreads, the caller's own included.
    /// Bytes for events, all threads together; each has at least 1 KiB for each layer, and 20 KiB. More events than fit
    /// are worked off in rounds, which costs time.
    std::size_t event_bytes = std::size_t{16} << 20;
    /// Asked between blocks of triangles and between groups of layers: after a stop request the call ends with
    /// Cancelled.
    std::stop_token stop;
    /// Told how much of the call is done, 0 to 1, never less than before; from the calling thread. May be empty.
    std::function<void(double)> progress;
};

/// Where the time of the last call went, in milliseconds of the calling thread.
struct SolidTimes {
    double snap_ms = 0;    ///< Snapping and packing vertices; 0 when positions and grid have not changed.
    double cross_ms = 0;   ///< Dropping triangles, finding crossings, binning them.
    double finish_ms = 0;  ///< From events to bits.
};

/// A source of triangle batches: fills its argument with the next batch, whose arrays must stay valid until the next
/// call; false when there are no more. Each batch is a mesh of its own, and all its positions are snapped, used or not:
/// give it only those that it needs.
using MeshBatches = std::function<bool(MeshView&)>;

/// Takes the layers z … z + volume.nz - 1; false stops.
using SlabSink = std::function<bool(ConstBitVolumeView volume, std::uint32_t z)>;

/// Hosted. One call at a time; different objects are independent; an object that was moved from may only be destroyed
/// or assigned to. Exceptions of the callers' functions pass through. Functions answer OutOfMemory when the heap is
/// exhausted, and the object is then as it was before, but for its caches. A failed call leaves `out` untouched, except
/// that after Cancelled, and after a failing later batch of a stream, `out` is incomplete: its contents are
/// unspecified.
class SolidVoxelizer {
public:
    /// Threads are started here. A kernel that this machine cannot run is replaced by best_kernel(); `threads` is
    /// clamped to its range. Throws std::system_error when threads cannot be started, std::bad_alloc as usual.
    explicit SolidVoxelizer(SolidOptions options = {});
    ~SolidVoxelizer();
    SolidVoxelizer(SolidVoxelizer&&) noexcept;
    SolidVoxelizer& operator=(SolidVoxelizer&&) noexcept;

    Kernel kernel() const;
    unsigned threads() const;

    /// Borrows the arrays of `mesh` until the next set_mesh() or the end of this object. Ok or InvalidArgument
    /// (report->bad_index: see validate() in mesh.h).
    Status set_mesh(const MeshView& mesh, SolidReport* report = nullptr);

    /// New positions for the same indices, as many as before; borrowed like set_mesh(). Also needed to announce that
    /// the borrowed positions have been changed in place. Ok or InvalidArgument (another number of positions).
    Status set_positions(std::span<const glm::dvec3> positions);

    /// The sample points of the calls that follow; its tables are copied. Ok, InvalidArgument, OutOfRange
    /// (validate() in lattice.h).
    Status set_lattice(const Lattice& lattice);

    /// Sets the bits of `out` to the samples that are inside of the mesh. `out` has the shape of the lattice, or of
    /// `region`; it is overwritten, padding bits zero. A region costs one pass over the vertices' packed columns and
    /// the triangles', the faces in its columns at or below its top, and its own volume; its bits are those of the same
    /// samples of the whole lattice.
    ///
    /// Ok; InvalidArgument (no lattice, shapes wrong, region not inside); OutOfRange (a face uses a vertex beyond the
    /// grid: report->bad_vertex); Cancelled.
    Status solid(BitVolumeView out, SolidReport* report = nullptr);
    Status solid(const Region& region, BitVolumeView out, SolidReport* report = nullptr);

    /// The same for a mesh that comes in batches and is never whole in memory; set_mesh() is not needed, and what it
    /// set stays. InvalidArgument also for a malformed batch (report->bad_index, report->bad_vertex count in its
    /// batch).
    Status solid(const MeshBatches& next, const Region& region, BitVolumeView out, SolidReport* report = nullptr);

    /// The crossing lists of a region. `lists` is overwritten and its memory reused; after OutOfMemory it may be empty.
    Status crossings(const Region& region, CrossingLists& lists, SolidReport* report = nullptr);

    /// The whole lattice from the lowest layer up, at most `layers` (at least 1) at a time in one buffer, so that the
    /// volume is never whole in memory. Each slab begins with the parities that the one below it ended with, so that
    /// the columns of faces below it are not looked at again; it costs a pass over all triangles. Cancelled also when
    /// `sink` answers false.
    Status slabs(std::uint32_t layers, const SlabSink& sink, SolidReport* report = nullptr);

    SolidTimes times() const;

    /// Bytes that this object will hold at most, everything but the mesh and the output, when it voxelizes a mesh of
    /// `vertices` positions on `lattice`: 16 a vertex, SolidOptions::event_bytes, for each thread a layer of the volume
    /// and some batches of triangles, and on table lattices an index of about 130 bytes a column, less for many
    /// columns. Polygons are free. CrossingLists are kept twice while they are made.
    std::size_t memory_bytes(std::size_t vertices, const Lattice& lattice) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace xorvox
