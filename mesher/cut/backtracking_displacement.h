// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// min_solid_angle_tangent() of a solid angle of 0.1 sr: the tangent of half the angle.
inline constexpr double tangent_of_bad_tet = 0.05004170837553879;

/// A displacement of a point by `step`.
struct PointMove {
  /// A move that would spoil a tet is halved up to this many times, then dropped.
  static constexpr std::uint8_t max_halvings = 4;

  Index point;
  Vec3 from, step;
  std::uint8_t halvings = 0;

  double share() const { return halvings > max_halvings ? 0.0 : std::ldexp(1, -halvings); }
};

/// Moves all points at once. Moves at a tet that they spoil are shortened together until no tet is spoilt:
/// each keeps a tangent of `min_tangent`, or its own if that was smaller. The result does not depend on the
/// number of threads.
/// \param min_tangent as min_solid_angle_tangent()
void displace_with_backtracking(std::vector<Vec3>& points, const std::vector<Tet>& tets,
                                std::vector<PointMove>& moves, double min_tangent);

/// Removes the moves that displace_with_backtracking() has completed; the others keep their remaining step,
/// from the current position of their point.
void keep_remaining(const std::vector<Vec3>& points, std::vector<PointMove>& moves);

}  // namespace tetwright
