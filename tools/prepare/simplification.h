// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/reference_surface.h"
#include "common/tet_mesh.h"
#include "tools/prepare/run.h"

namespace tetwright {

/// The diagonal of a mesh's bounding box, input units.
double diagonal_of(const TetMesh& mesh);

/// A tolerance in input units. Throws UsageError where it is smaller than distances are known.
double tolerance_of(const Length& asked, double diagonal);

/// Simplifies to the target and the tolerance that are asked for.
/// Points are projected onto `reference`, surfaces fitted to `surface` and kept near it; what is null is the
/// mesh's own. Throws as simplify() does.
TetMesh simplify_to_target(TetMesh mesh, const ReferenceSurface* reference, const TriangleMesh* surface,
                           PrepareRun& run);

}  // namespace tetwright
