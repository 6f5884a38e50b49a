// Volume files: a BitVolume on a regular lattice, written for other programs.
//
// Equal bits on equal lattices give equal files: no date, name, method or machine is in them. All numbers are
// little-endian. World coordinates are those of the lattice.
//
//   .nrrd    NRRD0004 with attached header; https://teem.sourceforge.net/nrrd/format.html. type uint8, 0 or 1 a
//            voxel, raw or gzip, x fastest; `space origin` is the centre of voxel (0, 0, 0), `space directions` the
//            pitches.
//
//   .binvox  version 1; https://www.patrickmin.com/binvox/binvox.html. Runs of (value, length 1 to 255), y fastest,
//            then z, then x. The format knows cubes of cubic voxels only: lattices of unequal pitch are refused, and a
//            box with unequal sides is filled up to a cube with clear voxels beyond its far ends. With n voxels a side,
//            voxel (i, j, k) stands at translate + scale · (i + ½, j + ½, k + ½) / n.
//
//   .nii     NIfTI-1; https://nifti.nimh.nih.gov. uint8, 0 or 1 a voxel, x fastest; the place is in its sform and
//            qform, in single precision. .nii.gz is the same, packed.
//
//   .vox     MagicaVoxel 150; https://github.com/ephtracy/voxel-model. One model, at most 256 voxels a side, all white.
//            Pitches must be equal; neither they nor the place are in the file.
//
//   .png     a stack: out/slice.png stands for out/slice000.png, out/slice001.png and so on, one picture a layer, the
//            lowest first, one bit a pixel, y up. Neither pitch nor place are in it. The pictures are written to a
//            folder beside, .xorvox-XXXXXX, and appear at the end, one after the other, when all of them are whole.
//
//   .bits    our own: the words of the volume as they are in memory (voxelizer/bit_volume.h).
//
//                byte 0        8        12  16  20  24           48          72
//                     XVBITS\r\n   1     nx  ny  nz  origin x y z  pitch x y z  words …
//                     magic     version  u32 × 3     f64 × 3       f64 × 3      u64 × ⌈nx/64⌉·ny·nz
//
//            The magic ends in \r\n, which transfers that mangle line ends destroy.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "voxelizer/bit_volume.h"
#include "voxelizer/error.h"
#include "voxelizer/lattice.h"

namespace xorvox::io {

struct VolumeWriteOptions {
    bool gzip = false;  ///< Of .nrrd: packed.
};

/// Whether write_volume() knows the extension of `path` (.nrrd, .binvox, .nii, .nii.gz, .vox, .png or .bits, in either
/// case), the options are for it, and the file has a name before it; an error that says so if not. Lets a program
/// refuse before it computes.
Expected<void> check_volume_path(const std::string& path, const VolumeWriteOptions& options = {});

/// The axis along which the slabs of a volume lie in its file.
enum class SlabAxis : std::uint8_t { X, Z };

/// Writes a volume slab by slab, so that it is never whole in memory. The file is the one that write_volume() writes,
/// and like that one appears whole, on commit(), or not at all. One thread at a time; different objects are
/// independent.
class VolumeWriter {
public:
    /// Begins the file of a volume on `lattice`, which must be regular, pass validate() and be one that the format can
    /// tell; errors: these broken, an extension that check_volume_path() refuses, everything the file system says
    /// (voxelizer/io/atomic_file.h says what paths may be written to). After a stop request write() fails. `progress`,
    /// which may be empty, is told how many of the file's planes are written, as a part from 0 to 1; by write(), after
    /// each plane.
    static Expected<VolumeWriter> create(const std::string& path, const Lattice& lattice, std::stop_token stop = {},
                                         std::function<void(double)> progress = {},
                                         const VolumeWriteOptions& options = {});

    VolumeWriter(VolumeWriter&&) noexcept;
    VolumeWriter& operator=(VolumeWriter&&) noexcept;
    ~VolumeWriter();

    /// .binvox lies in slabs of planes along x, all others in slabs of layers along z.
    SlabAxis slab_axis() const;

    /// Adds a slab: the next planes along slab_axis(), the first of which is number `first` of the volume, as wide as
    /// the lattice along the other axes. Refused when it does not follow the slab before it. After an error, destroy
    /// the object.
    Expected<void> write(ConstBitVolumeView slab, std::uint32_t first);

    /// Gives the file its name. Call once, after the last slab: a file that lacks planes is refused.
    Expected<void> commit();

private:
    struct State;
    explicit VolumeWriter(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// Writes `volume` to `path` in the format of its extension, whole or not at all: VolumeWriter with one slab, and its
/// errors. `volume` must have the shape of `lattice`.
Expected<void> write_volume(const std::string& path, ConstBitVolumeView volume, const Lattice& lattice,
                            std::stop_token stop = {}, const VolumeWriteOptions& options = {});

}  // namespace xorvox::io
