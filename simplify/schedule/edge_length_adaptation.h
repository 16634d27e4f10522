// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "simplify/schedule/improvement.h"

namespace tetwright {

struct SizePlan {
  const char* kind;  ///< of its rounds in the report
  double angle;      ///< steradians: shapes that are better stay better; what is worse is improved between
  std::size_t min_tets, max_tets;
};

/// Collapses edges that are shorter than BlockRules::sizes asks for and halves longer ones, with flips and
/// better places between, until few are left or rounds gain little. Shapes may get worse on the way, down to
/// a share of the bound. The rules must have sizes.
///
/// The mesh is compacted and rated by shape. Throws Interrupted and OutOfTime.
void adapt_edge_lengths(const ImprovementTools& tools, ImprovementArea& area, const SizePlan& plan);

}  // namespace tetwright
