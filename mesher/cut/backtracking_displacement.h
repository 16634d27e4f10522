// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "mesher/tuning/cut_tuning.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A displacement of a point by `step`.
struct PointMove {
  Index point;
  Vec3 from, step;
  std::uint8_t halvings = 0;

  double share() const {
    return halvings > CutTuning::Displacement::max_halvings ? 0.0 : std::ldexp(1, -halvings);
  }
};

/// Moves all points at once. If the moves spoil a tet, all moves of its vertices are shortened together until
/// it is no longer spoilt. A tet is spoilt if its tangent falls below `min_tangent`, or below its previous
/// value if that was smaller. The result does not depend on the number of threads.
/// \param min_tangent as min_solid_angle_tangent()
void displace_with_backtracking(std::vector<Vec3>& points, const std::vector<Tet>& tets,
                                std::vector<PointMove>& moves, double min_tangent);

/// Removes the moves that displace_with_backtracking() has completed; the others keep their remaining step,
/// from the current position of their point.
void keep_remaining(const std::vector<Vec3>& points, std::vector<PointMove>& moves);

}  // namespace tetwright
