// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/prepare_steps.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Compares the result with the input: labels, solids, sheets, thin walls, creases and patches. Adds
/// diagnostics to `run.report`.
///
/// \pre `mesh` has its interfaces.
void find_input_changes(const TetMesh& mesh, PrepareRun& run);

/// Reports a boundary that is off where bodies have sheets: points on curves in which a sheet meets the
/// boundary may stop short of it, and simplification may then move others. Does nothing without sheets.
/// \param surface of the input, as meshed
void find_moved_boundary(const TetMesh& mesh, const TriangleMesh& surface, PrepareRun& run);

}  // namespace tetwright
