#include "simplify/schedule/poor_spots.h"

#include <limits>
#include <vector>

#include "simplify/operations/insertion.h"
#include "simplify/schedule/improve_area.h"

namespace tetwright {

namespace {

constexpr int max_rounds = 8;
/// Rounds that may gain nothing: each halves edges farther around.
constexpr int max_idle = 2;
/// Of the bound of shapes: what halved tets must be. Flips and better places mend them.
constexpr float split_floor = 0.3f;

}  // namespace

void refine_poor_spots(const ImprovementTools& tools, ImprovementArea& area, ImprovementPlan plan,
                       double angle) {
  EditableMesh& mesh = tools.mesh;
  const auto bound = [&](double a) {
    return static_cast<float>(shape_quality_bound(tools.rules.objective.shape, a));
  };
  BlockRules halving = tools.rules;
  halving.max_error = std::numeric_limits<double>::infinity();
  halving.good_enough = split_floor * bound(angle);
  halving.count = {plan.min_tets, plan.max_tets};
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int idle = 0;
  for (int i = 0; i < max_rounds && plan.max_rounds > 0; ++i) {
    const std::vector<ListedTet> poor = area.poor_tets(bound(angle));
    if (poor.empty()) return;
    idle = poor.size() < fewest ? 0 : idle + 1;
    if (idle > max_idle) return;
    fewest = std::min(fewest, poor.size());
    {
      RoundRecorder::Round round(tools.recorder, plan.kind, 0);
      tools.runner.tets(
          area.tets_around(poor),
          [&](Workspace& ws, const ListedTet& item, int) {
            if (!exists(mesh, item)) return Outcome::stale;
            int longest = 0;
            double most = 0;
            for (int e = 0; e < 6; ++e) {
              const double length =
                  (mesh.position(item.points[tet_edges[e][0]]) - mesh.position(item.points[tet_edges[e][1]]))
                      .squaredNorm();
              if (length > most) longest = e, most = length;
            }
            return insert_in_edge(ws, halving, item.tet, longest, InsertionPlace::centre, true);
          },
          [] { return false; });
      round.finish();
    }
    plan.max_rounds -= improve_area(tools, area, plan, 1);
  }
}

}  // namespace tetwright
