// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/edge_length_adaptation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "simplify/operations/collapse.h"
#include "simplify/operations/insertion.h"
#include "simplify/schedule/bulk_improvement.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using Adaptation = SimplifyTuning::Adaptation;

class EdgeLengthAdaptation {
 public:
  EdgeLengthAdaptation(const ImprovementTools& tools, ImprovementArea& area, const SizePlan& plan)
      : tools_(tools),
        mesh_(tools.mesh),
        sizes_(*tools.rules.sizes),
        area_(area),
        plan_(plan),
        bound_(static_cast<float>(shape_quality_bound(tools.rules.objective.shape, plan.angle))),
        resizing_(tools.rules) {
    resizing_.error.max.reset();
    resizing_.acceptance.good_enough = Adaptation::floor * bound_;
    resizing_.count = {plan.min_tets, plan.max_tets};
  }

  void run() {
    double min_excess = std::numeric_limits<double>::infinity();
    int idle = 0;
    for (int i = 0; i < Adaptation::max_rounds; ++i) {
      const OutOfBounds out = out_of_bounds();
      if (out.share == 0 || (sizes_.has_target_length() && !sizes_.has_bounds() &&
                             out.share <= Adaptation::max_violating_share))
        break;
      idle = out.excess > Adaptation::idle_above * min_excess ? idle + 1 : 0;
      if (idle > Adaptation::max_idle) break;
      min_excess = std::min(min_excess, out.excess);
      {
        RoundRecorder::Round round(tools_.recorder, plan_.kind, 0);
        round.report().percent = 100 * out.share;
        collapse_short();
        split_long();
        round.finish();
      }
      (void)run_bulk_improvement(tools_, area_,
                                 {.kind = plan_.kind,
                                  .bad_quality = bound_,
                                  .min_tets = plan_.min_tets,
                                  .max_tets = plan_.max_tets,
                                  .max_rounds = Adaptation::shape_rounds,
                                  .remodel = false});
    }
  }

 private:
  /// Edges that are too long or too short, each counted once for each of its tets.
  struct OutOfBounds {
    double share;   ///< of all edges
    double excess;  ///< mean binary logarithm of the factors: halving an edge that is far too long counts
  };

  OutOfBounds out_of_bounds() {
    std::size_t out = 0, all = 0;
    double excess_sum = 0;
    for (const TetSnapshot& t : area_.bad_tets(1))
      for (const auto& e : tet_edges) {
        const EdgeSizes::Excess excess =
            sizes_.excess(mesh_.position(t.points[e[0]]), mesh_.position(t.points[e[1]]));
        ++all;
        const double factor = std::max(excess.longer, excess.shorter);
        if (!(factor > 1)) continue;
        ++out;
        excess_sum += std::log2(factor);
      }
    const auto edges = static_cast<double>(std::max<std::size_t>(1, all));
    return {static_cast<double>(out) / edges, excess_sum / edges};
  }

  void collapse_short() {
    BlockRules rules = resizing_;
    rules.collapse.short_edges_only = true;
    tools_.runner.each_star(area_.bad_points(1), Operation::collapse,
                            [&](Workspace& ws) { return collapse(ws, rules); });
  }

  /// Splits, at its midpoint, the edge of each tet that exceeds its max length by the largest factor.
  void split_long() {
    tools_.runner.tets(
        area_.bad_tets(1),
        [&](Workspace& ws, const TetSnapshot& item, int) {
          if (!exists(mesh_, item)) return Outcome::stale;
          int longest = -1;
          double max_ratio = 1;
          for (int e = 0; e < 6; ++e) {
            const double longer = sizes_
                                      .excess(mesh_.position(item.points[tet_edges[e][0]]),
                                              mesh_.position(item.points[tet_edges[e][1]]))
                                      .longer;
            if (longer <= max_ratio) continue;
            longest = e;
            max_ratio = longer;
          }
          if (longest < 0) return Outcome::no_candidate;
          return insert_in_edge(ws, resizing_, item.tet, longest, InsertionPlace::centre, true);
        },
        [] { return false; });
  }

  const ImprovementTools& tools_;
  const EditableMesh& mesh_;
  const EdgeSizes& sizes_;
  ImprovementArea& area_;
  const SizePlan& plan_;
  float bound_;
  BlockRules resizing_;
};

}  // namespace

void adapt_edge_lengths(const ImprovementTools& tools, ImprovementArea& area, const SizePlan& plan) {
  EdgeLengthAdaptation(tools, area, plan).run();
}

}  // namespace tetwright
