// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "tetwright/simplify.h"

namespace tetwright {

/// The surface of an OriginalMesh in the working coordinates and with the regions of the coarsened mesh.
struct OriginalSurface {
  std::vector<Vec3> points;
  std::vector<InterfaceFace> faces;  ///< ids are indices into points
};

/// Moves the surface out of an original. Parallel.
/// \throws UsageError if the mesh lacks a material of the original, or a triangle of it a point
OriginalSurface take_surface(const EditableMesh& mesh, OriginalMesh& original);

}  // namespace tetwright
