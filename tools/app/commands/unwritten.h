// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/prepare.h"
#include "tetwright/tet_mesh.h"
#include "tools/app/command_line.h"

namespace tetwright {

/// Adds diagnostics for data that neither the format of -o nor another output file can hold, and for tags,
/// numbers and names that the format changes.
void find_unwritten(const CommandLine& line, const TetMesh& mesh, PrepareReport& report);

}  // namespace tetwright
