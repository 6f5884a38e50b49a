// Volume reader: volumes of other programs, strictly read, in the spirit of voxelizer/io/mesh_file.h: whole and as they
// were meant, or one line that says where, what was found, and what to do.
//
//   .binvox            version 1 and 2; Binary
//   .nrrd, .nhdr       NRRD 1 to 5, raw and gzip; scalars of any type; Scalar, or Colors of three or four channels of
//                      uint8
//   .vox               MagicaVoxel 150 and 200: Labels with the file's palette; several models that follow each other
//                      are the frames of an animation
//   .png               a stack: PATH names one picture of a numbered row (slice007.png stands for slice000.png on), or
//                      a folder of such; Scalar where all are grey, else Colors
//   .nii, .nii.gz      NIfTI-1 and 2, one file; Scalar, or Labels where the header says so
#pragma once

#include <string>

#include "voxelizer/error.h"
#include "voxelizer/sampled_volume.h"

namespace xorvox::io {

/// Whether read_volumes() would take `path` for a volume, by its name; a mesh file otherwise.
bool is_volume_path(const std::string& path);

/// Reads the volume file, or stack of pictures, at `path`. No count in a header is believed, and no memory taken for
/// it, before the bytes can be there; values that are not finite are refused, with their voxel.
Expected<VolumeSequence> read_volumes(const std::string& path);

}  // namespace xorvox::io
