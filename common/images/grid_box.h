// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>

#include "common/geometry/box_tree.h"
#include "tetwright/error.h"
#include "tetwright/label_source.h"

namespace tetwright {

/// Box of a volume, including the outer halves of its voxels, input units.
/// \param size voxels along each axis
/// \param origin centre of the first voxel
/// \param directions steps from one voxel to the next along each axis, as columns
Box3 box_of_voxels(const VoxelIndex& size, const Vec3& origin, const Eigen::Matrix3d& directions);
Box3 box_of(const LabelGrid& grid);

/// The error for a volume and something else whose boxes do not meet.
/// \param message what does not meet
/// \param first, second subjects of "reaches from", with their boxes
/// \param spaces what is known of their coordinate systems; may be empty
InputError boxes_apart(const std::string& file, const std::string& message, const std::string& first,
                       const Box3& first_box, const std::string& second, const Box3& second_box,
                       const std::string& spaces = {});

}  // namespace tetwright
