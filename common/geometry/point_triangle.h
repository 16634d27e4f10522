// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/types.h"

namespace tetwright {

/// The point of a triangle that is nearest to `point` (Ericson 2005, section 5.1.5). A degenerate triangle
/// counts as the segment or point it is.
Vec3 closest_point(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

/// Squared distance of a point from a triangle, as for closest_point().
double squared_distance(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

/// The barycentric weights of a point of a triangle: none negative, their sum is 1 but for rounding. Those of
/// a degenerate triangle are on its longest edge.
std::array<double, 3> weights_in_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace tetwright
