// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "simplify/schedule/improvement.h"

namespace tetwright {

struct SizePlan {
  const char* kind;  ///< kind of its rounds in the report
  double angle;      ///< steradians: better shapes stay above it; worse ones are improved between rounds
  std::size_t min_tets, max_tets;
};

/// Collapses edges shorter than BlockRules::sizes allows and halves longer ones, with flips and smoothing
/// between, until few are left or rounds gain little. Meanwhile shapes may get worse, down to a fraction of
/// the bound.
///
/// \throws Interrupted, OutOfTime.
/// \pre The rules have sizes. The mesh is compacted and rated by shape.
void adapt_edge_lengths(const ImprovementTools& tools, ImprovementArea& area, const SizePlan& plan);

}  // namespace tetwright
