// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>

#include "mesher/mesher.h"
#include "tools/app/commands/command_run.h"

namespace tetwright {

/// What `prepare` and `mesh` read: surfaces, or one segmented volume.
using ScanInput = std::variant<MesherInput, LabelInput>;

/// True for a name with the extension .vdb, in upper or lower case.
bool is_vdb(const std::string& path);

/// Reads the inputs of `run.line` and makes them ready for meshing; reports what was found in them. Throws
/// UsageError for files and options that do not go together, and what the readers throw.
ScanInput read_scan(CommandRun& run);

/// Meshes the input at the resolution that `run.line` asks for or that its target needs. `result.field` is
/// null unless `run.line` has further use for it. Throws as mesh_surfaces() and mesh_labels() do.
DenseMesh make_dense_mesh(ScanInput input, CommandRun& run);

}  // namespace tetwright
