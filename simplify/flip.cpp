#include "simplify/flip.h"

#include <algorithm>

namespace tetwright {

namespace {

/// A face of the hull of an operation's old tets, and the tet outside it.
struct OuterFace {
  Triangle points;
  Index beyond;  ///< or no_index
  int back;      ///< face of `beyond` that looks here
};

void add_outer(const EditableMesh& mesh, std::vector<OuterFace>& out, Index tet, int face) {
  const TetRecord& r = mesh.tet(tet);
  const auto& c = tet_faces[face];
  const Index beyond = r.neighbours[face];
  out.push_back({{r.points[c[0]], r.points[c[1]], r.points[c[2]]},
                 beyond,
                 beyond == no_index ? 0 : mesh.face_towards(beyond, tet)});
}

bool same_face(const Tet& t, int face, const Triangle& f) {
  for (int k = 0; k < 4; ++k) {
    if (k == face) continue;
    if (t[k] != f[0] && t[k] != f[1] && t[k] != f[2]) return false;
  }
  return true;
}

/// Links each face of the new tets to another new tet or to what lies beyond, and gives all points a living
/// tet.
void link_new(EditableMesh& mesh, const Index* slots, const Tet* tets, int count,
              const std::vector<OuterFace>& outer) {
  for (int i = 0; i < count; ++i)
    for (int f = 0; f < 4; ++f) {
      bool linked = false;
      for (const OuterFace& o : outer)
        if (same_face(tets[i], f, o.points)) {
          mesh.set_neighbour(slots[i], f, o.beyond);
          if (o.beyond != no_index) mesh.set_neighbour(o.beyond, o.back, slots[i]);
          linked = true;
        }
      for (int j = 0; j < count && !linked; ++j) {
        if (j == i) continue;
        // The neighbour across f has the three points of f.
        int common = 0;
        for (int k = 0; k < 4; ++k)
          if (k != f) common += std::find(tets[j].begin(), tets[j].end(), tets[i][k]) != tets[j].end();
        if (common == 3) {
          mesh.set_neighbour(slots[i], f, slots[j]);
          linked = true;
        }
      }
    }
  for (int i = 0; i < count; ++i)
    for (Index p : tets[i]) mesh.set_hint(p, slots[i]);
}

/// Walks the star of a held point by ids alone; true if `test(tet)` holds for one of its tets.
template <class F>
bool any_in_star(const EditableMesh& mesh, Index point, LocalNumbers& numbers, const F& test) {
  thread_local std::vector<Index> walk;
  numbers.clear();
  walk.clear();
  bool added;
  walk.push_back(mesh.hint(point));
  numbers.number(walk[0], added);
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const Index t = walk[i];
    const TetRecord& r = mesh.tet(t);
    if (test(r.points)) return true;
    for (int k = 0; k < 4; ++k) {
      if (r.points[k] == point || r.neighbours[k] == no_index) continue;
      numbers.number(r.neighbours[k], added);
      if (added) walk.push_back(r.neighbours[k]);
    }
  }
  return false;
}

bool contains(const Tet& t, Index p) { return t[0] == p || t[1] == p || t[2] == p || t[3] == p; }

Outcome lock_point(Task& task, Index p) {
  return task.points.holds(p) || task.points.try_lock(p) ? Outcome::done : Outcome::lock_taken;
}

float quality_of(const EditableMesh& mesh, const BlockRules& rules, const Tet& t) {
  return rules.objective(mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2]), mesh.position(t[3]));
}

}  // namespace

Outcome flip23(Task& task, const BlockRules& rules, Index tet, int face) {
  EditableMesh& mesh = task.mesh;
  const TetRecord& first = mesh.tet(tet);
  const Index other = first.neighbours[face];
  if (other == no_index) return Outcome::no_candidate;
  const TetRecord& second = mesh.tet(other);
  if (second.region != first.region) return Outcome::material_rule;
  const int back = mesh.face_towards(other, tet);
  const Index top = first.points[face], bottom = second.points[back];
  if (const Outcome o = lock_point(task, bottom); o != Outcome::done) return o;

  // Around the new edge; the face is listed outward from `tet`, towards bottom.
  const auto& c = tet_faces[face];
  const Triangle ring{first.points[c[0]], first.points[c[1]], first.points[c[2]]};
  const std::array<Tet, 3> tets{Tet{top, bottom, ring[0], ring[1]}, Tet{top, bottom, ring[1], ring[2]},
                                Tet{top, bottom, ring[2], ring[0]}};
  std::array<float, 3> quality;
  const float before = std::min(first.quality, second.quality);
  for (int i = 0; i < 3; ++i) {
    quality[i] = quality_of(mesh, rules, tets[i]);
    if (quality[i] <= 0) return Outcome::inverts;
    if (!(quality[i] > before)) return Outcome::quality;
  }
  if (any_in_star(mesh, bottom, task.numbers, [&](const Tet& t) { return contains(t, top); }))
    return Outcome::link_condition;
  if (!task.slots.reserve(1)) return Outcome::no_room;

  thread_local std::vector<OuterFace> outer;
  outer.clear();
  for (int f = 0; f < 4; ++f) {
    if (f != face) add_outer(mesh, outer, tet, f);
    if (f != back) add_outer(mesh, outer, other, f);
  }
  const std::array<Index, 3> slots{tet, other, task.slots.take()};
  const Region region = first.region;
  for (int i = 0; i < 3; ++i) {
    mesh.store_points(slots[i], tets[i]);
    mesh.set_region(slots[i], region);
    mesh.set_quality(slots[i], quality[i]);
  }
  link_new(mesh, slots.data(), tets.data(), 3, outer);
  mesh.count_tets(1);
  return Outcome::done;
}

Outcome flip32(Task& task, const BlockRules& rules, Index tet, int edge) {
  EditableMesh& mesh = task.mesh;
  const TetRecord& first = mesh.tet(tet);
  const int i0 = tet_edges[edge][0], i1 = tet_edges[edge][1];
  const int j0 = tet_edges[5 - edge][0], j1 = tet_edges[5 - edge][1];
  const Index low = first.points[i0], high = first.points[i1];
  // The two neighbours at the edge lie opposite the two other points; three around the edge share one more
  // point.
  const Index second = first.neighbours[j0], third = first.neighbours[j1];
  if (second == no_index || third == no_index) return Outcome::no_candidate;
  const TetRecord &s = mesh.tet(second), &u = mesh.tet(third);
  const Index apex = s.points[mesh.face_towards(second, tet)];
  if (u.points[mesh.face_towards(third, tet)] != apex) return Outcome::no_candidate;
  if (std::find(s.neighbours.begin(), s.neighbours.end(), third) == s.neighbours.end())
    return Outcome::no_candidate;
  if (s.region != first.region || u.region != first.region) return Outcome::material_rule;
  if (const Outcome o = lock_point(task, apex); o != Outcome::done) return o;

  const Index p = first.points[j0], q = first.points[j1];
  // (low, high, p, q) is positive or not by the parity of the edge's place; the new tets follow from that.
  const auto parity = [&] {
    const std::array<int, 4> order{i0, i1, j0, j1};
    int swaps = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b) swaps += order[a] > order[b];
    return swaps % 2 == 0;
  };
  const Index x = parity() ? p : q, y = parity() ? q : p;
  const std::array<Tet, 2> tets{Tet{low, apex, x, y}, Tet{high, apex, y, x}};
  std::array<float, 2> quality;
  const float before = std::min({first.quality, s.quality, u.quality});
  for (int i = 0; i < 2; ++i) {
    quality[i] = quality_of(mesh, rules, tets[i]);
    if (quality[i] <= 0) return Outcome::inverts;
    if (!(quality[i] > before)) return Outcome::quality;
  }
  if (any_in_star(mesh, apex, task.numbers, [&](const Tet& t) { return contains(t, p) && contains(t, q); }))
    return Outcome::link_condition;
  if (!mesh.count_down(1, rules.fewest_tets)) return Outcome::count;

  thread_local std::vector<OuterFace> outer;
  outer.clear();
  for (Index t : {tet, second, third})
    for (int f = 0; f < 4; ++f) {
      const Index point = mesh.tet(t).points[f];
      if (point == low || point == high)
        add_outer(mesh, outer, t, f);  // the faces that lack one end of the edge
    }
  const std::array<Index, 2> slots{tet, second};
  const Region region = first.region;
  for (int i = 0; i < 2; ++i) {
    mesh.store_points(slots[i], tets[i]);
    mesh.set_region(slots[i], region);
    mesh.set_quality(slots[i], quality[i]);
  }
  link_new(mesh, slots.data(), tets.data(), 2, outer);
  mesh.store_points(third, {no_index, no_index, no_index, no_index});
  task.slots.give_back(third);
  return Outcome::done;
}

}  // namespace tetwright
