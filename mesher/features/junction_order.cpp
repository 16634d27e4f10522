// SPDX-License-Identifier: Apache-2.0
// The order of points along junctions of a mesh, and the corners that it implies.
#include <algorithm>
#include <limits>

#include "mesher/features/crease_labels.h"
#include "mesher/tuning/cut_tuning.h"

namespace tetwright {

using Labelling = CutTuning::Labelling;

namespace {

bool same(const PatchSet& a, const PatchSet& b) { return std::equal(a.begin(), a.end(), b.begin(), b.end()); }

}  // namespace

std::map<Index, std::vector<Index>> CreaseLabels::junction_neighbours() const {
  std::vector<SheetEdge> sides;
  const auto may_follow = [&](Index p) { return of(p).kind == Kind::crease || of(p).kind == Kind::corner; };
  for (const InterfaceTriangle& t : mesh_.interfaces)
    if (const auto sheet = sheet_of(t))
      for (std::size_t k = 0; k < 3; ++k) {
        const Index u = t.ids[k], v = t.ids[(k + 1) % 3];
        if (may_follow(u) && may_follow(v)) sides.push_back({std::min(u, v), std::max(u, v), *sheet});
      }
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  std::map<Index, std::vector<Index>> next;
  for (auto first = sides.begin(); first != sides.end();) {
    const auto end =
        std::find_if_not(first, sides.end(), [&](const SheetEdge& e) { return e.same_ends(*first); });
    if (end - first > 1) {
      next[first->u].push_back(first->v);
      next[first->v].push_back(first->u);
    }
    first = end;
  }
  return next;
}

/// The points of a junction from one that represents a corner up to the first, inclusive, that is on another
/// curve of the corner than its predecessor: that curve passes the corner elsewhere. Empty if there is none.
std::vector<Index> CreaseLabels::beyond_corner(const std::map<Index, std::vector<Index>>& neighbours,
                                               Index corner, Index beside) const {
  const FeatureSurface::Corner& at = surface_.corners()[of(corner).corner];
  std::vector<Index> run{corner};
  for (Index p = beside;;) {
    const auto next = neighbours.find(p);
    if (of(p).kind != Kind::crease || next->second.size() != 2 ||
        (mesh_.points[p] - at.point).norm() > Labelling::junction_reach * cell_ ||
        of(p).patches.common(of(corner).patches).size() != of(p).patches.size())
      return {};
    const Index before = run.back();
    run.push_back(p);
    if (before != corner && !same(of(before).patches, of(p).patches)) return run;
    p = next->second[0] == before ? next->second[1] : next->second[0];
    if (p == corner) return {};
  }
}

/// Chooses the point of a run that represents its corner, such that all points are as close as possible to
/// the curves on their side of it, and labels the others accordingly.
void CreaseLabels::divide_at_corner(const std::vector<Index>& run, bool corner_may_move) {
  const FeatureLabel corner = of(run.front()), near = of(run[1]), far = of(run.back());
  const Vec3& at = surface_.corners()[corner.corner].point;
  const auto cost_on = [&](Index p, const FeatureLabel& curve) {
    const auto on =
        surface_.onto_crease_between(mesh_.points[p], curve.crease, CutTuning::Fitting::target_reach * cell_);
    return on ? (*on - mesh_.points[p]).squaredNorm() : std::numeric_limits<double>::infinity();
  };
  const std::set<std::size_t> sheets = sheets_at(number_[run.front()]);
  std::size_t best = run.size();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < (corner_may_move ? run.size() : 1); ++c) {
    if (sheets_at(number_[run[c]]) != sheets) continue;
    double cost = (at - mesh_.points[run[c]]).squaredNorm();
    for (std::size_t i = 0; i < run.size(); ++i)
      if (i != c) cost += cost_on(run[i], i < c ? near : far);
    if (cost < least) {
      least = cost;
      best = c;
    }
  }
  if (best == run.size()) return;
  for (std::size_t i = 0; i < run.size(); ++i) label(run[i]) = i < best ? near : i == best ? corner : far;
}

/// Makes labels change along junctions where a point represents the corner, and nowhere else near it. The
/// mesh's junctions are as jagged as cells, so that the vertex nearest to a corner need not be where the
/// points beside it pass from one curve to the next.
void CreaseLabels::order_corners() {
  if (!surface_.has_junctions()) return;
  const std::map<Index, std::vector<Index>> neighbours = junction_neighbours();
  for (const auto& [p, around] : neighbours) {
    if (of(p).kind != Kind::corner) continue;
    for (const Index beside : around) {
      const std::vector<Index> run = beyond_corner(neighbours, p, beside);
      if (run.empty()) continue;
      // If the curve does not go on behind the corner, others end in its point.
      const bool goes_on = around.size() == 2 && std::any_of(around.begin(), around.end(), [&](Index q) {
                             return q != beside && same(of(q).patches, of(beside).patches);
                           });
      divide_at_corner(run, goes_on);
      break;
    }
  }
}

}  // namespace tetwright
