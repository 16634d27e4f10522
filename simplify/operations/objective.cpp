// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/objective.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/predicates.h"
#include "common/tolerances.h"

namespace tetwright {

double Objective::precise_signed_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
  const double value = unsigned_value(a, b, c, d);
  if (value > 0) return value;
  const double longest2 = std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (d - a).squaredNorm(),
                                    (c - b).squaredNorm(), (d - b).squaredNorm(), (d - c).squaredNorm()});
  return std::min(
      0.0, orient3d_value(a, b, c, d) / (longest2 * std::sqrt(longest2)) - tolerance::inverted_quality);
}

double Objective::sized_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
  TetQuality local = quality;
  local.ideal_edge = sizes->target_length((a + b + c + d) / 4) / edge_to_ideal;
  local.ideal_volume = local.ideal_edge * local.ideal_edge * local.ideal_edge;
  return local.cubed(a, b, c, d);
}

}  // namespace tetwright
