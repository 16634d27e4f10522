#include "simplify/operations/face_removal.h"

#include <algorithm>

namespace tetwright {

namespace {

/// Chooses the faces between the points `a` and `b` that go.
class FaceTree {
 public:
  FaceTree(Workspace& ws, const BlockRules& rules, Index a, Index b, RegionId region, std::size_t max_faces)
      : added(ws.cavity.added),
        removed(ws.cavity.removed),
        ws_(ws),
        mesh_(ws.mesh),
        rules_(rules),
        a_(a),
        b_(b),
        region_(region),
        max_faces_(max_faces) {}

  /// For the tets at both sides of a chosen face and its edge from x to y: the value of the best tets that
  /// end there. (a, b, x, y) is listed as a positive tet where it is one.
  float grow(Index x, Index y, Index tet_a, Index tet_b) {
    const NewTet plain{{a_, b_, x, y}, region_, quality_of(mesh_, rules_, {a_, b_, x, y})};
    if (faces_ >= max_faces_) return keep(plain);
    // The tets beyond the edge, on both sides, and their common point.
    const Index next_a = across(tet_a, x, y, a_), next_b = across(tet_b, x, y, b_);
    if (next_a == no_index || next_b == no_index || next_a == next_b) return keep(plain);
    const TetRecord &ra = mesh_.tet(next_a), &rb = mesh_.tet(next_b);
    if (ra.region != region_ || rb.region != region_) return keep(plain);
    const Index w = fourth(ra.points, a_, x, y);
    if (w == no_index || w != fourth(rb.points, b_, x, y)) return keep(plain);
    // Only where they are poor themselves, or stand in the way.
    if (std::find(removed.begin(), removed.end(), next_a) != removed.end()) return keep(plain);
    if (!ws_.lock(w)) {
      lock_taken = true;
      return 0;
    }
    const std::size_t added_before = added.size(), removed_before = removed.size(), faces_before = faces_;
    removed.push_back(next_a);
    removed.push_back(next_b);
    ++faces_;
    const float first = grow(x, w, next_a, next_b);
    const float value = first > plain.quality ? std::min(first, grow(w, y, next_a, next_b)) : first;
    if (value > plain.quality) return value;
    added.resize(added_before);
    removed.resize(removed_before);
    faces_ = faces_before;
    return keep(plain);
  }

  std::vector<NewTet>& added;
  std::vector<Index>& removed;
  bool lock_taken = false;

 private:
  float keep(const NewTet& t) {
    added.push_back(t);
    return t.quality;
  }
  /// The neighbour of t across its face with x, y and apex.
  Index across(Index t, Index x, Index y, Index apex) const {
    const TetRecord& r = mesh_.tet(t);
    for (int k = 0; k < 4; ++k)
      if (r.points[k] != x && r.points[k] != y && r.points[k] != apex) return r.neighbours[k];
    return no_index;
  }
  static Index fourth(const Tet& t, Index p, Index q, Index r) {
    for (Index i : t)
      if (i != p && i != q && i != r) return i;
    return no_index;
  }

  Workspace& ws_;
  const EditableMesh& mesh_;
  const BlockRules& rules_;
  Index a_, b_;
  RegionId region_;
  std::size_t max_faces_;
  std::size_t faces_ = 1;
};

Outcome try_remove(Workspace& ws, const BlockRules& rules, Index tet, int face, const FlipReach& reach,
                   Operation& kind) {
  EditableMesh& mesh = ws.mesh;
  const TetRecord& first = mesh.tet(tet);
  const Index other = first.neighbours[face];
  if (other == no_index) return Outcome::no_candidate;
  const TetRecord& second = mesh.tet(other);
  if (second.region != first.region) return Outcome::material_rule;
  const Index a = first.points[face], b = second.points[mesh.face_towards(other, tet)];
  if (a == b) return Outcome::link_condition;
  if (!ws.lock(b)) return Outcome::lock_taken;

  // The face is listed outward from `tet`, towards b: (a, b, ring[i], ring[i + 1]) are positive where they
  // can be.
  const auto& c = tet_faces[face];
  const Triangle ring{first.points[c[0]], first.points[c[1]], first.points[c[2]]};
  ws.cavity.clear();
  FaceTree tree(ws, rules, a, b, first.region, reach.basic() ? 1 : reach.max_faces);
  tree.removed = {tet, other};
  float worst = 1;
  const float worst_before = std::min(first.quality, second.quality);
  for (int i = 0; i < 3; ++i) {
    worst = std::min(worst, tree.grow(ring[i], ring[(i + 1) % 3], tet, other));
    if (tree.lock_taken) return Outcome::lock_taken;
    if (worst <= 0 || (worst <= worst_before && rules.accept_worse == 0)) return Outcome::quality;
  }
  const std::vector<Index>& removed = ws.cavity.removed;
  if (removed.size() > 2) kind = Operation::face_removal;
  float before = 1;
  for (Index t : removed) before = std::min(before, mesh.tet(t).quality);
  if (!(worst > ws.acceptance_limit(rules, before))) return Outcome::quality;
  if (mesh.any_pinned())
    for (const NewTet& t : ws.cavity.added)
      for (Index p : t.points)
        if (mesh.pinned(p)) return Outcome::material_rule;
  if (ws.walk.joined(ws.mesh, b, a)) return Outcome::link_condition;
  const std::size_t added = ws.cavity.added.size();
  if (added > removed.size() && !ws.free_tets.reserve(added - removed.size())) return Outcome::no_room;
  if (!mesh.change_count(static_cast<std::int64_t>(added) - static_cast<std::int64_t>(removed.size()),
                         rules.min_tets, rules.max_tets))
    return Outcome::count;
  ws.retriangulation.carry_out(mesh, ws.free_tets, ws.cavity);
  return Outcome::done;
}

}  // namespace

Outcome remove_face(Workspace& ws, const BlockRules& rules, Index tet, int face, const FlipReach& reach) {
  Operation kind = Operation::flip23;
  const Outcome o = try_remove(ws, rules, tet, face, reach, kind);
  ws.counts.add(kind, o);
  return o;
}

}  // namespace tetwright
