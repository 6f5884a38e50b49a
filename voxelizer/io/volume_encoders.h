// Volume encoders: the bytes of the volume formats that volume_file.h describes, plane by plane. Internal to io.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "voxelizer/bit_volume.h"
#include "voxelizer/error.h"
#include "voxelizer/io/volume_sink.h"
#include "voxelizer/lattice.h"

namespace xorvox::io {

/// Planes lie one after the other in the file: layers of equal z, or for binvox of equal x. Who calls sees to their
/// order and to the shapes.
class VolumeEncoder {
public:
    virtual ~VolumeEncoder() = default;
    /// Before the first plane.
    virtual Expected<void> begin(VolumeSink& sink) = 0;
    /// The plane at `index` in `slab`. The planes of a slab come in order, from 0 to its last.
    virtual Expected<void> add(VolumeSink& sink, ConstBitVolumeView slab, std::uint32_t index) = 0;
    /// After the last plane.
    virtual Expected<void> end(VolumeSink& sink) = 0;
};

/// Each of a regular lattice, which is copied.
std::unique_ptr<VolumeEncoder> nrrd_encoder(const Lattice& lattice, bool gzip);
std::unique_ptr<VolumeEncoder> bits_encoder(const Lattice& lattice);
std::unique_ptr<VolumeEncoder> binvox_encoder(const Lattice& lattice);
std::unique_ptr<VolumeEncoder> nifti_encoder(const Lattice& lattice);
std::unique_ptr<VolumeEncoder> vox_encoder(const Lattice& lattice);  ///< At most 256 a side.
std::unique_ptr<VolumeEncoder> png_encoder();                        ///< Each plane a write() of the sink.

/// Layer z of `slab` as one byte a voxel, 0 or 1; `bytes` is used again from layer to layer.
std::string_view layer_bytes(ConstBitVolumeView slab, std::uint32_t z, std::vector<char>& bytes);

}  // namespace xorvox::io
