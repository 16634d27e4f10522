// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesher/features/feature_surface.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Where creases are given up, joins small groups of faces of one patch with the patch around them: patches
/// are those of the nearest triangles there, which alternate from face to face, and their borders would keep
/// the simplifier from joining faces.
/// \param cell edge of a finest cell, input units
void join_specks(TetMesh& mesh, const FeatureSurface& surface, double cell);

}  // namespace tetwright
