// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// The tangent of half of 0.1 sr, as min_solid_angle_tangent() has it.
inline constexpr double tangent_of_bad_tet = 0.05004170837553879;

/// A point that is to be moved by `step`.
struct PointMove {
  /// Of moves that would spoil a tet half is tried, then a quarter, ...; then none.
  static constexpr std::uint8_t max_halvings = 4;

  Index point;
  Vec3 from, step;
  std::uint8_t halvings = 0;

  double share() const { return halvings > max_halvings ? 0.0 : std::ldexp(1, -halvings); }
};

/// Moves all points at once; moves at a tet that they spoil are shortened together, until none is spoilt:
/// tets keep the tangent given, and those that are worse already get no worse. The same result for any number
/// of threads.
void displace_with_backtracking(std::vector<Vec3>& points, const std::vector<Tet>& tets,
                                std::vector<PointMove>& moves, double min_tangent);

/// What is left of moves after displace_with_backtracking(): those that have arrived go, of the others the
/// rest is to be done.
void keep_remaining(const std::vector<Vec3>& points, std::vector<PointMove>& moves);

}  // namespace tetwright
