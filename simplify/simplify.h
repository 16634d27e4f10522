// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/progress.h"
#include "common/tet_mesh.h"
#include "simplify/schedule/options.h"

namespace tetwright {

/// Simplifies a valid mesh to about `target_tets` (within 1 % where topology and shapes allow) and improves
/// its shapes: block iteration of Cutler, Dorsey & McMillan 2004 with a tuned schedule (README.md), then
/// closing rounds at that count. Every material, component, handle, cavity and interface survives; the
/// boundary does not come to intersect itself; all tets stay positive by exact sign. The result
/// has its interface triangles.
///
/// Uses thread_count() threads; the same input, options and seed give the same bytes for any number. A mesh
/// that has fewer tets than the target is only improved. Throws InputError if a coordinate is not finite, a
/// tet repeats a point or a face has more than two tets, OutputError if there is too little memory,
/// UsageError for impossible options, Interrupted when cancelled. The deadline of `progress` ends it with
/// what there is then, as valid as ever (the same mesh, perhaps renumbered, if nothing was changed yet): the
/// loop before, so that the shapes can be improved, too, and that with a tolerance before, so that distances
/// can be measured. Renumbering after the last round is added to that, and what it takes to bound the
/// distances at all.
TetMesh simplify(TetMesh mesh, const SimplifyOptions& options, SimplifyReport* report = nullptr,
                 Progress* progress = nullptr);

/// How far a mesh's surface is from the one that it was made from, proven. `surface` in input units, wound
/// outwards. Works on a copy. Throws InputError as simplify() does. Parallel; the result does not depend on
/// the threads. `progress` (may be null) ends it as it ends surface_deviation().
DeviationReport deviation(const TetMesh& mesh, const TriangleMesh& surface,
                          const Progress* progress = nullptr);

/// Improves the shapes of a mesh at about its count: what closes simplify(), by itself. The same guarantees,
/// threads and errors.
TetMesh improve(TetMesh mesh, const ImproveOptions& options, SimplifyReport* report = nullptr,
                Progress* progress = nullptr);

}  // namespace tetwright
