// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/tet_mesh.h"
#include "tools/prepare/run.h"

namespace tetwright {

/// A tet mesh to be simplified or improved.
struct TetInput {
  TetMesh mesh;  ///< coherently oriented, without fields
  /// The mesh with its fields, if it has any, for transfer_fields().
  std::optional<TetMesh> with_fields;
};

/// Reads a tet mesh, repairs what other programs write differently (see make_coherent()), and
/// reports what was found. Throws UsageError for a file of another kind or a target above the count of the
/// mesh, InputError if the file cannot be read or no tet is left.
TetInput read_tets(Input from, PrepareRun& run);

}  // namespace tetwright
