// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/tet_mesh.h"
#include "tools/prepare/run.h"

namespace tetwright {

/// Compares a result with what was asked for and with what was there before: fills `run.report`. `mesh` has
/// its interfaces.
void assess(const TetMesh& mesh, PrepareRun& run);

}  // namespace tetwright
