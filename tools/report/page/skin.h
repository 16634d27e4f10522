// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/tet_mesh.h"

namespace tetwright {

/// The interfaces of a mesh with no more than `max_triangles` of them: as they are, or coarsened for the eye
/// alone by joining the points of each cell of a grid (Rossignac & Borrel 1993), the finest that leaves few
/// enough. A joined point is the one of the smallest number, so that ids stay those of the mesh.
std::vector<InterfaceTriangle> skin_within(const TetMesh& mesh, std::size_t max_triangles);

}  // namespace tetwright
