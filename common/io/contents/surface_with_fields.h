// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// A surface with the fields of its points.
struct SurfaceWithFields {
  TriangleMesh surface;
  std::vector<MeshField> point_fields;  ///< of surface.points, in the file's order
};

}  // namespace tetwright
