#include "simplify/operations/insertion.h"

#include <algorithm>

#include "simplify/operations/smoothing.h"

namespace tetwright {

namespace {

/// A new point must gain this factor: it costs tets.
constexpr float min_gain = 1.05f;
/// Tets that a cavity may swallow beyond the first.
constexpr std::size_t max_grown = 24;

Cone cone(const Workspace& ws, const BlockRules& rules, const Vec3& at, Index tet, int slot) {
  const EditableMesh& mesh = ws.mesh;
  const Tet& p = mesh.tet(tet).points;
  const auto& f = tet_faces[slot];
  return {tet, slot,
          rules.objective(at, mesh.position(p[f[0]]), mesh.position(p[f[1]]), mesh.position(p[f[2]]))};
}

/// Builds ws.star of the point that is to be inserted at `at`. False if a point of the old tets would be
/// lost, or the cavity's hull were no surface (which needs inverted tets).
bool star_of_new_point(Workspace& ws, const Vec3& at, const std::vector<Cone>& cones) {
  const EditableMesh& mesh = ws.mesh;
  Star& star = ws.star;
  star.begin(no_index, at);
  for (const Cone& c : cones) {
    const TetRecord& r = mesh.tet(c.tet);
    std::array<std::uint16_t, 3> link;
    for (int k = 0; k < 3; ++k) {
      const Index p = r.points[tet_faces[c.slot][k]];
      link[k] = star.add_point(p, mesh.position(p));
    }
    star.tets.push_back({c.tet, link, static_cast<std::uint8_t>(c.slot), r.region, c.quality});
    star.worst = std::min(star.worst, c.quality);
  }
  std::vector<std::uint32_t>& edges = ws.hull_edges;  // each from both its triangles
  edges.clear();
  for (const Star::StarTet& t : star.tets)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t p = t.link[k], q = t.link[(k + 1) % 3];
      edges.push_back(std::min(p, q) << 16 | std::max(p, q));
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 2; i < edges.size(); ++i)
    if (edges[i] == edges[i - 2]) return false;
  for (Index t : ws.cavity.removed)
    for (Index p : mesh.tet(t).points)
      if (std::find(star.points.begin(), star.points.end(), p) == star.points.end()) return false;
  return true;
}

/// Lets the cavity grow through the faces of the worst new tets, where that makes them better: all tets
/// that the new point sees well may go (as in Klingner & Shewchuk 2007, section 3.3, greedily). False: a lock
/// was taken.
bool grow(Workspace& ws, const BlockRules& rules, const Vec3& at, std::vector<Cone>& cones) {
  const EditableMesh& mesh = ws.mesh;
  std::vector<Index>& removed = ws.cavity.removed;
  std::sort(cones.begin(), cones.end(), [](const Cone& a, const Cone& b) {
    return a.quality != b.quality ? a.quality > b.quality : a.tet != b.tet ? a.tet < b.tet : a.slot < b.slot;
  });
  std::vector<Cone>& fresh = ws.fresh;
  for (std::size_t grown = 0; grown < max_grown && !cones.empty(); ++grown) {
    const Cone worst = cones.back();
    const Index beyond = mesh.neighbour(worst.tet, worst.slot);
    if (beyond == no_index || mesh.tet(beyond).region != mesh.tet(worst.tet).region) return true;
    const int back = mesh.face_towards(beyond, worst.tet);
    if (!ws.lock(mesh.tet(beyond).points[back])) return false;
    fresh.clear();
    std::size_t meets = 0;
    bool better = true;
    for (int f = 0; f < 4 && better; ++f) {
      if (f == back) continue;
      const Index across = mesh.neighbour(beyond, f);
      if (across != no_index && std::find(removed.begin(), removed.end(), across) != removed.end()) {
        // An interface between two parts of the cavity has to stay.
        better = mesh.tet(across).region == mesh.tet(beyond).region;
        ++meets;
        continue;
      }
      fresh.push_back(cone(ws, rules, at, beyond, f));
      better = fresh.back().quality > worst.quality;
    }
    if (!better || fresh.empty()) return true;
    cones.pop_back();
    if (meets > 0)  // those between the cavity and what it swallows now
      std::erase_if(cones, [&](const Cone& c) { return mesh.neighbour(c.tet, c.slot) == beyond; });
    removed.push_back(beyond);
    for (const Cone& c : fresh)
      cones.insert(std::upper_bound(cones.begin(), cones.end(), c,
                                    [](const Cone& x, const Cone& y) { return x.quality > y.quality; }),
                   c);
  }
  return true;
}

/// The star of a point at `at` that takes the place of the `apexes` of the tets of ws.cavity.removed, or of
/// more tets around where the place is free and that is better. done, lock_taken, or link_condition where a
/// point would be lost.
template <class Apexes>
Outcome cone_over(Workspace& ws, const BlockRules& rules, const Vec3& at, InsertionPlace place,
                  const Apexes& apexes) {
  std::vector<Cone>& cones = ws.cones;
  cones.clear();
  for (Index t : ws.cavity.removed)
    for (int slot = 0; slot < 4; ++slot)
      if (apexes(ws.mesh.tet(t).points[slot])) cones.push_back(cone(ws, rules, at, t, slot));
  if (place == InsertionPlace::best) {
    ws.plain = cones;
    ws.plain_cavity = ws.cavity.removed;
    if (!grow(ws, rules, at, cones)) return Outcome::lock_taken;
    if (star_of_new_point(ws, at, cones)) return Outcome::done;
    cones = ws.plain;
    ws.cavity.removed = ws.plain_cavity;
  }
  return star_of_new_point(ws, at, cones) ? Outcome::done : Outcome::link_condition;
}

/// An interface triangle of the mesh as it stands.
MeshTriangle triangle(const EditableMesh& mesh, Index a, Index b, Index c) {
  return {{a, b, c}, {mesh.position(a), mesh.position(b), mesh.position(c)}};
}

/// Puts the point of ws.star into the place of ws.cavity.removed; ws.edit.removed holds the interface
/// triangles that go.
Outcome carry_out(Workspace& ws, const BlockRules& rules, InsertionPlace place) {
  EditableMesh& mesh = ws.mesh;
  float before = 1;
  for (Index t : ws.cavity.removed) before = std::min(before, mesh.tet(t).quality);
  Star& star = ws.star;
  const int dimension = star.dimension();
  // A point on an edge where interface triangles branch stays in the middle.
  Placement& placement = ws.placement;
  const float limit = place == InsertionPlace::best ? min_gain * before : ws.acceptance_limit(rules, before);
  star.compute_gradients();
  bool good = false;
  if (place == InsertionPlace::best && dimension > 0)
    good = find_place(ws, rules, dimension, limit, placement);
  if (!good) {
    if (!(star.worst > limit)) return Outcome::quality;
    placement.position = star.centre_position;
    placement.qualities.clear();
    for (const Star::StarTet& t : star.tets) placement.qualities.push_back(t.quality);
  }
  const std::size_t old_count = ws.cavity.removed.size(), new_count = star.tets.size();
  if (mesh.any_pinned())
    for (Index p : star.points)
      if (mesh.pinned(p)) return Outcome::material_rule;
  if (new_count > old_count && !ws.free_tets.reserve(new_count - old_count)) return Outcome::no_room;
  if (!ws.free_points.reserve(1)) return Outcome::no_room;
  const Index id = ws.free_points.take();
  const auto give_up = [&](Outcome o) {
    ws.cells.release();
    ws.free_points.give_back(id);
    return o;
  };
  if (!ws.lock(id)) return give_up(Outcome::lock_taken);
  ws.edit.added.clear();
  for (const Star::InterfaceTriangle& s : star.interface_triangles)
    ws.edit.added.push_back({{id, star.points[s.first], star.points[s.second]},
                             {placement.position, star.positions[s.first], star.positions[s.second]}});
  if (!star.interface_triangles.empty()) {
    const Outcome o = ws.grid.begin_edit(ws.edit, ws.grid_workspace, ws.cells);
    if (o != Outcome::done) return give_up(o);
  }
  const auto& volumes = star.volume_changes(placement.position - star.centre_position);
  if (!ws.ledger.book(volumes)) return give_up(Outcome::volume);
  if (!mesh.change_count(static_cast<std::int64_t>(new_count) - static_cast<std::int64_t>(old_count),
                         rules.min_tets, rules.max_tets)) {
    ws.ledger.take_back(volumes);
    return give_up(Outcome::count);
  }
  mesh.set_position(id, placement.position);
  ws.cavity.added.clear();
  for (std::size_t k = 0; k < star.tets.size(); ++k) {
    const Star::StarTet& t = star.tets[k];
    ws.cavity.added.push_back({{id, star.points[t.link[0]], star.points[t.link[1]], star.points[t.link[2]]},
                               t.region,
                               placement.qualities[k]});
  }
  ws.retriangulation.carry_out(mesh, ws.free_tets, ws.cavity);
  if (!star.interface_triangles.empty()) {
    ws.grid.commit(ws.edit, ws.grid_workspace);
    ws.cells.release();
  }
  return Outcome::done;
}

Outcome try_face(Workspace& ws, const BlockRules& rules, Index tet, int face, InsertionPlace place) {
  const EditableMesh& mesh = ws.mesh;
  const TetRecord& r = mesh.tet(tet);
  const RegionId across = mesh.region_across(tet, face);
  if (across == r.region) return Outcome::no_candidate;
  const auto& c = tet_faces[face];
  const Triangle ids{r.points[c[0]], r.points[c[1]], r.points[c[2]]};
  ws.cavity.clear();
  ws.cavity.removed.push_back(tet);
  if (const Index other = r.neighbours[face]; other != no_index) {
    if (!ws.lock(mesh.tet(other).points[mesh.face_towards(other, tet)])) return Outcome::lock_taken;
    ws.cavity.removed.push_back(other);
  }
  const Vec3 at = mesh.snap((mesh.position(ids[0]) + mesh.position(ids[1]) + mesh.position(ids[2])) / 3);
  const Outcome o =
      cone_over(ws, rules, at, place, [&](Index p) { return p == ids[0] || p == ids[1] || p == ids[2]; });
  if (o != Outcome::done) return o;
  for (int k = 0; k < 3; ++k) ws.star.add_interface_triangle(ids[k], ids[(k + 1) % 3], r.region, across);
  ws.edit.removed.assign(1, triangle(mesh, ids[0], ids[1], ids[2]));
  return carry_out(ws, rules, place);
}

Outcome try_edge(Workspace& ws, const BlockRules& rules, Index tet, int edge, InsertionPlace place,
                 bool interior) {
  const EditableMesh& mesh = ws.mesh;
  EdgeRing& ring = ws.ring;
  if (const Outcome o = ring.gather(mesh, tet, edge, ws.points); o != Outcome::done) return o;
  if (!interior && ring.interface_triangles == 0) return Outcome::no_candidate;
  if (!ring.closed && !ws.walk.is_whole(ws.mesh, ring)) return Outcome::material_rule;
  ws.cavity.clear();
  ws.cavity.removed = ring.tets;
  const Vec3 at = mesh.snap((mesh.position(ring.a) + mesh.position(ring.b)) / 2);
  if (const Outcome o = cone_over(ws, rules, at, place, [&](Index p) { return p == ring.a || p == ring.b; });
      o != Outcome::done)
    return o;
  ws.edit.removed.clear();
  const std::size_t n = ring.tets.size();
  const auto interface_triangle = [&](Index p, RegionId inside, RegionId across) {
    ws.star.add_interface_triangle(ring.a, p, inside, across);
    ws.star.add_interface_triangle(p, ring.b, inside, across);
    ws.edit.removed.push_back(triangle(mesh, ring.a, ring.b, p));
  };
  if (!ring.closed) {
    interface_triangle(ring.points.front(), ring.regions.front(), outside_id);
    interface_triangle(ring.points.back(), ring.regions.back(), outside_id);
  }
  for (std::size_t i = ring.closed ? 0 : 1; i < n; ++i) {
    const RegionId before = ring.regions[(i + n - 1) % n];
    if (before != ring.regions[i]) interface_triangle(ring.points[i], ring.regions[i], before);
  }
  return carry_out(ws, rules, place);
}

}  // namespace

Outcome insert_in_tet(Workspace& ws, const BlockRules& rules, Index tet, InsertionPlace place) {
  const EditableMesh& mesh = ws.mesh;
  const TetRecord& r = mesh.tet(tet);
  ws.cavity.clear();
  ws.cavity.removed.push_back(tet);
  const Vec3 at = mesh.snap((mesh.position(r.points[0]) + mesh.position(r.points[1]) +
                             mesh.position(r.points[2]) + mesh.position(r.points[3])) /
                            4);
  Outcome o = cone_over(ws, rules, at, place, [](Index) { return true; });
  ws.edit.removed.clear();
  if (o == Outcome::done) o = carry_out(ws, rules, place);
  ws.counts.add(Operation::insert_in_tet, o);
  return o;
}

Outcome insert_in_face(Workspace& ws, const BlockRules& rules, Index tet, int face, InsertionPlace place) {
  const Outcome o = try_face(ws, rules, tet, face, place);
  ws.counts.add(Operation::insert_in_face, o);
  return o;
}

Outcome insert_in_edge(Workspace& ws, const BlockRules& rules, Index tet, int edge, InsertionPlace place,
                       bool interior) {
  const Outcome o = try_edge(ws, rules, tet, edge, place, interior);
  ws.counts.add(Operation::insert_in_edge, o);
  return o;
}

}  // namespace tetwright
