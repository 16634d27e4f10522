#include "simplify/remesh/local_area.h"

#include <algorithm>

namespace tetwright {

namespace {

double mean_edge(const EditableMesh& mesh, const std::vector<Index>& tets) {
  double sum = 0;
  for (Index t : tets) {
    const Tet& p = mesh.points(t);
    for (const auto& e : tet_edges) sum += (mesh.position(p[e[0]]) - mesh.position(p[e[1]])).norm();
  }
  return tets.empty() ? 0 : sum / static_cast<double>(tet_edges.size() * tets.size());
}

}  // namespace

LocalArea::LocalArea(const EditableMesh& mesh, BlockRunner& runner, double usual_edge,
                     const std::vector<ListedTet>& poor)
    : mesh_(mesh), runner_(runner), limited_(false), usual_edge_(usual_edge) {
  for (const ListedTet& t : poor) candidates_.push_back(t.tet);
  runner_.set_observer([this](const Proposal& p) { observe(p); });
}

LocalArea::LocalArea(const EditableMesh& mesh, BlockRunner& runner, ChangeJournal& journal,
                     const std::vector<Index>& tets, const std::vector<Index>& reach)
    : mesh_(mesh),
      runner_(runner),
      journal_(&journal),
      limited_(true),
      listed_at_first_(tets.size()),
      usual_edge_(mean_edge(mesh, tets)),
      candidates_(tets) {
  bool added;
  for (Index p : reach) reach_.number(p, added);
  for (Index t : tets)
    for (Index p : mesh.points(t)) {
      points_.number(p, added);
      if (added) first_points_.push_back(p);
    }
  std::sort(first_points_.begin(), first_points_.end());
  runner_.set_observer([this](const Proposal& p) { observe(p); });
}

LocalArea::~LocalArea() { runner_.set_observer(nullptr); }

void LocalArea::observe(const Proposal& p) {
  ++operations_;
  changed_points_.insert(changed_points_.end(), p.marks.begin(), p.marks.end());
  if (journal_) journal_->note(mesh_, p);
  if (!limited_ || !p.has_new_point) return;
  // Any other would draw points into the area that are two edges away from it.
  if (!std::all_of(p.marks.begin(), p.marks.end(),
                   [&](Index q) { return q == p.new_point_id || within_reach(q); }))
    return;
  bool added;
  points_.number(p.new_point_id, added);
  reach_.number(p.new_point_id, added);
}

bool LocalArea::has(const Tet& tet, Part part) const {
  const auto inside = [&](Index p) { return within(p); };
  if (part == Part::inner) return std::all_of(tet.begin(), tet.end(), inside);
  return std::any_of(tet.begin(), tet.end(), inside) &&
         std::all_of(tet.begin(), tet.end(), [&](Index p) { return within_reach(p); });
}

std::vector<Index> LocalArea::take_changed_points() {
  std::vector<Index> points;
  seen_.clear();
  for (Index p : changed_points_) {
    bool added;
    seen_.number(p, added);
    if (added && mesh_.incident_tet(p) != no_index && within(p)) points.push_back(p);
  }
  changed_points_.clear();
  std::sort(points.begin(), points.end());
  return points;
}

std::vector<Index> LocalArea::tets_at(const std::vector<Index>& points, Part part) {
  std::vector<Index> tets;
  seen_.clear();
  for (Index p : points)
    walk_.any_tet(mesh_, p, [&](Index t) {
      bool added;
      seen_.number(t, added);
      if (added && has(mesh_.points(t), part)) tets.push_back(t);
      return false;
    });
  std::sort(tets.begin(), tets.end());
  return tets;
}

std::vector<ListedTet> LocalArea::poor_tets(float limit) {
  // Every tet that was made or changed has only points that were marked, or a new one beside them.
  const std::vector<Index> changed = tets_at(take_changed_points(), Part::with_rim);
  candidates_.insert(candidates_.end(), changed.begin(), changed.end());
  std::sort(candidates_.begin(), candidates_.end());
  candidates_.erase(std::unique(candidates_.begin(), candidates_.end()), candidates_.end());
  std::erase_if(candidates_, [&](Index t) { return mesh_.dead(t) || !(mesh_.quality(t) <= limit); });
  std::vector<ListedTet> poor;
  poor.reserve(candidates_.size());
  for (Index t : candidates_) poor.push_back({t, mesh_.points(t)});
  return poor;
}

std::vector<ListedTet> LocalArea::tets_around(const std::vector<ListedTet>& tets) {
  std::vector<Index> points;
  seen_.clear();
  for (const ListedTet& t : tets)
    for (Index p : t.points) {
      bool added;
      seen_.number(p, added);
      // What was listed may have gone since.
      if (added && mesh_.incident_tet(p) != no_index) points.push_back(p);
    }
  std::vector<ListedTet> around;
  for (Index t : tets_at(points, Part::with_rim)) around.push_back({t, mesh_.points(t)});
  return around;
}

std::vector<Index> LocalArea::points_around(const std::vector<ListedTet>& tets) {
  const std::vector<ListedTet> around = tets_around(tets);
  std::vector<Index> points;
  seen_.clear();
  for (const ListedTet& t : around)
    for (Index p : t.points) {
      bool added;
      seen_.number(p, added);
      if (added) points.push_back(p);
    }
  std::sort(points.begin(), points.end());
  return points;
}

}  // namespace tetwright
