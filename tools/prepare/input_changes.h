// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/prepare_steps.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Compares the result with the input: labels, solids, thin walls, creases and patches. Adds diagnostics to
/// `run.report`.
///
/// \pre `mesh` has its interfaces.
void find_input_changes(const TetMesh& mesh, PrepareRun& run);

}  // namespace tetwright
