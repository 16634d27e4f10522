// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/edge_removal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/geometry/predicates.h"
#include "common/portable_math.h"

namespace tetwright {

namespace {

/// Ring size of the largest basic flip, 4-4.
constexpr std::size_t basic_ring = 4;
static_assert(full_reach.max_ring < RingTriangulation::max_points);

Vec3 normal_of(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a); }

/// Replaces the interface triangles (a, b, s) and (a, b, t) of the ring's edge (a, b) by the two at the edge
/// (s, t).
Outcome surface_edit(Workspace& ws, const BlockRules& rules, Index s, Index t, RegionId inside,
                     RegionId across, PatchId patch) {
  const EditableMesh& mesh = ws.mesh;
  const EdgeRing& ring = ws.ring;
  const Vec3 &a = mesh.position(ring.a), &b = mesh.position(ring.b), &ps = mesh.position(s),
             &pt = mesh.position(t);
  const double swept = std::fabs(orient3d_value(a, b, ps, pt)) / 6;
  const int materials = across == outside_id ? 1 : 2;
  if (rules.error.gamma * materials * portable_cbrt(swept) > rules.error.limit())
    return Outcome::surface_error;
  // Refuse folds: the normal of every new triangle must agree with those of both old ones.
  const std::array<Vec3, 2> before{normal_of(a, ps, b), normal_of(a, b, pt)};
  const std::array<Vec3, 2> after{normal_of(a, ps, pt), normal_of(b, pt, ps)};
  for (const Vec3& n : after)
    for (const Vec3& m : before)
      if (!(n.dot(m) > 0)) return Outcome::surface_error;
  SurfaceGrid::Edit& edit = ws.proposal.edit;
  edit.clear();
  edit.removed = {{{ring.a, ring.b, s}, {a, b, ps}}, {{ring.a, ring.b, t}, {a, b, pt}}};
  edit.added = {{{{ring.a, s, t}, {a, ps, pt}}, patch, inside, across},
                {{{ring.b, s, t}, {b, ps, pt}}, patch, inside, across}};
  for (const SurfaceGrid::Added& n : edit.added)
    if (!near_reference(rules, n, inside, across)) return Outcome::surface_error;
  return ws.test_surface(rules);
}

/// The removal of an edge whose ring is gathered in the workspace.
class EdgeRemoval {
 public:
  EdgeRemoval(Workspace& ws, const BlockRules& rules)
      : ws_(ws), rules_(rules), dimension_(ws.ring.dimension()) {}

  /// \param kind receives the kind of flip, if the removal is one.
  Outcome run(const FlipReach& reach, Operation& kind) {
    if (dimension_ == 1) return Outcome::material_rule;
    make_chains();
    if (dimension_ == 2) {
      find_patches();
      if (patches_[0] != patches_[1]) return Outcome::material_rule;  // a crease
    }
    kind = kind_of_flip();
    if (reach.basic() && kind == Operation::edge_removal) return Outcome::no_candidate;
    if (const Outcome o = check_chains(reach); o != Outcome::done) return o;
    const EdgeRing& ring = ws_.ring;
    const float limit = ws_.acceptance_limit(rules_, ring.worst);
    for (std::size_t c = 0; c < chain_count_; ++c)
      if (!ws_.triangulations[c].find(ws_.mesh, rules_, ring.a, ring.b, ws_.chains[c], limit))
        return Outcome::quality;
    if (!fill_cavity()) return Outcome::link_condition;
    return propose();
  }

 private:
  /// Chains of points around the edge, one for each side of the interface.
  void make_chains() {
    EdgeRing& ring = ws_.ring;
    std::array<std::vector<Index>, 2>& chains = ws_.chains;
    chains[0].clear();
    chains[1].clear();
    regions_ = {ring.regions[0], ring.regions[0]};
    if (dimension_ == 3 || !ring.closed) {
      chains[0] = ring.points;
      return;
    }
    ring.begin_at_interface();
    chain_count_ = 2;
    regions_ = {ring.regions.front(), ring.regions.back()};
    const std::size_t n = ring.tets.size();
    std::size_t k = 0;
    do {
      chains[0].push_back(ring.points[k++]);
    } while (!ring.behind_interface[k]);
    chains[0].push_back(ring.points[k]);
    for (; k < n; ++k) chains[1].push_back(ring.points[k]);
    chains[1].push_back(ring.points[0]);
  }

  /// The patches of the two interface triangles at the edge.
  void find_patches() {
    const EdgeRing& ring = ws_.ring;
    const EditableMesh& mesh = ws_.mesh;
    if (ring.closed) {
      patches_ = {ws_.grid.patch(mesh, {ring.a, ring.b, ws_.chains[0].front()}),
                  ws_.grid.patch(mesh, {ring.a, ring.b, ws_.chains[0].back()})};
      return;
    }
    // The boundary faces of the first and last tet contain a, b and an end of the chain, and are opposite the
    // next point of the chain.
    const std::size_t n = ring.points.size();
    patches_ = {mesh.link(ring.tets.front(), mesh.slot_of(ring.tets.front(), ring.points[1])).patch(),
                mesh.link(ring.tets.back(), mesh.slot_of(ring.tets.back(), ring.points[n - 2])).patch()};
  }

  Operation kind_of_flip() const {
    const std::size_t n = ws_.ring.tets.size();
    if (chain_count_ == 2)
      return n == 4 && ws_.chains[0].size() == 3 ? Operation::flip44 : Operation::edge_removal;
    if (dimension_ == 3) return n == 3 ? Operation::flip32 : Operation::edge_removal;
    return n == 2 ? Operation::flip22 : Operation::edge_removal;
  }

  Outcome check_chains(const FlipReach& reach) {
    const EdgeRing& ring = ws_.ring;
    const EditableMesh& mesh = ws_.mesh;
    for (std::size_t c = 0; c < chain_count_; ++c) {
      if (ws_.chains[c].size() < 3) return Outcome::no_candidate;
      if (ws_.chains[c].size() > RingTriangulation::max_points ||
          (dimension_ == 3 && ring.tets.size() > reach.max_ring))
        return Outcome::too_large;
    }
    if (mesh.any_frozen() && frozen()) return Outcome::material_rule;
    if (!ring.closed && !ws_.walk.is_whole(mesh, ring)) return Outcome::material_rule;
    return Outcome::done;
  }

  /// Whether a tet or an interface triangle of the ring is frozen.
  bool frozen() const {
    const EdgeRing& ring = ws_.ring;
    const EditableMesh& mesh = ws_.mesh;
    if (std::any_of(ring.tets.begin(), ring.tets.end(), [&](Index t) { return mesh.frozen_tet(t); }))
      return true;
    return dimension_ == 2 && mesh.frozen(ring.a) && mesh.frozen(ring.b) &&
           (mesh.frozen(ws_.chains[0].front()) || mesh.frozen(ws_.chains[0].back()));
  }

  /// Fills the proposal's tets. False if an edge or triangle of the triangulation exists already.
  bool fill_cavity() {
    const EdgeRing& ring = ws_.ring;
    const EditableMesh& mesh = ws_.mesh;
    Proposal& proposal = ws_.proposal;
    proposal.added.clear();
    proposal.removed = ring.tets;
    const bool single_triangle = dimension_ == 3 && ring.tets.size() == 3;
    bool present = false;
    for (std::size_t c = 0; c < chain_count_; ++c) {
      const std::vector<Index>& p = ws_.chains[c];
      ws_.triangulations[c].triangles([&](std::size_t i, std::size_t k, std::size_t j) {
        for (const Tet& t : {Tet{p[i], p[k], p[j], ring.b}, Tet{p[i], p[j], p[k], ring.a}})
          proposal.added.push_back({t, regions_[c], quality_of(mesh, rules_, t)});
        // Diagonals must be new; for a ring of three points, the triangle must be new.
        if (single_triangle) {
          present |=
              ws_.walk.any(mesh, p[i], [&](const Tet& t) { return contains(t, p[k]) && contains(t, p[j]); });
        } else if (j - i > 1 && !(dimension_ == 3 && i == 0 && j + 1 == p.size())) {
          present |= ws_.walk.joined(mesh, p[i], p[j]);
        }
      });
    }
    return !present;
  }

  /// Volume changes of the regions on both sides of the edge.
  std::array<VolumeChange, 2> volume_changes() const {
    const EdgeRing& ring = ws_.ring;
    const EditableMesh& mesh = ws_.mesh;
    if (ring.closed && regions_[0] == regions_[1]) return {{{regions_[0], 0}, {outside_id, 0}}};  // a sheet
    double gained = 0;
    for (const NewTet& t : ws_.proposal.added)
      if (t.region == regions_[0])
        gained += orient3d_value(mesh.position(t.points[0]), mesh.position(t.points[1]),
                                 mesh.position(t.points[2]), mesh.position(t.points[3])) /
                  6;
    for (std::size_t i = 0; i < ring.tets.size(); ++i)
      if (ring.regions[i] == regions_[0]) gained -= mesh.signed_volume(ring.tets[i]);
    std::array<VolumeChange, 2> changes{{{regions_[0], gained}, {outside_id, 0}}};
    if (ring.closed) changes[1] = {regions_[1], -gained};
    return changes;
  }

  Outcome propose() {
    Proposal& proposal = ws_.proposal;
    proposal.edit.clear();
    proposal.volumes.clear();
    if (dimension_ == 2) {
      const EdgeRing& ring = ws_.ring;
      if (const Outcome o = surface_edit(ws_, rules_, ws_.chains[0].front(), ws_.chains[0].back(),
                                         regions_[0], ring.closed ? regions_[1] : outside_id, patches_[0]);
          o != Outcome::done)
        return o;
      const std::array<VolumeChange, 2> volumes = volume_changes();
      proposal.volumes.assign(volumes.begin(), volumes.end());
    }
    proposal.change = Proposal::Change::replace;
    proposal.has_new_point = false;
    proposal.claim_cavity(ws_.mesh);
    return ws_.within_bounds(rules_, static_cast<std::int64_t>(proposal.added.size()) -
                                         static_cast<std::int64_t>(proposal.removed.size()));
  }

  Workspace& ws_;
  const BlockRules& rules_;
  int dimension_;
  std::size_t chain_count_ = 1;
  std::array<RegionId, 2> regions_{};
  std::array<PatchId, 2> patches_{};  ///< if the edge has dimension 2
};

}  // namespace

Outcome remove_edge(Workspace& ws, const BlockRules& rules, Index tet, int edge, const FlipReach& reach) {
  Operation kind = Operation::edge_removal;
  Outcome o = ws.ring.gather(ws.mesh, tet, edge, reach.basic() ? basic_ring : EdgeRing::max_tets);
  if (o == Outcome::done) o = EdgeRemoval(ws, rules).run(reach, kind);
  // Not a basic flip, so nothing was tried.
  if (reach.basic() && kind == Operation::edge_removal) return Outcome::no_candidate;
  return ws.count(kind, o);
}

}  // namespace tetwright
