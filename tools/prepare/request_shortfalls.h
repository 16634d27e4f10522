// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/prepare_steps.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Compares the result with the request: count, shapes, edge lengths, tolerance, and limits on time and
/// memory. Adds diagnostics to `run.report`.
///
/// \pre `run.report` has the statistics of the meshes.
void find_request_shortfalls(const TetMesh& mesh, PrepareRun& run);

}  // namespace tetwright
