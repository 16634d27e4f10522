// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/features/edge_uses.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// An edge shared by two triangles of a group.
struct InnerEdge {
  std::array<Index, 2> ends, triangles;
  double length;
  double turn;  ///< angle between the normals, radians, 0 to pi; 0 if a normal is undefined
};

/// Edges shared by two consistently oriented triangles of a group, ascending by their endpoints. A triangle
/// without area gets the normal of a neighbour.
/// \param uses edge_uses() of the triangles
std::vector<InnerEdge> inner_edges(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                   const std::vector<EdgeUse>& uses);

}  // namespace tetwright
