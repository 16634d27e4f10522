// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// How far the points of a mesh's boundary and interfaces are from a surface.
struct SurfaceDistances {
  std::string from;           ///< what the surface is, such as "the scan"
  std::vector<float> values;  ///< for each point, input units; not a number where it is on no interface
};

/// `mesh` has its interfaces; `surface` has triangles. Parallel; the result does not depend on the threads.
SurfaceDistances surface_distances(const TetMesh& mesh, const TriangleMesh& surface, std::string from);

}  // namespace tetwright
