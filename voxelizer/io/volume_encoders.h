// Volume encoders: the bytes of the volume formats that volume_file.h describes, plane by plane. Internal to io.
#pragma once

#include <cstdint>
#include <memory>

#include "voxelizer/bit_volume.h"
#include "voxelizer/error.h"
#include "voxelizer/io/atomic_file.h"
#include "voxelizer/lattice.h"

namespace xorvox::io {

/// Planes lie one after the other in the file: layers of equal z, or for binvox of equal x. Who calls sees to their
/// order and to the shapes.
class VolumeEncoder {
public:
    virtual ~VolumeEncoder() = default;
    /// Before the first plane.
    virtual Expected<void> begin(AtomicFile& file) = 0;
    /// The plane at `index` in `slab`. The planes of a slab come in order, from 0 to its last.
    virtual Expected<void> add(AtomicFile& file, ConstBitVolumeView slab, std::uint32_t index) = 0;
    /// After the last plane.
    virtual Expected<void> end(AtomicFile& file) = 0;
};

/// Each of a regular lattice, which is copied.
std::unique_ptr<VolumeEncoder> nrrd_encoder(const Lattice& lattice);
std::unique_ptr<VolumeEncoder> bits_encoder(const Lattice& lattice);
std::unique_ptr<VolumeEncoder> binvox_encoder(const Lattice& lattice);

}  // namespace xorvox::io
