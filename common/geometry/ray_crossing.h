// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/types.h"

namespace tetwright {

/// How a vertical line (parallel to z) through a point meets a triangle, decided exactly.
///
/// Lines through edges and vertices are decided as if the line stood at (x + e, y + e^2) for an infinitely
/// small e > 0 (simulation of simplicity, Edelsbrunner & Muecke 1990): every line meets the triangles around
/// an edge or vertex in a consistent way, so the crossings of a closed surface always cancel.

/// 1 if the line at `point` enters the solid where it meets the triangle going up (the normal points down),
/// -1 if it leaves, 0 if it misses the triangle. The z of `point` does not matter.
int vertical_crossing(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point);

/// True if `point`, on a line that meets the triangle with `crossing` 1 or -1, is on the triangle or above
/// it.
bool at_or_above(const Vec3& a, const Vec3& b, const Vec3& c, int crossing, const Vec3& point);

}  // namespace tetwright
