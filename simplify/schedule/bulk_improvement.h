#pragma once

#include <cstddef>

#include "simplify/schedule/engine.h"

namespace tetwright {

struct BulkPlan {
  const char* kind;  ///< of its rounds in the report
  float poor;        ///< tets of at most this quality are worked on
  std::size_t min_tets, max_tets;
  int max_rounds;
};

/// Improves what is poor by the cheap operations, in bulk and in random order: flips, better places, and
/// where much stays poor the size of the tets, by collapses of crowded points and points in long edges of the
/// surface. What is left is for run_improvement(), which takes ten times as long for each tet. Needs a
/// compacted mesh that is rated by shape. Returns the number of rounds it took. Throws Interrupted.
int run_bulk_improvement(Engine& engine, const BulkPlan& plan);

}  // namespace tetwright
