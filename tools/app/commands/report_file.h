// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tetwright/files.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"
#include "tools/app/commands/command_run.h"
#include "tools/compare/check_report.h"

namespace tetwright {

// The page of --report. These functions do nothing without --report.

/// Measures the distance of the result's boundary and interfaces from `surface`. Does nothing if that is
/// empty.
///
/// \param from name of `surface` on the page
void measure_distances(const TetMesh& result, const TriangleMesh& surface, std::string from, CommandRun& run);

/// Adds the page to the files.
///
/// \param check null unless the command is `check`
void write_report(const TetMesh& mesh, const CommandRun& run, OutputFiles& files,
                  const CheckReport* check = nullptr);

}  // namespace tetwright
