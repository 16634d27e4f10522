// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The interfaces of a mesh, for display coarsened to at most `max_triangles` if there are more: by vertex
/// clustering (Rossignac & Borrel 1993) on the finest grid that leaves few enough. The point with the lowest
/// id represents its cell, so that ids stay those of the mesh.
std::vector<InterfaceTriangle> skin_within(const TetMesh& mesh, std::size_t max_triangles);

}  // namespace tetwright
