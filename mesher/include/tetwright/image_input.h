// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tetwright/image_volume.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// A threshold of an image: its material has the values from there on, up to the next threshold.
struct IsoValue {
  std::string name;             ///< of the material
  std::optional<double> value;  ///< std::nullopt: chosen by Otsu's method
};

/// How an image is divided into materials.
struct ImageChoice {
  /// Thresholds of an image with one channel, one or more with different names; tags 1, 2, ... in this order.
  /// Empty: each channel has a material, which has the points where that channel is the largest.
  std::vector<IsoValue> isos;
  /// Names of the channels' materials, whose tags are 1, 2, ...
  std::vector<std::string> names;
  /// Points where no channel exceeds this value are outside. std::nullopt: channels are probabilities, and
  /// that of the outside is what they lack to 1.
  std::optional<double> outside;
  /// Standard deviation of a Gaussian kernel by which the image is smoothed, voxels; 0: not at all.
  /// Thresholds are moved, and channels get offsets, so that materials keep their numbers of voxels.
  double smoothing = 0;
  std::size_t min_voxels = 8;  ///< as LabelChoice::min_voxels
};

/// A threshold that was used.
struct UsedIso {
  std::string name;
  double value = 0;  ///< before smoothing
  bool automatic = false;
};

/// Divides an image into materials. Interfaces are where the image, interpolated trilinearly between voxel
/// centres, has the thresholds, or where two channels are equal. Islands of voxels are merged as for labels,
/// and the rest of the result is that of make_label_input().
///
/// \param file file name for messages
/// \param used receives the thresholds, in the order of `choice`; may be null
/// \param progress may be null
/// \throws UsageError for two equal thresholds or names, thresholds for several channels, a material called
///   "outside" and options out of range
/// \throws InputError for thresholds that do not divide the image, with its range, and for channels that are
///   no probabilities
/// \throws NothingToMeshError if nothing is inside
/// \throws OutputError if memory does not suffice
/// \throws Interrupted
LabelInput make_image_input(ImageVolume image, const std::string& file, const ImageChoice& choice,
                            std::vector<UsedIso>* used, Progress* progress);

/// Otsu's threshold (1979): the one that makes the variance between the values below and above largest, in
/// the middle of the range of thresholds that do. From a histogram of 4096 bins between the smallest and the
/// largest value.
/// \pre `values` has two different finite values
double otsu_threshold(const std::vector<float>& values);

}  // namespace tetwright
