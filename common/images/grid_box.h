// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/geometry/box_tree.h"
#include "tetwright/error.h"
#include "tetwright/label_volume.h"

namespace tetwright {

/// Box of a volume, with the outer halves of its voxels, input units.
Box3 box_of(const LabelGrid& grid);

/// The error for a volume and something else whose boxes do not meet.
/// \param message what does not meet
/// \param first, second subjects of "reaches from", with their boxes
InputError boxes_apart(const std::string& file, const std::string& message, const std::string& first,
                       const Box3& first_box, const std::string& second, const Box3& second_box);

}  // namespace tetwright
