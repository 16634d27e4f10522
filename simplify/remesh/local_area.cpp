// SPDX-License-Identifier: Apache-2.0
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

LocalArea::LocalArea(const EditableMesh& mesh, BlockRunner& runner, ChangeJournal& journal,
                     const std::vector<Index>& tets, const std::vector<Index>& with_rim)
    : mesh_(mesh),
      runner_(runner),
      journal_(journal),
      first_count_(with_rim.size()),
      usual_edge_(mean_edge(mesh, tets)),
      candidates_(tets) {
  for (Index p : near_.points_of(mesh, with_rim)) set_place(p, Place::rim);
  first_points_ = near_.points_of(mesh, tets);
  for (Index p : first_points_) set_place(p, Place::inner);
  runner_.set_observer([this](const Proposal& p) { observe(p); });
}

LocalArea::~LocalArea() { runner_.set_observer(nullptr); }

LocalArea::Place LocalArea::place(Index point) const {
  const Index number = point_numbers_.find(point);
  return number == no_index ? Place::beyond : places_[number];
}

void LocalArea::set_place(Index point, Place place) {
  bool added;
  const Index number = point_numbers_.number(point, added);
  if (added) places_.push_back(place);
  places_[number] = place;
}

void LocalArea::observe(const Proposal& p) {
  ++operations_;
  changed_points_.insert(changed_points_.end(), p.write_set.begin(), p.write_set.end());
  journal_.note(mesh_, p);
  if (!p.has_new_point) return;
  // A new point adjacent to one beyond the rim belongs to the rim, so that work does not spread. Its number
  // may be that of a removed point.
  const bool amid = std::all_of(p.write_set.begin(), p.write_set.end(),
                                [&](Index q) { return q == p.new_point_id || place(q) != Place::beyond; });
  set_place(p.new_point_id, amid ? Place::inner : Place::rim);
}

bool LocalArea::has(const Tet& tet, Part part) const {
  return std::all_of(tet.begin(), tet.end(), [&](Index p) { return has(p, part); });
}

std::vector<Index> LocalArea::take_changed_points(Part part) {
  near_.make_distinct(changed_points_);
  std::vector<Index> points;
  for (Index p : changed_points_)
    if (mesh_.incident_tet(p) != no_index && has(p, part)) points.push_back(p);
  changed_points_.clear();
  return points;
}

std::vector<Index> LocalArea::tets_at(const std::vector<Index>& points, Part part) {
  return near_.tets_at(mesh_, points, [&](Index t) { return has(mesh_.points(t), part); });
}

std::vector<TetSnapshot> LocalArea::bad_tets(float limit) {
  // All points of added or changed tets are in a write set.
  const std::vector<Index> changed = tets_at(take_changed_points(Part::with_rim), Part::with_rim);
  candidates_.insert(candidates_.end(), changed.begin(), changed.end());
  near_.make_distinct(candidates_);
  // A slot may have been reused for a tet that reaches beyond the rim.
  std::erase_if(candidates_, [&](Index t) {
    return mesh_.dead(t) || !has(mesh_.points(t), Part::with_rim) || !(mesh_.quality(t) <= limit);
  });
  return listed(candidates_);
}

std::vector<Index> LocalArea::bad_points(float limit) {
  std::vector<Index> points;
  for (const TetSnapshot& t : bad_tets(limit)) points.insert(points.end(), t.points.begin(), t.points.end());
  near_.make_distinct(points);
  return points;
}

std::vector<Index> LocalArea::tets_around_living(std::vector<Index>&& points) {
  near_.make_distinct(points);
  std::erase_if(points, [&](Index p) { return mesh_.incident_tet(p) == no_index; });
  return tets_at(points, Part::with_rim);
}

void LocalArea::look_around(std::vector<Index>&& points) {
  candidates_ = tets_around_living(std::move(points));
}

std::vector<Index> LocalArea::numbers_around(const std::vector<TetSnapshot>& tets) {
  std::vector<Index> points;
  for (const TetSnapshot& t : tets) points.insert(points.end(), t.points.begin(), t.points.end());
  return tets_around_living(std::move(points));
}

std::vector<TetSnapshot> LocalArea::tets_around(const std::vector<TetSnapshot>& tets) {
  return listed(numbers_around(tets));
}

std::vector<Index> LocalArea::points_around(const std::vector<TetSnapshot>& tets) {
  return near_.points_of(mesh_, numbers_around(tets));
}

std::vector<TetSnapshot> LocalArea::listed(const std::vector<Index>& tets) const {
  std::vector<TetSnapshot> list;
  list.reserve(tets.size());
  for (Index t : tets) list.push_back({t, mesh_.points(t)});
  return list;
}

}  // namespace tetwright
