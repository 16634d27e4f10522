// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/images/material_image.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Convolves an image with a Gaussian kernel, whose weights add up to 1 also at the border of the volume.
/// Parallel; the result does not depend on the number of threads.
/// \param values the first axis fastest
/// \param deviation standard deviation, voxels along each axis, above 0
/// \param progress may be null
/// \throws Interrupted
void smooth_image(const VoxelIndex& size, double deviation, std::vector<float>& values,
                  const Progress* progress);

/// The thresholds for which a smoothed image has as many values above as the image had.
/// \param before, after values of the image
/// \param thresholds of the image, ascending
std::vector<double> volume_keeping_thresholds(std::vector<float> before, const std::vector<float>& after,
                                              const std::vector<double>& thresholds);

/// Sets the offsets of channels for which each is the largest in as many voxels as before smoothing, within a
/// thousandth. Takes some rounds, which go over all channels one after the other.
/// \param sizes of the bands before smoothing
/// \param progress may be null
/// \throws Interrupted
void keep_volumes(MaterialImage& image, const std::vector<BandSize>& sizes, const Progress* progress);

}  // namespace tetwright
