// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "simplify/schedule/improvement.h"

namespace tetwright {

struct BulkPlan {
  const char* kind;   ///< of its rounds in the report
  float bad_quality;  ///< tets of at most this quality are worked on
  std::size_t min_tets, max_tets;
  int max_rounds;
  /// Also changes the sizes of tets, and flips tets around the bad ones at random.
  bool remodel;
};

/// Improves what is bad by the cheap operations, in bulk and in random order: flips and better places; to
/// remodel, collapses of crowded points and points in long edges of the surface, too. Where two tets in three
/// are bad, the worst are hardly ever those whose turn does most for the others, and no single operation
/// makes the worst tet of a large triangle of the surface better: run_improvement() then leaves 38 % below
/// 0.1 sr of the sample random_interior, after this phase none.
///
/// The mesh is compacted and rated by shape. Returns the number of rounds it took. Throws Interrupted and
/// OutOfTime.
int run_bulk_improvement(const ImprovementTools& tools, ImprovementArea& area, const BulkPlan& plan);

}  // namespace tetwright
