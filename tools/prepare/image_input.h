// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tetwright/image_input.h"
#include "tetwright/prepare_steps.h"

namespace tetwright {

/// Whether volumes are images to be divided into materials: if an option of images is given, or if the first
/// of several volumes, or a volume in memory with several channels, has values that are not whole numbers,
/// like probability maps. \throws InputError in the cases of read_image()
bool are_images(std::vector<Input>& volumes, PrepareRun& run);

/// Whether volumes that cannot be read as labels or masks are images: several, or one of several channels,
/// with values that are not whole numbers. Reads them again.
bool are_images_after_all(const std::vector<Input>& volumes, const LabelOptions& labels);

/// Reads images and divides them into materials. Adds thresholds and notes to the report.
/// \pre are_images()
/// \throws UsageError for thresholds or names that do not fit the images
/// \throws Error in the cases of read_image(), CommonGrid and make_image_input()
LabelInput read_images(std::vector<Input>& volumes, PrepareRun& run);

}  // namespace tetwright
