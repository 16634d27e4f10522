// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tetwright/image_values.h"
#include "tetwright/image_volume.h"
#include "tetwright/label_volume.h"
#include "tetwright/value_bins.h"

namespace tetwright {

/// An image whose values the tets and points get as fields.
struct ValueImage {
  std::string name;                                    ///< of the fields
  std::string file;                                    ///< path; name in messages of an image in memory
  std::shared_ptr<const ImageVolume> image = nullptr;  ///< null: read the file
};

/// Bins by the values of an image, see bin_tets().
struct ValueBins {
  std::string of;  ///< name of the image
  BinRule rule;
  /// Elastic modulus of each bin. At most one of all ValueBins has it, since a tet has one modulus.
  std::optional<ModulusLaw> modulus = {};
};

/// Values of images on the result, see image_values().
struct ValueOptions {
  std::vector<ValueImage> images;
  /// Further cell fields: NAME_min, NAME_max and NAME_deviation.
  bool minimum = false, maximum = false, deviation = false;
  /// Volume whose voxels other than 0 say which ones of the images count; empty: all.
  std::string mask_file;
  std::shared_ptr<const LabelVolume> mask = nullptr;  ///< null: read the file
  /// Only voxels with the label of a tet's material count. For a segmented volume.
  bool own_label = false;
  /// Divisions of the tets into bins, for different images.
  std::vector<ValueBins> bins;
};

/// Values of an image on the result.
struct ValueReport {
  std::string name, file;
  double lowest = 0, highest = 0;              ///< of the image's voxels
  double smallest = 0, largest = 0, mean = 0;  ///< of the tets; the mean is weighted by volume
  FoundPlaces partly_outside, nearest, nearest_points;
  std::size_t not_finite = 0;
};

/// The bins of the result; TetBins::of_tets is empty.
using BinsReport = TetBins;

}  // namespace tetwright
