// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/reference_surface.h"
#include "common/tet_mesh.h"
#include "tools/app/commands/command_run.h"

namespace tetwright {

/// The diagonal of a mesh's bounding box, input units.
double diagonal_of(const TetMesh& mesh);

/// --tolerance in input units. Throws UsageError where it is smaller than distances are known.
double tolerance_of(const CommandLine& line, double diagonal);

/// Simplifies to --target-tets and --tolerance with the options of `run.line`, for `prepare` and `simplify`.
/// Points are projected onto `reference`, surfaces fitted to `surface` and kept near it; what is null is the
/// mesh's own. Throws as simplify() does.
TetMesh simplify_to_target(TetMesh mesh, const ReferenceSurface* reference, const TriangleMesh* surface,
                           CommandRun& run);

}  // namespace tetwright
