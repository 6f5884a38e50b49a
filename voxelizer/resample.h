// Resampling: which samples of a lattice are inside a volume of another program.
//
// A sample is taken to the volume's own voxels by an affine map. Beyond the volume's box nothing is inside. Within it,
// Binary, Labels and Colors count by their nearest voxel (not 0, not wholly transparent), Scalar by the value between
// the eight voxels around the sample (Rueda et al., section 3, have textures so): inside where it is at least the
// threshold. Only + - × ÷ in double, always in the same order: the same bits on every machine, by any number of
// threads.
#pragma once

#include <cstddef>
#include <span>
#include <stop_token>

#include <glm/mat4x4.hpp>

#include "voxelizer/bit_volume.h"
#include "voxelizer/lattice.h"
#include "voxelizer/sampled_volume.h"
#include "voxelizer/status.h"

namespace xorvox {

/// Rows of a BitVolume: number y + ny·z of `first` and those after it, `count` of them.
struct RowRange {
    std::size_t first = 0;
    std::size_t count = 0;
};

/// Sets the bits of `rows` of `out`, all of them, other rows not touched. `to_volume` takes a place of the lattice to
/// voxels, (i, j, k) being the centre of voxel (i, j, k); `threshold` is that of Scalar. `out` has the shape of
/// `lattice`, which passes validate(). Allocates nothing; different rows may be made by different threads.
/// InvalidArgument: shapes or tables that do not fit each other, rows that are not there.
Status resample_rows(const SampledVolume& volume, double threshold, const glm::dmat4& to_volume, const Lattice& lattice,
                     RowRange rows, BitVolumeView out);

/// resample_rows() of all rows, shared by `threads` threads. Hosted. Throws what std::jthread throws. Cancelled: `stop`
/// was requested, and some rows are not made.
Status resample(const SampledVolume& volume, double threshold, const glm::dmat4& to_volume, const Lattice& lattice,
                BitVolumeView out, unsigned threads = 1, const std::stop_token& stop = {});

/// The threshold that parts all values of `frames` into two groups, each as uniform as can be: Otsu (1979), A threshold
/// selection method from gray-level histograms, over 256 steps from the least to the most value. What is at least the
/// threshold is the upper group. The least value itself when all are equal or there are none (0).
double otsu_threshold(std::span<const std::span<const float>> frames);

}  // namespace xorvox
