// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "common/geometry/box_tree.h"
#include "tetwright/image_volume.h"
#include "tetwright/label_source.h"
#include "tetwright/label_volume.h"
#include "tetwright/prepare_steps.h"

namespace tetwright {

/// Images of ValueOptions, and their mask.
struct ValueInputs {
  std::vector<std::shared_ptr<const ImageVolume>> images;
  std::shared_ptr<const LabelVolume> mask;  ///< null: none
};

/// Reads the images and the mask. Called first, so that errors in these files end a run early.
///
/// \throws InputError in the cases of the readers, if an image has several channels, and if the mask is empty
ValueInputs read_value_inputs(PrepareRun& run);

/// Checks that the images meet the box of the input, that any of their voxels count, and that these have a
/// modulus, so that a run with an image elsewhere or an impossible modulus ends before it meshes.
///
/// \param materials tags of the materials that are meshed; empty: not known
/// \throws InputError if an image does not
/// \throws UsageError see check_modulus()
void check_images_meet(const ValueInputs& inputs, const Box3& box, const std::vector<MaterialTag>& materials,
                       const PrepareRun& run);

/// Box of a scan: its surfaces, or all voxels.
Box3 box_of_scan(const ScanInput& input);

/// Tags of the labels of a volume, not of bodies in it; empty for surfaces.
std::vector<MaterialTag> materials_of_scan(const ScanInput& input);

/// Keeps the labels of a segmented volume for ValueOptions::own_label.
std::shared_ptr<const LabelVolume> copy_labels(const LabelSource& source);

/// Adds the values as fields to the mesh of the result, divides it into bins, and reports both.
///
/// \throws InputError in the cases of image_values()
/// \throws UsageError if a bin's modulus is not above 0
void take_values(ValueInputs inputs, Prepared& result, PrepareRun& run);

}  // namespace tetwright
