// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/proposal.h"

#include <algorithm>

#include "common/mesh/face_buckets.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

Tet with_new_point(Tet points, Index id) {
  std::replace(points.begin(), points.end(), unnumbered_point, id);
  return points;
}

void commit_move(EditableMesh& mesh, const Proposal& p) {
  mesh.set_position(p.centre, p.position);
  for (const Proposal::RatedTet& t : p.rated) mesh.set_quality(t.tet, t.quality);
}

void commit_collapse(EditableMesh& mesh, const Proposal& p) {
  for (const Proposal::Relink& r : p.relinks) mesh.set_link(r.tet, r.face, r.link);
  for (const Proposal::RatedTet& t : p.rated) {
    mesh.set_point(t.tet, t.slot, p.target);
    mesh.set_quality(t.tet, t.quality);
  }
  for (const Proposal::Incident& i : p.incidents) mesh.set_incident_tet(i.point, i.tet);
  for (Index t : p.removed) mesh.set_points(t, dead_tet);
  mesh.set_incident_tet(p.centre, no_index);
}

/// Writes the new tets, but not their links; appends their faces to `sides`.
void write_tets(EditableMesh& mesh, const Proposal& p, CommitWorkspace& ws) {
  for (std::size_t i = 0; i < p.added.size(); ++i) {
    const NewTet& n = p.added[i];
    const Tet points = with_new_point(n.points, p.new_point_id);
    const Index slot = i < p.removed.size() ? p.removed[i] : p.new_tets[i - p.removed.size()];
    ws.slots.push_back(slot);
    mesh.set_points(slot, points);
    mesh.set_region(slot, n.region);
    mesh.set_quality(slot, n.quality);
    for (int f = 0; f < 4; ++f)
      ws.sides.push_back(
          {sorted_face(points, f).vertices, slot, static_cast<std::uint8_t>(f), n.region, 0, false, false});
  }
  for (std::size_t i = p.added.size(); i < p.removed.size(); ++i) mesh.set_points(p.removed[i], dead_tet);
}

/// The added interface triangle with these points; null: there is none.
const SurfaceGrid::Added* find_added(const Proposal& p, const Triangle& key) {
  for (const SurfaceGrid::Added& a : p.edit.added) {
    Triangle ids = a.triangle.ids;
    std::replace(ids.begin(), ids.end(), unnumbered_point, p.new_point_id);
    std::sort(ids.begin(), ids.end());
    if (ids == key) return &a;
  }
  return nullptr;
}

/// Patch of a new boundary face.
PatchId patch_of_added(const Proposal& p, const Triangle& key) {
  const SurfaceGrid::Added* added = find_added(p, key);
  TETWRIGHT_CHECK(added != nullptr);  // else a hole would open
  return added->patch;
}

/// Whether a face between two tets of the cavity is an interface after the proposal.
bool is_interface_within(const Proposal& p, const CommitWorkspace::Side& x, const CommitWorkspace::Side& y,
                         bool adds_sheet) {
  if (x.region != y.region) return true;
  if (y.outer) return y.interface;
  return adds_sheet && find_added(p, x.key) != nullptr;
}

void link_sides(EditableMesh& mesh, const Proposal& p, CommitWorkspace& ws) {
  auto& sides = ws.sides;
  using Side = CommitWorkspace::Side;
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return x.key != y.key ? x.key < y.key : x.outer != y.outer ? y.outer : x.tet < y.tet;
  });
  const bool adds_sheet = std::any_of(p.edit.added.begin(), p.edit.added.end(),
                                      [](const SurfaceGrid::Added& a) { return a.is_sheet(); });
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& x = sides[i];
    if (i + 1 < sides.size() && x.key == sides[i + 1].key) {
      const Side& y = sides[++i];
      if (y.tet != no_index) {
        const bool interface = is_interface_within(p, x, y, adds_sheet);
        mesh.set_link(x.tet, x.face, FaceLink::to(y.tet, interface));
        mesh.set_link(y.tet, y.face, FaceLink::to(x.tet, interface));
      } else {
        mesh.set_link(x.tet, x.face, FaceLink::outside(y.patch));
      }
    } else if (!x.outer) {
      mesh.set_link(x.tet, x.face, FaceLink::outside(patch_of_added(p, x.key)));
    } else {
      TETWRIGHT_CHECK(x.tet == no_index);  // else a hole would open
    }
  }
}

void commit_replace(EditableMesh& mesh, const Proposal& p, CommitWorkspace& ws) {
  ws.sides.clear();
  ws.slots.clear();
  if (p.has_new_point) mesh.set_position(p.new_point_id, p.position);
  write_tets(mesh, p, ws);
  for (const Proposal::HullFace& f : p.hull)
    ws.sides.push_back({f.key, f.tet, f.face, f.region, f.patch, true, f.interface});
  link_sides(mesh, p, ws);
  const auto first_with = [&](Index point) {
    for (std::size_t i = 0; i < p.added.size(); ++i)
      for (Index q : p.added[i].points)
        if (q == point) return ws.slots[i];
    return no_index;
  };
  for (Index point : p.orphans) mesh.set_incident_tet(point, first_with(point));
  if (p.has_new_point) mesh.set_incident_tet(p.new_point_id, first_with(unnumbered_point));
}

}  // namespace

void Proposal::clear() {
  change = Change::none;
  next_stage = -1;
  write_set.clear();
  read_set_size = 0;
  rated.clear();
  relinks.clear();
  incidents.clear();
  removed.clear();
  added.clear();
  has_new_point = false;
  hull.clear();
  orphans.clear();
  edit.clear();
  volumes.clear();
  count_change = 0;
  new_tets.clear();
  new_point_id = no_index;
}

void Proposal::claim_star(const Star& star) {
  write_set.assign(1, star.centre);
  write_set.insert(write_set.end(), star.points.begin(), star.points.end());
  read_set_size = 1;
}

void Proposal::claim_cavity(const EditableMesh& mesh) {
  write_set.clear();
  hull.clear();
  orphans.clear();
  const auto is_removed = [&](Index t) {
    return std::find(removed.begin(), removed.end(), t) != removed.end();
  };
  for (Index t : removed) {
    const Tet& points = mesh.points(t);
    for (Index p : points)
      if (std::find(write_set.begin(), write_set.end(), p) == write_set.end()) {
        write_set.push_back(p);
        if (is_removed(mesh.incident_tet(p))) orphans.push_back(p);
      }
    for (int f = 0; f < 4; ++f) {
      const FaceLink link = mesh.link(t, f);
      if (!link.is_outside() && is_removed(link.tet())) continue;
      const Triangle key = sorted_face(points, f).vertices;
      if (link.is_outside()) {
        hull.push_back({key, no_index, 0, outside_id, link.patch(), true});
        continue;
      }
      const Index across = link.tet();
      // Compare vertices: two tets may share more than one face.
      int back = 0;
      while (back < 4 &&
             (mesh.neighbour(across, back) != t || sorted_face(mesh.points(across), back).vertices != key))
        ++back;
      TETWRIGHT_CHECK(back < 4);  // links are mutual
      hull.push_back(
          {key, across, static_cast<std::uint8_t>(back), mesh.region(across), 0, link.is_interface()});
    }
  }
  read_set_size = write_set.size();
}

void begin_batch(EditableMesh& mesh, std::size_t proposals, std::size_t new_tets, std::size_t new_points) {
  mesh.make_room(new_tets, new_points);
  mesh.reservations().begin_batch(proposals);
}

void grant(EditableMesh& mesh, SurfaceGrid& grid, Proposal& p) {
  if (p.change == Proposal::Change::collapse) {
    for (Index t : p.removed) mesh.free_tets().give_back(t);
    mesh.free_points().give_back(p.centre);
  } else if (p.change == Proposal::Change::replace) {
    for (std::size_t i = p.added.size(); i < p.removed.size(); ++i) mesh.free_tets().give_back(p.removed[i]);
    for (std::size_t i = p.removed.size(); i < p.added.size(); ++i)
      p.new_tets.push_back(mesh.free_tets().take());
    if (p.has_new_point) {
      p.new_point_id = mesh.free_points().take();
      p.write_set.push_back(p.new_point_id);
      for (SurfaceGrid::Added& a : p.edit.added)
        std::replace(a.triangle.ids.begin(), a.triangle.ids.end(), unnumbered_point, p.new_point_id);
    }
  }
  mesh.change_count(p.count_change);
  if (!p.edit.empty()) grid.take_records(p.edit);
  mesh.reservations().claim(p.write_set);
}

void commit(EditableMesh& mesh, SurfaceGrid& grid, const Proposal& p, CommitWorkspace& ws) {
  const WriteRule::Committing rule(p.write_set);
  switch (p.change) {
    case Proposal::Change::none:
      return;
    case Proposal::Change::move:
      commit_move(mesh, p);
      break;
    case Proposal::Change::collapse:
      commit_collapse(mesh, p);
      break;
    case Proposal::Change::replace:
      commit_replace(mesh, p, ws);
      break;
  }
  for (Index point : p.write_set) mesh.touch(point);
  if (!p.edit.empty()) grid.commit(p.edit);
}

void end_batch(EditableMesh& mesh, SurfaceGrid& grid) {
  mesh.free_tets().end_batch();
  mesh.free_points().end_batch();
  grid.end_batch();
}

void commit_alone(EditableMesh& mesh, SurfaceGrid& grid, Proposal& proposal, CommitWorkspace& ws) {
  begin_batch(mesh, 1, proposal.added.size(), proposal.has_new_point);
  grant(mesh, grid, proposal);
  commit(mesh, grid, proposal, ws);
  end_batch(mesh, grid);
}

}  // namespace tetwright
