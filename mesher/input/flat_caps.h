// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A connected set of free edges.
struct HoleRim {
  std::vector<std::array<Index, 2>> edges;  ///< as the cap passes them: against the surface's triangles
  std::vector<Index> at_triangle;           ///< the surface's triangle at each edge
  bool balanced = true;                     ///< as many edges end at each point as start there
  Vec3 vector = Vec3::Zero();               ///< area times normal of whatever closes it
  Vec3 centre = Vec3::Zero();
  Eigen::AlignedBox3d box;
};

struct FlatCap {
  std::vector<Triangle> triangles;  ///< by the points of the surface
  std::vector<std::size_t> rims;
  Vec3 vector = Vec3::Zero();  ///< area times normal
  bool kept = true;
};

/// Area times normal.
Vec3 area_vector(const std::vector<Vec3>& points, const Triangle& triangle);

/// The connected sets of edges with one triangle, in the order of their edges.
/// \param triangles oriented consistently
std::vector<HoleRim> find_rims(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles);

/// The caps of flat rims, see close_flat_holes(). A *cap* is a part of a plane around which the rims in that
/// plane go once.
/// \param rims find_rims() of the triangles
/// \param component of each triangle; caps are compared with the area of the components that they close
/// \param of_body all rims are those of a body, so that caps of any size and distance from the surface are
///   kept
/// \return also those that are not kept
std::vector<FlatCap> find_flat_caps(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                    const std::vector<HoleRim>& rims, const std::vector<Index>& component,
                                    bool of_body = false);

}  // namespace tetwright
