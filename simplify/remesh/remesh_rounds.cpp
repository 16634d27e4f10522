// SPDX-License-Identifier: Apache-2.0
#include "simplify/remesh/remesh_rounds.h"

#include <limits>

#include "simplify/operations/collapse.h"
#include "simplify/operations/insertion.h"
#include "simplify/schedule/improve_area.h"

namespace tetwright {

namespace {

/// Factors on the size: shorter edges are collapsed, longer ones halved. Halving makes none that would be
/// collapsed again (as in Botsch & Kobbelt 2004).
constexpr double short_edge = 0.8, long_edge = 4.0 / 3;
/// Max distance of new triangles from the surface that the call found, in sizes, when coarsening.
constexpr double coarsening_distance = 0.1;
/// Share of bad tets above which improvement begins in bulk, as in improve().
constexpr double remesh_bulk_before = 0.4;
constexpr int max_coarsening_rounds = 12, max_refining_rounds = 12;

}  // namespace

RemeshRounds::RemeshRounds(const ImprovementTools& tools, ChangeJournal& journal,
                           const std::vector<Index>& region, const std::vector<Index>& with_rim)
    : rules_(tools.rules),
      tools_{tools.mesh, tools.runner, rules_, tools.recorder},
      region_(region),
      area_(tools.mesh, tools.runner, journal, region, with_rim) {
  rules_.max_error = area_.usual_edge();
}

void RemeshRounds::coarsen(double size, float floor) {
  BlockRules rules = rules_;
  rules.max_error = std::numeric_limits<double>::infinity();
  rules.max_collapsed_edge = short_edge * size;
  rules.max_edge = long_edge * size;
  rules.max_distance = coarsening_distance * size;
  rules.good_enough = floor;
  std::vector<Index> points = area_.first_points(), changed;
  for (int round = 0; round < max_coarsening_rounds && !points.empty(); ++round) {
    tools_.runner.each_star(points, Operation::collapse, [&](Workspace& ws) { return collapse(ws, rules); });
    points = area_.take_changed_points(LocalArea::Part::inner);
    changed.insert(changed.end(), points.begin(), points.end());
  }
  area_.look_around(std::move(changed));
}

void RemeshRounds::refine(double size, float floor) {
  const EditableMesh& mesh = tools_.mesh;
  BlockRules rules = rules_;
  rules.good_enough = floor;
  const double limit = long_edge * size;
  std::vector<Index> tets = region_, changed;
  for (int round = 0; round < max_refining_rounds && !tets.empty(); ++round) {
    std::vector<TetSnapshot> items;
    items.reserve(tets.size());
    for (Index t : tets) items.push_back({t, mesh.points(t)});
    tools_.runner.tets(
        items,
        [&](Workspace& ws, const TetSnapshot& item, int) {
          if (!exists(mesh, item)) return Outcome::stale;
          int longest = -1;
          double length = limit;
          for (int e = 0; e < 6; ++e) {
            const Index p = item.points[tet_edges[e][0]], q = item.points[tet_edges[e][1]];
            if (const double l = (mesh.position(p) - mesh.position(q)).norm(); l > length) {
              longest = e;
              length = l;
            }
          }
          if (longest < 0) return Outcome::no_candidate;
          return insert_in_edge(ws, rules, item.tet, longest, InsertionPlace::centre, true);
        },
        [] { return false; });
    const std::vector<Index> points = area_.take_changed_points(LocalArea::Part::inner);
    changed.insert(changed.end(), points.begin(), points.end());
    tets = area_.tets_at(points, LocalArea::Part::inner);
  }
  area_.look_around(std::move(changed));
}

int RemeshRounds::improve(const ImprovementPlan& plan) {
  return improve_area(tools_, area_, plan, remesh_bulk_before);
}

}  // namespace tetwright
