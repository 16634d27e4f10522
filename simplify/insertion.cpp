#include "simplify/insertion.h"

#include <algorithm>

#include "simplify/refill.h"
#include "simplify/smoothing.h"

namespace tetwright {

namespace {

/// A new point must gain this factor: it costs tets.
constexpr float least_gain = 1.05f;

/// Builds task.star of the point that is to be inserted at `at` into the tets of task.cavity.removed, one tet
/// for each pair of an old tet and its face opposite one of the `apexes` (those of the old tet's points that
/// the new one takes the place of).
template <class Apexes>
void star_of_new_point(Task& task, const BlockRules& rules, const Vec3& at, const Apexes& apexes) {
  const EditableMesh& mesh = task.mesh;
  Star& star = task.star;
  star.begin(no_index, at);
  for (Index t : task.cavity.removed) {
    const TetRecord& r = mesh.tet(t);
    for (int slot = 0; slot < 4; ++slot) {
      if (!apexes(r.points[slot])) continue;
      std::array<std::uint16_t, 3> link;
      for (int k = 0; k < 3; ++k) {
        const Index p = r.points[tet_faces[slot][k]];
        link[k] = star.add_point(p, mesh.position(p));
      }
      const float quality =
          rules.objective(at, star.positions[link[0]], star.positions[link[1]], star.positions[link[2]]);
      star.tets.push_back({t, link, static_cast<std::uint8_t>(slot), r.region, quality});
      star.poorest = std::min(star.poorest, quality);
    }
  }
}

/// An interface triangle of the mesh as it stands.
MeshTriangle triangle(const EditableMesh& mesh, Index a, Index b, Index c) {
  return {{a, b, c}, {mesh.position(a), mesh.position(b), mesh.position(c)}};
}

/// Puts the point of task.star into the place of task.cavity.removed; task.edit.removed holds the interface
/// triangles that go.
Outcome carry_out(Task& task, const BlockRules& rules, InsertionPlace place, float before) {
  EditableMesh& mesh = task.mesh;
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
  if (!task.slots.reserve(new_count - old_count)) return Outcome::no_room;
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
  if (!mesh.change_count(static_cast<std::int64_t>(new_count - old_count), rules.fewest_tets,
                         rules.most_tets))
    return give_up(Outcome::count);
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
  float before = r.quality;
  if (const Index other = r.neighbours[face]; other != no_index) {
    if (!hold_point(task, mesh.tet(other).points[mesh.face_towards(other, tet)])) return Outcome::lock_taken;
    task.cavity.removed.push_back(other);
    before = std::min(before, mesh.tet(other).quality);
  }
  const Vec3 at = mesh.snap((mesh.position(ids[0]) + mesh.position(ids[1]) + mesh.position(ids[2])) / 3);
  star_of_new_point(task, rules, at, [&](Index p) { return p == ids[0] || p == ids[1] || p == ids[2]; });
  for (int k = 0; k < 3; ++k) task.star.add_sheet(ids[k], ids[(k + 1) % 3], r.region, across);
  task.edit.removed.assign(1, triangle(mesh, ids[0], ids[1], ids[2]));
  return carry_out(task, rules, place, before);
}

Outcome try_edge(Task& task, const BlockRules& rules, Index tet, int edge, InsertionPlace place,
                 bool interior) {
  const EditableMesh& mesh = task.mesh;
  EdgeRing& ring = task.ring;
  if (const Outcome o = ring.gather(mesh, tet, edge, task.points); o != Outcome::done) return o;
  if (!interior && ring.sheets == 0) return Outcome::no_candidate;
  task.cavity.clear();
  task.cavity.removed = ring.tets;
  const Vec3 at = mesh.snap((mesh.position(ring.a) + mesh.position(ring.b)) / 2);
  star_of_new_point(task, rules, at, [&](Index p) { return p == ring.a || p == ring.b; });
  task.edit.removed.clear();
  const std::size_t n = ring.tets.size();
  const auto sheet = [&](Index p, Region inside, Region across) {
    task.star.add_sheet(ring.a, p, inside, across);
    task.star.add_sheet(p, ring.b, inside, across);
    task.edit.removed.push_back(triangle(mesh, ring.a, ring.b, p));
  };
  if (!ring.closed) {
    sheet(ring.points.front(), ring.regions.front(), outside_region);
    sheet(ring.points.back(), ring.regions.back(), outside_region);
  }
  for (std::size_t i = ring.closed ? 0 : 1; i < n; ++i) {
    const Region before = ring.regions[(i + n - 1) % n];
    if (before != ring.regions[i]) sheet(ring.points[i], ring.regions[i], before);
  }
  return carry_out(task, rules, place, ring.poorest);
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
  star_of_new_point(task, rules, at, [](Index) { return true; });
  task.edit.removed.clear();
  const Outcome o = carry_out(task, rules, place, r.quality);
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
