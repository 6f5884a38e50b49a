// Volume files: a BitVolume on a regular lattice, written for other programs.
//
// Equal bits on equal lattices give equal files: no date, name, method or machine is in them. All numbers are
// little-endian. World coordinates are those of the lattice.
//
//   .nrrd    NRRD0004 with attached header; https://teem.sourceforge.net/nrrd/format.html. type uint8, 0 or 1 a voxel,
//   raw,
//            x fastest; `space origin` is the centre of voxel (0, 0, 0), `space directions` the pitches.
//
//   .binvox  version 1; https://www.patrickmin.com/binvox/binvox.html. Runs of (value, length 1 to 255), y fastest,
//   then z,
//            then x. The format knows cubes of cubic voxels only: lattices of unequal pitch are refused, and a box with
//            unequal sides is filled up to a cube with clear voxels beyond its far ends. With n voxels a side, voxel
//            (i, j, k) stands at translate + scale · (i + ½, j + ½, k + ½) / n.
//
//   .bits    our own: the words of the volume as they are in memory (voxelizer/bit_volume.h).
//
//                byte 0        8        12  16  20  24           48          72
//                     XVBITS\r\n   1     nx  ny  nz  origin x y z  pitch x y z  words …
//                     magic     version  u32 × 3     f64 × 3       f64 × 3      u64 × ⌈nx/64⌉·ny·nz
//
//            The magic ends in \r\n, which transfers that mangle line ends destroy.
#pragma once

#include <string>

#include "voxelizer/bit_volume.h"
#include "voxelizer/error.h"
#include "voxelizer/lattice.h"

namespace xorvox::io {

/// Whether write_volume() knows the extension of `path` (.nrrd, .binvox or .bits, in either case) and the file has a
/// name before it; an error that says so if not. Lets a program refuse before it computes.
Expected<void> check_volume_path(const std::string& path);

/// Writes `volume` to `path` in the format of its extension, whole or not at all (voxelizer/io/atomic_file.h says what
/// paths may be written to). `lattice` must be regular, pass validate() and have the shape of `volume`. Errors: these
/// broken, an extension that check_volume_path() refuses, a lattice that .binvox cannot tell, everything the file
/// system says. Different files may be written by different threads.
Expected<void> write_volume(const std::string& path, ConstBitVolumeView volume, const Lattice& lattice);

}  // namespace xorvox::io
