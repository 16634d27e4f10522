// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/ray_crossing.h"

#include "common/geometry/predicates.h"

namespace tetwright {

namespace {

/// Side of the line a -> b (in xy) on which the shifted point lies; 0 only if a and b coincide.
int shifted_side(const Vec3& a, const Vec3& b, const Vec3& point) {
  if (const int side = orient2d(a, b, point, 0, 1)) return side;
  // Derivative of the orientation along the shift (e, e^2): -dy e + dx e^2.
  if (b.y() != a.y()) return b.y() > a.y() ? -1 : 1;
  if (b.x() != a.x()) return b.x() > a.x() ? 1 : -1;
  return 0;
}

}  // namespace

int vertical_crossing(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point) {
  const int side = shifted_side(a, b, point);
  if (side == 0 || shifted_side(b, c, point) != side || shifted_side(c, a, point) != side) return 0;
  return -side;  // counter-clockwise from above: the normal points up, the line leaves the solid
}

bool at_or_above(const Vec3& a, const Vec3& b, const Vec3& c, int crossing, const Vec3& point) {
  return crossing * orient3d(a, b, c, point) <= 0;
}

}  // namespace tetwright
