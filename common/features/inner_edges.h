// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/features/edge_uses.h"
#include "common/types.h"

namespace tetwright {

/// An edge between two triangles of a group.
struct InnerEdge {
  std::array<Index, 2> ends, triangles;
  double length;
  double turn;  ///< radians, 0 to pi; 0 where a triangle has no area
};

/// The edges in which two triangles of a group meet that are wound alike, ascending by their ends. `uses` are
/// the edge_uses() of the triangles. Triangles without area turn as what is beside them does.
std::vector<InnerEdge> inner_edges(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                   const std::vector<EdgeUse>& uses);

}  // namespace tetwright
