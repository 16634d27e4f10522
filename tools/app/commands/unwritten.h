// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/tet_mesh.h"
#include "tools/app/command_line.h"
#include "tools/prepare/run_report.h"

namespace tetwright {

/// Adds to the findings what the format of -o has no place for, and no other file that is written, and the
/// tags, numbers and names that it cannot hold as they are.
void find_unwritten(const CommandLine& line, const TetMesh& mesh, RunReport& report);

}  // namespace tetwright
