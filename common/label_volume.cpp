// SPDX-License-Identifier: Apache-2.0
#include "tetwright/label_volume.h"

#include <cmath>

#include "common/number_text.h"
#include "common/tolerances.h"
#include "tetwright/error.h"

namespace tetwright {

Vec3 LabelGrid::to_input(const Vec3& index) const { return origin + directions * index; }

std::uint64_t LabelGrid::voxels() const {
  return static_cast<std::uint64_t>(size[0]) * static_cast<std::uint64_t>(size[1]) *
         static_cast<std::uint64_t>(size[2]);
}

void set_spacing(LabelGrid& grid, const Vec3& spacing) {
  const Vec3 before = grid.directions.colwise().norm();
  grid.spacing_replaced = !grid.spacing_assumed && before != spacing;
  grid.spacing_assumed = false;
  for (int axis = 0; axis < 3; ++axis) grid.directions.col(axis) *= spacing[axis] / before[axis];
}

void check_geometry(const LabelGrid& volume, const std::string& file) {
  const auto written = [](const Vec3& v) {
    std::string out;
    append_point(out, v);
    return "(" + out + ")";
  };
  if (!volume.origin.allFinite())
    throw InputError(file + ": the origin " + written(volume.origin) + " is not finite; repair the header");
  Eigen::Matrix3d units;
  for (int k = 0; k < 3; ++k) {
    const Vec3 step = volume.directions.col(k);
    const double length = step.norm();
    if (!std::isfinite(length) || !(length > 0))
      throw InputError(file + ": the step " + written(step) + " between voxels along axis " +
                       std::to_string(k) + " is zero or not finite; repair the spacing in the header");
    units.col(k) = step / length;
  }
  if (!(std::fabs(units.determinant()) > tolerance::coplanar_directions))
    throw InputError(file + ": the directions " + written(volume.directions.col(0)) + ", " +
                     written(volume.directions.col(1)) + " and " + written(volume.directions.col(2)) +
                     " of the axes lie in one plane; repair the header");
}

}  // namespace tetwright
