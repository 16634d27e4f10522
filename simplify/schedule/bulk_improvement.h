// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "simplify/schedule/improvement.h"

namespace tetwright {

struct BulkPlan {
  const char* kind;   ///< kind of its rounds in the report
  float bad_quality;  ///< tets of at most this quality are worked on
  std::size_t min_tets, max_tets;
  int max_rounds;
  /// Also resizes tets, and flips tets around the bad ones at random.
  bool remodel;
};

/// Improves bad tets by cheap operations, in bulk and in random order: flips and smoothing; to remodel, also
/// collapses of crowded points and insertions in long edges of the surface. If most tets are bad, improving
/// the worst first is not the most effective order, and no single operation improves the worst tet at a large
/// surface triangle. On the sample random_interior, where two thirds of the tets are bad, run_improvement()
/// alone leaves 38 % of the tets below 0.1 sr; after this phase it leaves none.
///
/// \return number of rounds.
/// \throws Interrupted, OutOfTime.
/// \pre The mesh is compacted and rated by shape.
int run_bulk_improvement(const ImprovementTools& tools, ImprovementArea& area, const BulkPlan& plan);

}  // namespace tetwright
