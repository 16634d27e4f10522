// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "common/features/inner_edges.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// An edge that turns by more than the feature angle.
struct SharpEdge {
  std::array<Index, 2> ends;
  double length;  ///< unit of the surface
  double turn;    ///< angle between the normals, radians
  CreaseChain::Fate fate;
};

/// Edges with two consistently oriented triangles of different groups.
/// \param uses edge_uses() of the triangles
std::vector<InnerEdge> edges_between_groups(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                            const std::vector<EdgeUse>& uses);

/// Divides kept edges where they enter and leave the region in which they are given up.
/// \param points receives the points between
/// \param piece as for find_crease_chains()
void give_up_edges(std::vector<Vec3>& points, std::vector<SharpEdge>& edges, double piece,
                   const std::function<bool(const Vec3&)>& is_given_up);

/// Joins sharp edges to chains. O(points + edges); the result depends on the order of the edges only.
CreaseChains chains_of(std::span<const Vec3> points, const std::vector<SharpEdge>& edges);

}  // namespace tetwright
