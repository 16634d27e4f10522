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

/// True if two triangles of one mesh meet elsewhere than in the vertices and edges they share (equal ids):
/// without a shared vertex any common point counts, touching too; with one, the edge opposite it reaching the
/// other triangle; with two, lying in one plane on the same side of the shared edge; with three, always.
/// Exact for finite coordinates.
bool triangles_intersect(const MeshTriangle& f, const MeshTriangle& g);

}  // namespace tetwright
