// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// All pairs of triangles that meet outside the vertices and edges they share, by the rules of
/// triangle_intersection.h. Pairs are in ascending order, the smaller index first. O(n log n + pairs of
/// overlapping boxes), parallel; the result does not depend on the number of threads.
/// \pre ids below the number of points, coordinates finite
std::vector<std::pair<Index, Index>> self_intersections(std::span<const Vec3> points,
                                                        std::span<const Triangle> triangles);

}  // namespace tetwright
