// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tetwright/files.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"
#include "tools/app/commands/command_run.h"
#include "tools/compare/check_report.h"

namespace tetwright {

// The page of --report. All of these do nothing unless `run.line` asks for it.

/// How far the boundary and the interfaces of the result are from `surface`; not measured where that has no
/// triangles. `from` says what it is.
void measure_distances(const TetMesh& result, const TriangleMesh& surface, std::string from, CommandRun& run);

/// Adds the page to the files. `check` may be null.
void write_report(const TetMesh& mesh, const CommandRun& run, OutputFiles& files,
                  const CheckReport* check = nullptr);

}  // namespace tetwright
