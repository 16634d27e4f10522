// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/face_removal.h"

#include <algorithm>

namespace tetwright {

namespace {

/// Chooses the faces to remove between the apices `a` and `b`.
class FaceTree {
 public:
  FaceTree(Workspace& ws, const BlockRules& rules, Index a, Index b, RegionId region, std::size_t max_faces)
      : added(ws.proposal.added),
        removed(ws.proposal.removed),
        mesh_(ws.mesh),
        rules_(rules),
        a_(a),
        b_(b),
        region_(region),
        max_faces_(max_faces) {}

  /// Extends the removal across the edge xy of a chosen face, if that is better than ending there with the
  /// tet (a, b, x, y).
  ///
  /// \param tet_a, tet_b the tets on the two sides of the chosen face.
  /// \return quality of the worst tet of the better alternative.
  float grow(Index x, Index y, Index tet_a, Index tet_b) {
    const NewTet plain{{a_, b_, x, y}, region_, quality_of(mesh_, rules_, {a_, b_, x, y})};
    if (faces_ >= max_faces_) return keep(plain);
    // The tets beyond the edge on both sides, and their common point.
    const FaceLink link_a = across(tet_a, x, y, a_), link_b = across(tet_b, x, y, b_);
    if (link_a.is_interface() || link_b.is_interface()) return keep(plain);
    const Index next_a = link_a.tet(), next_b = link_b.tet();
    if (next_a == next_b) return keep(plain);
    const Index w = fourth(mesh_.points(next_a), a_, x, y);
    if (w == no_index || w != fourth(mesh_.points(next_b), b_, x, y)) return keep(plain);
    // The face between them would vanish.
    if (across(next_a, x, y, w).is_interface()) return keep(plain);
    // A tet already removed ends the recursion.
    if (std::find(removed.begin(), removed.end(), next_a) != removed.end()) return keep(plain);
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

 private:
  float keep(const NewTet& t) {
    added.push_back(t);
    return t.quality;
  }
  /// Link of t across its face (x, y, apex).
  FaceLink across(Index t, Index x, Index y, Index apex) const {
    const Tet& p = mesh_.points(t);
    for (int k = 0; k < 4; ++k)
      if (p[k] != x && p[k] != y && p[k] != apex) return mesh_.link(t, k);
    return {};
  }
  static Index fourth(const Tet& t, Index p, Index q, Index r) {
    for (Index i : t)
      if (i != p && i != q && i != r) return i;
    return no_index;
  }

  const EditableMesh& mesh_;
  const BlockRules& rules_;
  Index a_, b_;
  RegionId region_;
  std::size_t max_faces_;
  std::size_t faces_ = 1;
};

Outcome try_remove(Workspace& ws, const BlockRules& rules, Index tet, int face, const FlipReach& reach,
                   Operation& kind) {
  const EditableMesh& mesh = ws.mesh;
  const FaceLink link = mesh.link(tet, face);
  if (link.is_outside()) return Outcome::no_candidate;
  if (link.is_interface()) return Outcome::material_rule;
  const Index other = link.tet();
  const Tet& first = mesh.points(tet);
  const Index a = first[face], b = mesh.points(other)[mesh.face_towards(other, tet)];
  if (a == b) return Outcome::link_condition;

  // The face is oriented outwards from `tet`, towards b: the tets (a, b, ring[i], ring[i + 1]) are positive
  // where that is possible.
  const Triangle ring = face_of(first, face);
  Proposal& proposal = ws.proposal;
  proposal.added.clear();
  FaceTree tree(ws, rules, a, b, mesh.region(tet), reach.basic() ? 1 : reach.max_faces);
  tree.removed = {tet, other};
  float worst = 1;
  const float worst_before = std::min(mesh.quality(tet), mesh.quality(other));
  for (int i = 0; i < 3; ++i) {
    worst = std::min(worst, tree.grow(ring[i], ring[(i + 1) % 3], tet, other));
    if (worst <= 0 || (worst <= worst_before && rules.acceptance.worse_probability == 0))
      return Outcome::quality;
  }
  const std::vector<Index>& removed = proposal.removed;
  if (removed.size() > 2) kind = Operation::face_removal;
  float before = 1;
  for (Index t : removed) before = std::min(before, mesh.quality(t));
  if (!(worst > ws.acceptance_limit(rules, before))) return Outcome::quality;
  if (std::any_of(removed.begin(), removed.end(), [&](Index t) { return mesh.frozen_tet(t); }))
    return Outcome::material_rule;
  if (ws.walk.joined(mesh, b, a)) return Outcome::link_condition;
  proposal.change = Proposal::Change::replace;
  proposal.has_new_point = false;
  proposal.edit.clear();
  proposal.volumes.clear();
  proposal.claim_cavity(mesh);
  return ws.within_bounds(
      rules, static_cast<std::int64_t>(proposal.added.size()) - static_cast<std::int64_t>(removed.size()));
}

}  // namespace

Outcome remove_face(Workspace& ws, const BlockRules& rules, Index tet, int face, const FlipReach& reach) {
  Operation kind = Operation::flip23;
  const Outcome o = try_remove(ws, rules, tet, face, reach, kind);
  return ws.count(kind, o);
}

}  // namespace tetwright
