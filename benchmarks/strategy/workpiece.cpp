// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/strategy/workpiece.h"

#include <algorithm>

#include "simplify/operations/collapse.h"
#include "simplify/operations/collapse_table.h"

namespace tetwright {

Workpiece::Workpiece(TetMesh input, std::size_t target_tets)
    : mesh(std::move(input), "mesh"), target(target_tets) {
  rules.objective.quality = TetQuality::for_target(mesh.total_volume(), static_cast<double>(target));
  rules.error.max.reset();
  rules.count.min = 0;
  // Refuse only shapes far worse than the current ones, in both orderings: neither could reach the target if
  // no shape were allowed to get worse.
  rules.acceptance.worse_probability = 1;
  rules.acceptance.worse_floor = 0.1f;
  grid.build(mesh);
  rate_all();
}

void Workpiece::rate_all() {
  for (Index t = 0; t < mesh.tet_slots(); ++t) {
    const Tet& p = mesh.points(t);
    if (p[0] != no_index)
      mesh.set_quality(t, rules.objective(mesh.position(p[0]), mesh.position(p[1]), mesh.position(p[2]),
                                          mesh.position(p[3])));
  }
}

bool Workpiece::gather(Workspace& ws, Index point) {
  ++counts.stars;
  return alive(point) && ws.star.gather(mesh, point) == Outcome::done;
}

void Workpiece::weigh(Workspace& ws, std::vector<WeighedCollapse>& out,
                      const std::function<bool(Index)>& wanted) {
  Star& star = ws.star;
  const int along = collapsible_edge(vertex_kind(star));
  if (along == never) return;
  star.compute_gradients();
  for (std::size_t p = 0; p < star.points.size(); ++p) {
    if (star.edge_dimension(p) != along || !wanted(star.points[p])) continue;
    out.push_back({collapse_weight(star, p, rules), star.centre, star.points[p]});
    ++counts.weights;
  }
}

bool Workpiece::propose(Workspace& ws, Index onto) {
  ++counts.tests;
  const std::vector<Index>& link = ws.star.points;
  const auto b = static_cast<std::size_t>(std::find(link.begin(), link.end(), onto) - link.begin());
  return b < link.size() && ws.count(Operation::collapse, collapse_onto(ws, rules, b)) == Outcome::done;
}

void Workpiece::carry_out(Workspace& ws) {
  commit_alone(mesh, grid, ws.proposal, commit_workspace_);
  ++counts.collapses;
}

}  // namespace tetwright
