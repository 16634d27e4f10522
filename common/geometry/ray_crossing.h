// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Exact crossings of a triangle with the vertical line (parallel to z) through a point.
///
/// Lines through edges and vertices are decided as if shifted to (x + e, y + e^2) for an infinitely small e >
/// 0 (simulation of simplicity, Edelsbrunner & Muecke 1990). Every line then meets the triangles around an
/// edge or vertex consistently, and the crossings of a closed surface always cancel.

/// Crossing of the upward line through `point`, whose z is ignored.
/// \return 1 if the line enters the solid (the normal points down), -1 if it leaves, 0 if it misses the
///   triangle
int vertical_crossing(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point);

/// Whether `point` is on or above the triangle.
/// \pre its vertical line meets the triangle with `crossing` 1 or -1
bool at_or_above(const Vec3& a, const Vec3& b, const Vec3& c, int crossing, const Vec3& point);

}  // namespace tetwright
