// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/prepare.h"
#include "tetwright/tet_mesh.h"
#include "tools/app/command_line.h"

namespace tetwright {

/// Adds to the diagnostics what the format of -o has no place for, and no other file that is written, and the
/// tags, numbers and names that it cannot hold as they are.
void find_unwritten(const CommandLine& line, const TetMesh& mesh, PrepareReport& report);

}  // namespace tetwright
