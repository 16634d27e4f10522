// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "tetwright/tet_mesh.h"

namespace tetwright {

using TetCorners = std::array<Vec3, 4>;

/// A positive tet with the planes of its faces, computed once for all comparisons.
class PlanedTet {
 public:
  explicit PlanedTet(const TetCorners& corners);
  const TetCorners& corners() const { return corners_; }
  double volume() const { return volume_; }
  /// Signed distances from the planes of the four faces, each times twice the face's area: positive inside.
  Eigen::Array4d distances(const Vec3& p) const {
    return inward_[0] * p.x() + inward_[1] * p.y() + inward_[2] * p.z() - offset_;
  }

 private:
  TetCorners corners_;
  std::array<Eigen::Array4d, 3> inward_;  ///< normals by axis, so that the four faces are computed at once
  Eigen::Array4d offset_;                 ///< of the planes
  double volume_;
};

/// Volume of the intersection of two tets: one is cut by the planes of the other that cross it, piece by
/// piece (Sutherland & Hodgman 1974, in three dimensions). Rounding errors are about 1e-13 of the larger tet.
double overlap_volume(const PlanedTet& first, const PlanedTet& second);

}  // namespace tetwright
