// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/progress.h"
#include "common/tet_mesh.h"
#include "simplify/schedule/options.h"

namespace tetwright {

/// Simplifies a valid mesh to about `target_tets` (within 1 % where topology and shapes allow) and improves
/// its shapes: the block iteration of Cutler, Dorsey & McMillan 2004 with a tuned schedule (README.md), then
/// closing rounds at that count. A mesh with fewer tets than the target is only improved.
///
/// Every material, component, handle, cavity and interface survives; the boundary does not come to intersect
/// itself; all tets stay positive by exact sign. The result has its interface triangles. Uses thread_count()
/// threads; the same input, options and seed give the same bytes for any number of them.
///
/// The deadline of `progress` ends the work with the current mesh, as valid as ever (the input, perhaps
/// renumbered, if nothing has changed yet). The loop ends earlier, so that shapes can still be improved, and
/// with a tolerance the improvement ends earlier, so that distances can be measured. The final renumbering,
/// and the least work that bounds the distances, exceed the deadline.
///
/// \param report gets the record of the work; may be null.
/// \param progress may be null.
/// \throws InputError if a coordinate is not finite, a tet repeats a point or a face has more than two tets.
/// \throws OutputError if there is too little memory.
/// \throws UsageError for impossible options.
/// \throws Interrupted when cancelled.
TetMesh simplify(TetMesh mesh, const SimplifyOptions& options, SimplifyReport* report = nullptr,
                 Progress* progress = nullptr);

/// Two-sided distance between a mesh's surface and the surface that it was made from, with proven bounds.
/// Works on a copy. Parallel; the result does not depend on the threads.
///
/// \param surface wound outwards, input units.
/// \param progress ends it as it ends surface_deviation(); may be null.
/// \throws InputError as simplify().
DeviationReport deviation(const TetMesh& mesh, const TriangleMesh& surface,
                          const Progress* progress = nullptr);

/// Improves the shapes of a mesh at about its count, like the end of simplify(), with the same guarantees,
/// threads and errors.
TetMesh improve(TetMesh mesh, const ImproveOptions& options, SimplifyReport* report = nullptr,
                Progress* progress = nullptr);

}  // namespace tetwright
