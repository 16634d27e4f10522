// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A triangle of a mesh with the positions of its vertices.
struct MeshTriangle {
  Triangle ids;
  std::array<Vec3, 3> points;
};

/// Whether two triangles of one mesh meet outside the vertices and edges they share (equal ids). Exact for
/// finite coordinates. With
/// - no shared vertex, any common point counts, touching included;
/// - one, they meet if the edge opposite it in one triangle reaches the other triangle;
/// - two, they meet if they are coplanar and on the same side of the shared edge;
/// - three, they always meet.
bool triangles_intersect(const MeshTriangle& f, const MeshTriangle& g);

}  // namespace tetwright
