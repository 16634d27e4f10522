// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/tet_mesh.h"
#include "tools/prepare/run.h"

namespace tetwright {

/// Improves the shapes of a mesh as it is asked for. Tets that stay below ShapeOptions::only_below are a
/// finding. Throws as improve() does.
TetMesh improve_shapes(TetMesh mesh, PrepareRun& run);

}  // namespace tetwright
