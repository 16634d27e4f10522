#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/progress.h"
#include "common/reference_surface.h"
#include "common/tet_mesh.h"
#include "simplify/outcome.h"

namespace tetwright {

struct SimplifyOptions {
  std::size_t target_tets = 10000;  ///< at least 1
  double min_solid_angle = 0.1;     ///< steradians; tets below it are what the closing rounds work on
  double beta = 5;           ///< the paper's: largest edge, in ideal edges, that Quality does not penalise
  double gamma = 10;         ///< the paper's: weight of the volume error against the length of an edge
  int max_iterations = 100;  ///< of the block loop
  std::uint64_t seed = 1;
  /// Points or tets that one task takes at a time: large enough to be random within, small enough to stay in
  /// a core's cache (a star takes about 1.5 KB). Results depend on it, not on the number of threads; small
  /// ones provoke conflicts.
  std::size_t chunk_size = 2000;
  std::string name = "mesh";  ///< what messages call the mesh
};

/// What one round of the block loop, or of the closing, did.
struct IterationReport {
  std::string kind;  ///< "simplify" or "close"
  std::size_t tets_before = 0, tets_after = 0;
  double cutoff =
      0;  ///< Quality(t) below which tets were taken up; in the closing, the solid angle in steradians
  double percent = 0;        ///< of the tets that were taken up
  double largest_error = 0;  ///< E, input units
  OperationCounts counts;
  std::uint64_t lock_conflicts = 0, skipped = 0;
  double seconds = 0;
};

struct SimplifyReport {
  std::vector<IterationReport> iterations;
  double seconds_build = 0, seconds_simplify = 0, seconds_close = 0;
};

/// Simplifies a valid mesh to about `target_tets` (within 1 % where topology and shapes allow) and improves
/// its shapes: block iteration of Cutler, Dorsey & McMillan 2004 with a tuned schedule (README.md), then
/// closing rounds at that count. Every material, component, handle, cavity and interface survives; the
/// boundary does not come to intersect itself; all tets stay positive by exact sign. The result
/// has its interface triangles.
///
/// Uses thread_count() threads; with one thread the same input and seed give the same bytes. A mesh that has
/// fewer tets than the target is only improved. Throws InputError if the mesh has flat, inverted or
/// over-shared tets, UsageError for impossible options, Interrupted when cancelled.
TetMesh simplify(TetMesh mesh, const SimplifyOptions& options, SimplifyReport* report = nullptr,
                 Progress* progress = nullptr);

}  // namespace tetwright
