// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/types.h"

namespace tetwright {

/// A triangle of a mesh with the positions of its vertices.
struct MeshTriangle {
  Triangle ids;
  std::array<Vec3, 3> points;
};

/// Whether two triangles of one mesh meet elsewhere than in the vertices and edges they share (equal ids).
/// Exact for finite coordinates.
/// - no shared vertex: any common point counts, touching too;
/// - one: the edge opposite it reaches the other triangle;
/// - two: they are coplanar and on the same side of the shared edge;
/// - three: always.
bool triangles_intersect(const MeshTriangle& f, const MeshTriangle& g);

}  // namespace tetwright
