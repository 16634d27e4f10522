#include "simplify/remesh/remesh_rounds.h"

#include <algorithm>

#include "simplify/operations/collapse.h"
#include "simplify/operations/insertion.h"
#include "simplify/schedule/improve_turn.h"

namespace tetwright {

namespace {

/// Edges shorter than this many times the size are collapsed, longer ones than this many halved: so that
/// halving makes none that would be collapsed again (as in Botsch & Kobbelt 2004).
constexpr double short_edge = 0.8, long_edge = 4.0 / 3;
/// How far new triangles of a coarser surface may be from the one that the call found, in sizes.
constexpr double coarsening_distance = 0.1;
constexpr int max_coarsening_rounds = 12, max_refining_rounds = 12, max_improving_rounds = 16;
/// From this round of improvement on, points of surfaces may leave them a little for the worst tets.
constexpr int last_resort_round = 3;

void sort_unique(std::vector<Index>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

RemeshRounds::RemeshRounds(const EditableMesh& mesh, BlockRunner& runner, ChangeJournal& journal,
                           const BlockRules& rules, const Bounds& bounds, const std::vector<Index>& region)
    : mesh_(mesh), runner_(runner), journal_(journal), rules_(rules), bounds_(bounds), tets_(region) {
  for (Index t : region)
    for (Index p : mesh.points(t)) {
      bool added;
      region_points_.number(p, added);
      if (added) region_point_list_.push_back(p);
    }
  runner_.set_observer([this](const Proposal& p) {
    journal_.note(mesh_, p);
    ++operations_;
    changed_points_.insert(changed_points_.end(), p.marks.begin(), p.marks.end());
    if (!p.has_new_point) return;
    bool added;
    region_points_.number(p.new_point_id, added);
  });
}

RemeshRounds::~RemeshRounds() { runner_.set_observer(nullptr); }

std::vector<Index> RemeshRounds::take_changed_points() {
  std::vector<Index> points = std::move(changed_points_);
  changed_points_.clear();
  sort_unique(points);
  std::erase_if(points, [&](Index p) { return mesh_.incident_tet(p) == no_index || !in_region(p); });
  return points;
}

std::vector<Index> RemeshRounds::tets_at(const std::vector<Index>& points) {
  std::vector<Index> tets;
  seen_.clear();
  for (Index p : points)
    walk_.any_tet(mesh_, p, [&](Index t) {
      bool added;
      seen_.number(t, added);
      const Tet& corners = mesh_.points(t);
      if (added && std::all_of(corners.begin(), corners.end(), [&](Index q) { return in_region(q); }))
        tets.push_back(t);
      return false;
    });
  std::sort(tets.begin(), tets.end());
  return tets;
}

double RemeshRounds::mean_edge() const {
  double sum = 0;
  std::size_t count = 0;
  for (Index t : tets_) {
    if (mesh_.dead(t)) continue;
    const Tet& p = mesh_.points(t);
    for (const auto& e : tet_edges) sum += (mesh_.position(p[e[0]]) - mesh_.position(p[e[1]])).norm();
    count += tet_edges.size();
  }
  return count ? sum / static_cast<double>(count) : 0;
}

void RemeshRounds::coarsen(double size) {
  BlockRules rules = rules_;
  rules.max_error = std::numeric_limits<double>::infinity();
  rules.max_collapsed_edge = short_edge * size;
  rules.max_edge = long_edge * size;
  rules.max_distance = coarsening_distance * size;
  rules.good_enough = bounds_.floor;
  std::vector<Index> points = region_point_list_;
  sort_unique(points);
  std::vector<Index> changed;
  for (int round = 0; round < max_coarsening_rounds && !points.empty(); ++round) {
    runner_.points(
        points,
        [&](Workspace& ws, Index p) {
          Outcome o = ws.gather(p);
          if (o == Outcome::done) o = collapse(ws, rules);
          return ws.count(Operation::collapse, o);
        },
        [] { return false; });
    points = take_changed_points();
    changed.insert(changed.end(), points.begin(), points.end());
  }
  sort_unique(changed);
  std::erase_if(changed, [&](Index p) { return mesh_.incident_tet(p) == no_index; });
  tets_ = tets_at(changed);
}

void RemeshRounds::refine(double size) {
  BlockRules rules = rules_;
  rules.good_enough = bounds_.floor;
  const double limit = long_edge * size;
  std::vector<Index> tets = tets_, changed;
  for (int round = 0; round < max_refining_rounds && !tets.empty(); ++round) {
    std::vector<ListedTet> items;
    items.reserve(tets.size());
    for (Index t : tets) items.push_back({t, mesh_.points(t)});
    runner_.tets(
        items,
        [&](Workspace& ws, const ListedTet& item, int) {
          if (!exists(mesh_, item)) return Outcome::stale;
          int longest = -1;
          double length = limit;
          for (int e = 0; e < 6; ++e) {
            const Index p = item.points[tet_edges[e][0]], q = item.points[tet_edges[e][1]];
            if (const double l = (mesh_.position(p) - mesh_.position(q)).norm(); l > length) {
              longest = e;
              length = l;
            }
          }
          if (longest < 0) return Outcome::no_candidate;
          return insert_in_edge(ws, rules, item.tet, longest, InsertionPlace::centre, true);
        },
        [] { return false; });
    const std::vector<Index> points = take_changed_points();
    changed.insert(changed.end(), points.begin(), points.end());
    tets = tets_at(points);
  }
  sort_unique(changed);
  std::erase_if(changed, [&](Index p) { return mesh_.incident_tet(p) == no_index; });
  tets_ = tets_at(changed);
}

void RemeshRounds::improve() {
  BlockRules surgery = surgery_rules(rules_, mean_edge());
  surgery.leave_surface = true;
  const ImproveBounds bounds{bounds_.poor, bounds_.leave_surface};
  std::vector<Index> tets = tets_;
  for (int round = 0; round < max_improving_rounds; ++round) {
    std::vector<ListedTet> poor;
    for (Index t : tets)
      if (!mesh_.dead(t) && mesh_.quality(t) <= bounds.poor) poor.push_back({t, mesh_.points(t)});
    if (poor.empty()) return;
    std::sort(poor.begin(), poor.end(), [&](const ListedTet& a, const ListedTet& b) {
      const float qa = mesh_.quality(a.tet), qb = mesh_.quality(b.tet);
      return qa != qb ? qa < qb : a.tet < b.tet;
    });
    const bool last_resort = round >= last_resort_round;
    const std::uint64_t before = operations_;
    runner_.tets_in_order(poor, [&](Workspace& ws, const ListedTet& item, int) {
      return improve_tet(ws, {rules_, surgery, bounds, last_resort, true}, item);
    });
    if (operations_ == before && last_resort) return;
    // What failed comes again only where something around it changed, or where a round allows more.
    tets = tets_at(take_changed_points());
    if (round + 1 == last_resort_round)
      for (const ListedTet& t : poor)
        if (exists(mesh_, t)) tets.push_back(t.tet);
    sort_unique(tets);
  }
}

}  // namespace tetwright
