// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Rounded value of six times the signed volume of the tet (a, b, c, d): (b-a) x (c-a) . (d-a). Positive for
/// a positive tet.
inline double orient3d_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double bx = b.x() - a.x(), by = b.y() - a.y(), bz = b.z() - a.z();
  const double cx = c.x() - a.x(), cy = c.y() - a.y(), cz = c.z() - a.z();
  const double dx = d.x() - a.x(), dy = d.y() - a.y(), dz = d.z() - a.z();
  return bx * (cy * dz - cz * dy) + by * (cz * dx - cx * dz) + bz * (cx * dy - cy * dx);
}

/// Sign (-1, 0, 1) of the exact orient3d, for finite coordinates. A floating-point filter decides nearly all
/// cases, exact expansion arithmetic (Shewchuk 1997) the others. Exact unless a product of three coordinate
/// differences underflows, which needs coordinates more than 2^300 apart in size within one tet.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Sign (-1, 0, 1) of the exact (b-a) x (c-a) in the plane of the coordinates `u` and `v`, each 0 to 2.
int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);

}  // namespace tetwright
