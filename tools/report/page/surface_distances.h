// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Distances of the points of a mesh's boundary and interfaces from a surface.
struct SurfaceDistances {
  std::string from;           ///< names the surface, such as "the scan"
  std::vector<float> values;  ///< for each point, input units; NaN if it is on no interface
};

/// Measures the distances. Parallel; the result does not depend on the number of threads.
///
/// \pre `mesh` has its interfaces; `surface` has triangles.
SurfaceDistances surface_distances(const TetMesh& mesh, const TriangleMesh& surface, std::string from);

}  // namespace tetwright
