// Volume reader: volumes of other programs, strictly read, in the spirit of voxelizer/io/mesh_file.h: whole and as they
// were meant, or one line that says where, what was found, and what to do.
//
//   .binvox            https://www.patrickmin.com/binvox/binvox.html. Version 1: Binary. Version 2: Labels, the values.
//   .nrrd, .nhdr       NRRD 1 to 5, raw and gzip, data in the file or in one beside it; scalars of any type; Scalar;
//                      Labels or Binary where `content` or `kinds` say so; Colors of three or four channels of uint8
//   .vox               MagicaVoxel 150 and 200: Labels with the file's palette. Several models are put together where
//                      the file's scene places them apart; else they follow each other, as frames of an animation
//   .png               a stack: PATH names one picture of a numbered row (slice007.png stands for all of them), or
//                      a folder of such; Scalar where all are grey, else Colors
//   .nii, .nii.gz      NIfTI-1 and 2, one file; Scalar, Labels where the intent says so, Colors of RGB24 and RGBA32;
//                      the fourth dimension is time
//
// Where they stand, in mm: binvox as its translate and scale say. NRRD by `space directions` and `space origin`, turned
// to right-anterior-superior where `space` is another anatomical space; else by `spacings`, 1 where not told, the first
// voxel's centre at 0. NIfTI by its sform, else its qform, else its pixdim. A voxel of MagicaVoxel is 1 mm, and the
// outer corner of the first at 0. A picture's pixels are 1 mm, x to the right, y up; pictures follow each other
// along z, from below.
//
// Thread safety: all functions may run at the same time; nothing is shared.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/sampled_volume.h"

namespace xorvox::io {

/// The longest volume file that is read, and the longest that its data unpack to.
inline constexpr std::uint64_t kMaxVolumeFileBytes = std::uint64_t{1} << 34;

/// The most volumes of one file.
inline constexpr std::size_t kMaxVolumeFrames = 65536;

/// Whether read_volumes() would take `path` for a volume: by its name, or because it is a folder; a mesh file
/// otherwise.
bool is_volume_path(const std::string& path);

/// Reads the volume file, or stack of pictures, at `path`. No count in a header is believed, and no memory taken for
/// it, before the bytes can be there; values that are not finite are refused, with their voxel.
Expected<VolumeSequence> read_volumes(const std::string& path);

/// The parsers that read_volumes() uses, on bytes in memory. `source` is the name that errors begin with.
Expected<VolumeSequence> parse_binvox(std::string_view bytes, std::string_view source);
Expected<VolumeSequence> parse_vox(std::string_view bytes, std::string_view source);
/// Unpacks gzip by itself.
Expected<VolumeSequence> parse_nifti(std::string_view bytes, std::string_view source);

/// Gives the bytes of the data file that a NRRD header names. `name` is as the header has it: which files may be read
/// is decided here.
using DataFileReader = std::function<Expected<std::string>(const std::string& name)>;
/// `read_data_file` is asked once, when the header is detached; it may be empty, and such headers are then refused.
Expected<VolumeSequence> parse_nrrd(std::string_view bytes, std::string_view source,
                                    const DataFileReader& read_data_file = {});

/// Reads the stack of pictures at `path`: a folder, or one picture of a numbered row.
Expected<VolumeSequence> read_png_stack(const std::string& path);

}  // namespace xorvox::io
