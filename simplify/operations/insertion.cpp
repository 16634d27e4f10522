// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/insertion.h"

#include <algorithm>

#include "simplify/operations/smoothing.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using Insertion = SimplifyTuning::Insertion;

Cone cone(const Workspace& ws, const BlockRules& rules, const Vec3& at, Index tet, int slot) {
  const EditableMesh& mesh = ws.mesh;
  const Triangle f = face_of(mesh.points(tet), slot);
  return {tet, slot, rules.objective(at, mesh.position(f[0]), mesh.position(f[1]), mesh.position(f[2]))};
}

/// Builds the star of a point inserted at `at` in ws.star. False if a point of the old tets would be lost, or
/// if the cavity's hull is not a manifold surface (possible only with inverted tets).
bool star_of_new_point(Workspace& ws, const Vec3& at, const std::vector<Cone>& cones) {
  const EditableMesh& mesh = ws.mesh;
  Star& star = ws.star;
  star.begin(unnumbered_point, at);
  for (const Cone& c : cones) {
    const Triangle face = face_of(mesh.points(c.tet), c.slot);
    std::array<std::uint16_t, 3> link;
    for (int k = 0; k < 3; ++k) link[k] = star.add_point(face[k], mesh.position(face[k]));
    star.tets.push_back({c.tet, link, static_cast<std::uint8_t>(c.slot), mesh.region(c.tet), c.quality});
    star.worst = std::min(star.worst, c.quality);
  }
  std::vector<std::uint32_t>& edges = ws.hull_edges;  // each edge from both its triangles
  edges.clear();
  for (const Star::StarTet& t : star.tets)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t p = t.link[k], q = t.link[(k + 1) % 3];
      edges.push_back(std::min(p, q) << 16 | std::max(p, q));
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 2; i < edges.size(); ++i)
    if (edges[i] == edges[i - 2]) return false;
  for (Index t : ws.proposal.removed)
    for (Index p : mesh.points(t))
      if (std::find(star.points.begin(), star.points.end(), p) == star.points.end()) return false;
  return true;
}

/// Grows the cavity through the faces of the worst new tets while that improves them: all tets that the new
/// point sees well may be removed (as in Klingner & Shewchuk 2007, section 3.3, greedily).
void grow(Workspace& ws, const BlockRules& rules, const Vec3& at, std::vector<Cone>& cones) {
  const EditableMesh& mesh = ws.mesh;
  std::vector<Index>& removed = ws.proposal.removed;
  std::sort(cones.begin(), cones.end(), [](const Cone& a, const Cone& b) {
    return a.quality != b.quality ? a.quality > b.quality : a.tet != b.tet ? a.tet < b.tet : a.slot < b.slot;
  });
  std::vector<Cone>& fresh = ws.fresh;
  for (std::size_t grown = 0; grown < Insertion::max_grown && !cones.empty(); ++grown) {
    const Cone worst = cones.back();
    const FaceLink link = mesh.link(worst.tet, worst.slot);
    if (link.is_interface() || mesh.frozen_tet(link.tet())) return;
    const Index beyond = link.tet();
    const int back = mesh.face_towards(beyond, worst.tet);
    fresh.clear();
    std::size_t meets = 0;
    bool better = true;
    for (int f = 0; f < 4 && better; ++f) {
      if (f == back) continue;
      const Index across = mesh.neighbour(beyond, f);
      if (across != no_index && std::find(removed.begin(), removed.end(), across) != removed.end()) {
        // Do not remove an interface between two parts of the cavity.
        better = !mesh.link(beyond, f).is_interface();
        ++meets;
        continue;
      }
      fresh.push_back(cone(ws, rules, at, beyond, f));
      better = fresh.back().quality > worst.quality;
    }
    if (!better || fresh.empty()) return;
    cones.pop_back();
    if (meets > 0)  // the cones between the cavity and the added tet
      std::erase_if(cones, [&](const Cone& c) { return mesh.neighbour(c.tet, c.slot) == beyond; });
    removed.push_back(beyond);
    for (const Cone& c : fresh)
      cones.insert(std::upper_bound(cones.begin(), cones.end(), c,
                                    [](const Cone& x, const Cone& y) { return x.quality > y.quality; }),
                   c);
  }
}

/// Builds the star of a point at `at` that replaces the `apexes` of the proposal's `removed` tets. With
/// InsertionPlace::best, also removes surrounding tets if that is better.
///
/// \return done; link_condition if a point would be lost.
template <class Apexes>
Outcome cone_over(Workspace& ws, const BlockRules& rules, const Vec3& at, InsertionPlace place,
                  const Apexes& apexes) {
  std::vector<Cone>& cones = ws.cones;
  cones.clear();
  std::vector<Index>& removed = ws.proposal.removed;
  for (Index t : removed)
    for (int slot = 0; slot < 4; ++slot)
      if (apexes(ws.mesh.points(t)[slot])) cones.push_back(cone(ws, rules, at, t, slot));
  if (place == InsertionPlace::best) {
    ws.plain = cones;
    ws.plain_cavity = removed;
    grow(ws, rules, at, cones);
    if (star_of_new_point(ws, at, cones)) return Outcome::done;
    cones = ws.plain;
    removed = ws.plain_cavity;
  }
  return star_of_new_point(ws, at, cones) ? Outcome::done : Outcome::link_condition;
}

/// An interface triangle at its current position.
MeshTriangle triangle(const EditableMesh& mesh, Index a, Index b, Index c) {
  return {{a, b, c}, {mesh.position(a), mesh.position(b), mesh.position(c)}};
}

/// Proposes to replace the proposal's `removed` by the star in ws.star.
/// \pre The proposal's edit has the removed interface triangles.
Outcome propose(Workspace& ws, const BlockRules& rules, InsertionPlace place) {
  const EditableMesh& mesh = ws.mesh;
  Proposal& proposal = ws.proposal;
  if (std::any_of(proposal.removed.begin(), proposal.removed.end(),
                  [&](Index t) { return mesh.frozen_tet(t); }))
    return Outcome::material_rule;
  float before = 1;
  for (Index t : proposal.removed) before = std::min(before, mesh.quality(t));
  Star& star = ws.star;
  star.find_creases();
  const int dimension = star.dimension();
  // A point of dimension 0 stays where it was inserted.
  Placement& placement = ws.placement;
  const float limit =
      place == InsertionPlace::best ? Insertion::min_gain * before : ws.acceptance_limit(rules, before);
  star.compute_gradients();
  bool good = false;
  if (place == InsertionPlace::best && dimension > 0)
    good = find_position(ws, rules, dimension, limit, placement);
  if (!good) {
    if (!(star.worst > limit)) return Outcome::quality;
    placement.position = star.centre_position;
    placement.qualities.clear();
    for (const Star::StarTet& t : star.tets) placement.qualities.push_back(t.quality);
  }
  for (const Star::InterfaceTriangle& s : star.interface_triangles)
    proposal.edit.added.push_back({{{unnumbered_point, star.points[s.first], star.points[s.second]},
                                    {placement.position, star.positions[s.first], star.positions[s.second]}},
                                   s.patch,
                                   s.inside,
                                   s.across});
  if (!proposal.edit.empty())
    if (const Outcome o = ws.test_surface(rules); o != Outcome::done) return o;
  proposal.volumes = star.volume_changes(placement.position - star.centre_position);
  proposal.change = Proposal::Change::replace;
  proposal.has_new_point = true;
  proposal.position = placement.position;
  proposal.added.clear();
  for (std::size_t k = 0; k < star.tets.size(); ++k) {
    const Star::StarTet& t = star.tets[k];
    proposal.added.push_back(
        {{unnumbered_point, star.points[t.link[0]], star.points[t.link[1]], star.points[t.link[2]]},
         t.region,
         placement.qualities[k]});
  }
  proposal.claim_cavity(mesh);
  return ws.within_bounds(rules, static_cast<std::int64_t>(proposal.added.size()) -
                                     static_cast<std::int64_t>(proposal.removed.size()));
}

/// Whether an interface triangle must not be split: all its vertices are frozen.
bool frozen_triangle(const EditableMesh& mesh, const Triangle& ids) {
  return mesh.frozen(ids[0]) && mesh.frozen(ids[1]) && mesh.frozen(ids[2]);
}

Outcome try_face(Workspace& ws, const BlockRules& rules, Index tet, int face, InsertionPlace place) {
  const EditableMesh& mesh = ws.mesh;
  const FaceLink link = mesh.link(tet, face);
  if (!link.is_interface()) return Outcome::no_candidate;
  const Triangle ids = face_of(mesh.points(tet), face);
  if (frozen_triangle(mesh, ids)) return Outcome::material_rule;
  Proposal& proposal = ws.proposal;
  proposal.removed.assign(1, tet);
  if (!link.is_outside()) proposal.removed.push_back(link.tet());
  const Vec3 at = mesh.snap((mesh.position(ids[0]) + mesh.position(ids[1]) + mesh.position(ids[2])) / 3);
  const Outcome o =
      cone_over(ws, rules, at, place, [&](Index p) { return p == ids[0] || p == ids[1] || p == ids[2]; });
  if (o != Outcome::done) return o;
  const PatchId patch = link.is_outside() ? link.patch() : ws.grid.patch(mesh, ids);
  for (int k = 0; k < 3; ++k)
    ws.star.add_interface_triangle(ids[k], ids[(k + 1) % 3], mesh.region(tet), mesh.region_across(tet, face),
                                   patch);
  proposal.edit.clear();
  proposal.edit.removed.push_back(triangle(mesh, ids[0], ids[1], ids[2]));
  return propose(ws, rules, place);
}

Outcome try_edge(Workspace& ws, const BlockRules& rules, Index tet, int edge, InsertionPlace place,
                 bool interior) {
  const EditableMesh& mesh = ws.mesh;
  EdgeRing& ring = ws.ring;
  if (const Outcome o = ring.gather(mesh, tet, edge); o != Outcome::done) return o;
  if (!interior && ring.interface_triangles == 0) return Outcome::no_candidate;
  if (!ring.closed && !ws.walk.is_whole(ws.mesh, ring)) return Outcome::material_rule;
  Proposal& proposal = ws.proposal;
  proposal.removed = ring.tets;
  const Vec3 at = mesh.snap((mesh.position(ring.a) + mesh.position(ring.b)) / 2);
  if (const Outcome o = cone_over(ws, rules, at, place, [&](Index p) { return p == ring.a || p == ring.b; });
      o != Outcome::done)
    return o;
  proposal.edit.clear();
  const std::size_t n = ring.tets.size();
  bool frozen = false;
  const auto interface_triangle = [&](Index p, RegionId inside, RegionId across, PatchId patch) {
    ws.star.add_interface_triangle(ring.a, p, inside, across, patch);
    ws.star.add_interface_triangle(p, ring.b, inside, across, patch);
    proposal.edit.removed.push_back(triangle(mesh, ring.a, ring.b, p));
    frozen |= frozen_triangle(mesh, {ring.a, ring.b, p});
  };
  /// Patch of the boundary face at the edge that lies opposite `apex` in the chain's first or last tet.
  const auto end_patch = [&](Index end_tet, Index apex) {
    return mesh.link(end_tet, mesh.slot_of(end_tet, apex)).patch();
  };
  if (!ring.closed) {
    interface_triangle(ring.points.front(), ring.regions.front(), outside_id,
                       end_patch(ring.tets.front(), ring.points[1]));
    interface_triangle(ring.points.back(), ring.regions.back(), outside_id,
                       end_patch(ring.tets.back(), ring.points[ring.points.size() - 2]));
  }
  for (std::size_t i = ring.closed ? 0 : 1; i < n; ++i) {
    if (ring.behind_interface[i])
      interface_triangle(ring.points[i], ring.regions[i], ring.regions[(i + n - 1) % n],
                         ws.grid.patch(mesh, {ring.a, ring.b, ring.points[i]}));
  }
  return frozen ? Outcome::material_rule : propose(ws, rules, place);
}

}  // namespace

Outcome insert_in_tet(Workspace& ws, const BlockRules& rules, Index tet, InsertionPlace place) {
  const EditableMesh& mesh = ws.mesh;
  const Tet& p = mesh.points(tet);
  ws.proposal.removed.assign(1, tet);
  const Vec3 at =
      mesh.snap((mesh.position(p[0]) + mesh.position(p[1]) + mesh.position(p[2]) + mesh.position(p[3])) / 4);
  Outcome o = cone_over(ws, rules, at, place, [](Index) { return true; });
  ws.proposal.edit.clear();
  if (o == Outcome::done) o = propose(ws, rules, place);
  return ws.count(Operation::insert_in_tet, o);
}

Outcome insert_in_face(Workspace& ws, const BlockRules& rules, Index tet, int face, InsertionPlace place) {
  return ws.count(Operation::insert_in_face, try_face(ws, rules, tet, face, place));
}

Outcome insert_in_edge(Workspace& ws, const BlockRules& rules, Index tet, int edge, InsertionPlace place,
                       bool interior) {
  return ws.count(Operation::insert_in_edge, try_edge(ws, rules, tet, edge, place, interior));
}

}  // namespace tetwright
