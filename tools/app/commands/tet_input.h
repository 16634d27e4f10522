// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/tet_mesh.h"
#include "tools/app/commands/command_run.h"

namespace tetwright {

/// What `simplify` and `improve` read.
struct TetInput {
  TetMesh mesh;  ///< coherently oriented, without fields
  /// The mesh with its fields, if it has any, for transfer_fields().
  std::optional<TetMesh> with_fields;
};

/// Reads the tet mesh of `run.line`, repairs what other programs write differently (see make_coherent()), and
/// reports what was found. Throws UsageError for a file of another kind or a target above the count of the
/// mesh, InputError if the file cannot be read or no tet is left.
TetInput read_tets(CommandRun& run);

}  // namespace tetwright
