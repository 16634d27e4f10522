// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "common/files/atomic_file.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"
#include "tools/app/commands/command_run.h"

namespace tetwright {

// The page of --report. All of these do nothing unless `run.line` asks for it.

/// The boundary and the interfaces of a mesh that is about to be changed, for measure_distances(); else
/// empty.
TriangleMesh surface_for_report(const TetMesh& mesh, const CommandRun& run);

/// How far the boundary and the interfaces of the result are from `surface`; not measured where that has no
/// triangles. `from` says what it is.
void measure_distances(const TetMesh& result, const TriangleMesh& surface, std::string from, CommandRun& run);

/// Adds the page to the files. `check` may be null.
void write_report(const TetMesh& mesh, const CommandRun& run, OutputFiles& files,
                  const CheckReport* check = nullptr);

}  // namespace tetwright
