// SPDX-License-Identifier: Apache-2.0
#include "common/images/grid_box.h"

#include "common/message_text.h"

namespace tetwright {

namespace {

std::string box_text(const Box3& box) { return place_text(box.low) + " to " + place_text(box.high); }

}  // namespace

Box3 box_of_voxels(const VoxelIndex& size, const Vec3& origin, const Eigen::Matrix3d& directions) {
  Box3 box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int a = 0; a < 3; ++a) index[a] = (corner >> a & 1) ? size[static_cast<std::size_t>(a)] - 0.5 : -0.5;
    box.add(origin + directions * index);
  }
  return box;
}

Box3 box_of(const LabelGrid& grid) { return box_of_voxels(grid.size, grid.origin, grid.directions); }

InputError boxes_apart(const std::string& file, const std::string& message, const std::string& first,
                       const Box3& first_box, const std::string& second, const Box3& second_box,
                       const std::string& spaces) {
  return {file, 0,
          message + ": " + first + " reaches from " + box_text(first_box) + ", " + second + " from " +
              box_text(second_box) + "; check origin, spacing, unit and coordinate system of both" +
              (spaces.empty() ? "" : ": " + spaces)};
}

}  // namespace tetwright
