#include "simplify/insertion.h"

#include <algorithm>

#include "simplify/refill.h"
#include "simplify/smoothing.h"

namespace tetwright {

namespace {

/// A new point must gain this factor: it costs tets.
constexpr float least_gain = 1.05f;
/// Tets that a cavity may swallow beyond the first.
constexpr std::size_t most_grown = 24;

/// A new tet: the new point over the face of an old tet opposite its vertex `slot`.
struct Cone {
  Index tet;
  int slot;
  float quality;
};

Cone cone(const Task& task, const BlockRules& rules, const Vec3& at, Index tet, int slot) {
  const EditableMesh& mesh = task.mesh;
  const Tet& p = mesh.tet(tet).points;
  const auto& f = tet_faces[slot];
  return {tet, slot,
          rules.objective(at, mesh.position(p[f[0]]), mesh.position(p[f[1]]), mesh.position(p[f[2]]))};
}

/// Builds task.star of the point that is to be inserted at `at`. False if a point of the old tets would be
/// lost, or the cavity's hull were no surface (which needs inverted tets).
bool star_of_new_point(Task& task, const Vec3& at, const std::vector<Cone>& cones) {
  const EditableMesh& mesh = task.mesh;
  Star& star = task.star;
  star.begin(no_index, at);
  for (const Cone& c : cones) {
    const TetRecord& r = mesh.tet(c.tet);
    std::array<std::uint16_t, 3> link;
    for (int k = 0; k < 3; ++k) {
      const Index p = r.points[tet_faces[c.slot][k]];
      link[k] = star.add_point(p, mesh.position(p));
    }
    star.tets.push_back({c.tet, link, static_cast<std::uint8_t>(c.slot), r.region, c.quality});
    star.poorest = std::min(star.poorest, c.quality);
  }
  thread_local std::vector<std::uint32_t> edges;  // of the hull, each from both its triangles
  edges.clear();
  for (const Star::StarTet& t : star.tets)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t p = t.link[k], q = t.link[(k + 1) % 3];
      edges.push_back(std::min(p, q) << 16 | std::max(p, q));
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 2; i < edges.size(); ++i)
    if (edges[i] == edges[i - 2]) return false;
  for (Index t : task.cavity.removed)
    for (Index p : mesh.tet(t).points)
      if (std::find(star.points.begin(), star.points.end(), p) == star.points.end()) return false;
  return true;
}

/// Lets the cavity grow through the faces of the poorest new tets, where that makes them better: all tets
/// that the new point sees well may go (as in Klingner & Shewchuk 2007, section 3.3, greedily). False: a lock
/// was taken.
bool grow(Task& task, const BlockRules& rules, const Vec3& at, std::vector<Cone>& cones) {
  const EditableMesh& mesh = task.mesh;
  std::vector<Index>& removed = task.cavity.removed;
  std::sort(cones.begin(), cones.end(), [](const Cone& a, const Cone& b) {
    return a.quality != b.quality ? a.quality > b.quality : a.tet != b.tet ? a.tet < b.tet : a.slot < b.slot;
  });
  thread_local std::vector<Cone> fresh;
  for (std::size_t grown = 0; grown < most_grown && !cones.empty(); ++grown) {
    const Cone worst = cones.back();
    const Index beyond = mesh.neighbour(worst.tet, worst.slot);
    if (beyond == no_index || mesh.tet(beyond).region != mesh.tet(worst.tet).region) return true;
    const int back = mesh.face_towards(beyond, worst.tet);
    if (!hold_point(task, mesh.tet(beyond).points[back])) return false;
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
      fresh.push_back(cone(task, rules, at, beyond, f));
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

/// The star of a point at `at` that takes the place of the `apexes` of the tets of task.cavity.removed, or of
/// more tets around where the place is free and that is better. done, lock_taken, or link_condition where a
/// point would be lost.
template <class Apexes>
Outcome cone_over(Task& task, const BlockRules& rules, const Vec3& at, InsertionPlace place,
                  const Apexes& apexes) {
  thread_local std::vector<Cone> cones, plain;
  thread_local std::vector<Index> old;
  cones.clear();
  for (Index t : task.cavity.removed)
    for (int slot = 0; slot < 4; ++slot)
      if (apexes(task.mesh.tet(t).points[slot])) cones.push_back(cone(task, rules, at, t, slot));
  if (place == InsertionPlace::best) {
    plain = cones;
    old = task.cavity.removed;
    if (!grow(task, rules, at, cones)) return Outcome::lock_taken;
    if (star_of_new_point(task, at, cones)) return Outcome::done;
    cones = plain;
    task.cavity.removed = old;
  }
  return star_of_new_point(task, at, cones) ? Outcome::done : Outcome::link_condition;
}

/// An interface triangle of the mesh as it stands.
MeshTriangle triangle(const EditableMesh& mesh, Index a, Index b, Index c) {
  return {{a, b, c}, {mesh.position(a), mesh.position(b), mesh.position(c)}};
}

/// Puts the point of task.star into the place of task.cavity.removed; task.edit.removed holds the interface
/// triangles that go.
Outcome carry_out(Task& task, const BlockRules& rules, InsertionPlace place) {
  EditableMesh& mesh = task.mesh;
  float before = 1;
  for (Index t : task.cavity.removed) before = std::min(before, mesh.tet(t).quality);
  Star& star = task.star;
  const int dimension = star.dimension();
  // A point on an edge where sheets branch stays in the middle.
  Placement placement;
  const float limit =
      place == InsertionPlace::best ? least_gain * before : acceptance_limit(task, rules, before);
  star.compute_gradients();
  bool good = false;
  if (place == InsertionPlace::best && dimension > 0)
    good = find_place(star, mesh, rules, dimension, limit, placement);
  if (!good) {
    if (!(star.poorest > limit)) return Outcome::quality;
    placement.position = star.centre_position;
    placement.qualities.clear();
    for (const Star::StarTet& t : star.tets) placement.qualities.push_back(t.quality);
  }
  const std::size_t old_count = task.cavity.removed.size(), new_count = star.tets.size();
  if (mesh.any_pinned())
    for (Index p : star.points)
      if (mesh.pinned(p)) return Outcome::material_rule;
  if (new_count > old_count && !task.slots.reserve(new_count - old_count)) return Outcome::no_room;
  const Index id = task.point_slots.take();
  if (id == no_index) return Outcome::no_room;
  const auto give_up = [&](Outcome o) {
    task.cells.release();
    task.point_slots.give_back(id);
    return o;
  };
  if (!hold_point(task, id)) return give_up(Outcome::lock_taken);
  task.edit.added.clear();
  for (const Star::Sheet& s : star.sheets)
    task.edit.added.push_back({{id, star.points[s.first], star.points[s.second]},
                               {placement.position, star.positions[s.first], star.positions[s.second]}});
  if (!star.sheets.empty()) {
    const Outcome o = task.grid.prepare(task.edit, task.grid_task, task.cells);
    if (o != Outcome::done) return give_up(o);
  }
  const auto& volumes = star.volume_changes(placement.position - star.centre_position);
  if (!task.ledger.book(volumes)) return give_up(Outcome::volume);
  if (!mesh.change_count(static_cast<std::int64_t>(new_count) - static_cast<std::int64_t>(old_count),
                         rules.fewest_tets, rules.most_tets)) {
    task.ledger.take_back(volumes);
    return give_up(Outcome::count);
  }
  mesh.set_position(id, placement.position);
  task.cavity.added.clear();
  for (std::size_t k = 0; k < star.tets.size(); ++k) {
    const Star::StarTet& t = star.tets[k];
    task.cavity.added.push_back({{id, star.points[t.link[0]], star.points[t.link[1]], star.points[t.link[2]]},
                                 t.region,
                                 placement.qualities[k]});
  }
  refill(task, task.cavity);
  if (!star.sheets.empty()) {
    task.grid.commit(task.edit, task.grid_task);
    task.cells.release();
  }
  return Outcome::done;
}

Outcome try_face(Task& task, const BlockRules& rules, Index tet, int face, InsertionPlace place) {
  const EditableMesh& mesh = task.mesh;
  const TetRecord& r = mesh.tet(tet);
  const Region across = mesh.region_across(tet, face);
  if (across == r.region) return Outcome::no_candidate;
  const auto& c = tet_faces[face];
  const Triangle ids{r.points[c[0]], r.points[c[1]], r.points[c[2]]};
  task.cavity.clear();
  task.cavity.removed.push_back(tet);
  if (const Index other = r.neighbours[face]; other != no_index) {
    if (!hold_point(task, mesh.tet(other).points[mesh.face_towards(other, tet)])) return Outcome::lock_taken;
    task.cavity.removed.push_back(other);
  }
  const Vec3 at = mesh.snap((mesh.position(ids[0]) + mesh.position(ids[1]) + mesh.position(ids[2])) / 3);
  const Outcome o =
      cone_over(task, rules, at, place, [&](Index p) { return p == ids[0] || p == ids[1] || p == ids[2]; });
  if (o != Outcome::done) return o;
  for (int k = 0; k < 3; ++k) task.star.add_sheet(ids[k], ids[(k + 1) % 3], r.region, across);
  task.edit.removed.assign(1, triangle(mesh, ids[0], ids[1], ids[2]));
  return carry_out(task, rules, place);
}

Outcome try_edge(Task& task, const BlockRules& rules, Index tet, int edge, InsertionPlace place,
                 bool interior) {
  const EditableMesh& mesh = task.mesh;
  EdgeRing& ring = task.ring;
  if (const Outcome o = ring.gather(mesh, tet, edge, task.points); o != Outcome::done) return o;
  if (!interior && ring.sheets == 0) return Outcome::no_candidate;
  if (!ring.closed && !whole_ring(task)) return Outcome::material_rule;
  task.cavity.clear();
  task.cavity.removed = ring.tets;
  const Vec3 at = mesh.snap((mesh.position(ring.a) + mesh.position(ring.b)) / 2);
  if (const Outcome o =
          cone_over(task, rules, at, place, [&](Index p) { return p == ring.a || p == ring.b; });
      o != Outcome::done)
    return o;
  task.edit.removed.clear();
  const std::size_t n = ring.tets.size();
  const auto sheet = [&](Index p, Region inside, Region across) {
    task.star.add_sheet(ring.a, p, inside, across);
    task.star.add_sheet(p, ring.b, inside, across);
    task.edit.removed.push_back(triangle(mesh, ring.a, ring.b, p));
  };
  if (!ring.closed) {
    sheet(ring.points.front(), ring.regions.front(), beyond_mesh);
    sheet(ring.points.back(), ring.regions.back(), beyond_mesh);
  }
  for (std::size_t i = ring.closed ? 0 : 1; i < n; ++i) {
    const Region before = ring.regions[(i + n - 1) % n];
    if (before != ring.regions[i]) sheet(ring.points[i], ring.regions[i], before);
  }
  return carry_out(task, rules, place);
}

}  // namespace

Outcome insert_in_tet(Task& task, const BlockRules& rules, Index tet, InsertionPlace place) {
  const EditableMesh& mesh = task.mesh;
  const TetRecord& r = mesh.tet(tet);
  task.cavity.clear();
  task.cavity.removed.push_back(tet);
  const Vec3 at = mesh.snap((mesh.position(r.points[0]) + mesh.position(r.points[1]) +
                             mesh.position(r.points[2]) + mesh.position(r.points[3])) /
                            4);
  Outcome o = cone_over(task, rules, at, place, [](Index) { return true; });
  task.edit.removed.clear();
  if (o == Outcome::done) o = carry_out(task, rules, place);
  task.counts.add(Operation::insert_in_tet, o);
  return o;
}

Outcome insert_in_face(Task& task, const BlockRules& rules, Index tet, int face, InsertionPlace place) {
  const Outcome o = try_face(task, rules, tet, face, place);
  task.counts.add(Operation::insert_in_face, o);
  return o;
}

Outcome insert_in_edge(Task& task, const BlockRules& rules, Index tet, int edge, InsertionPlace place,
                       bool interior) {
  const Outcome o = try_edge(task, rules, tet, edge, place, interior);
  task.counts.add(Operation::insert_in_edge, o);
  return o;
}

}  // namespace tetwright
