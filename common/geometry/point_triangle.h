// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Nearest point of a triangle (Ericson 2005, section 5.1.5). A degenerate triangle is treated as a segment
/// or a point.
Vec3 closest_point(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

/// Squared distance of a point from a triangle, as for closest_point().
double squared_distance(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

/// Barycentric weights of a point in a triangle: nonnegative, with sum 1 up to rounding. In a degenerate
/// triangle the weights refer to its longest edge.
std::array<double, 3> weights_in_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace tetwright
