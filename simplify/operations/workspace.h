// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/random.h"
#include "simplify/constraints/link_condition.h"
#include "simplify/constraints/surface_grid.h"
#include "simplify/constraints/volume_ledger.h"
#include "simplify/mesh/edge_ring.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/star.h"
#include "simplify/mesh/star_walk.h"
#include "simplify/operations/block_rules.h"
#include "simplify/operations/proposal.h"
#include "simplify/operations/ring_triangulation.h"
#include "tetwright/simplify.h"

namespace tetwright {

/// A new position for the centre of a star, and the qualities of its tets there, in the star's order.
struct Placement {
  Vec3 position = Vec3::Zero();
  float worst = 0;
  std::vector<float> qualities;
};

/// A target of a collapse.
struct CollapseTarget {
  double weight;
  std::uint16_t point;  ///< local number in the star
};

/// A tet that an insertion adds: the new point over the face of an old tet opposite its vertex `slot`.
struct Cone {
  Index tet;
  int slot;
  float quality;
};

/// State of one worker while it decides: the mesh, which is only read, the proposal that it fills, and memory
/// that operations reuse, so that none of them allocates.
///
/// An operation that returns `done` has stored all data that its commit will write in `proposal`. It may
/// still lose to an earlier operation of the batch. After any other result the proposal is meaningless.
struct Workspace {
  Workspace(const EditableMesh& m, const SurfaceGrid& g, const VolumeLedger& l)
      : mesh(m), grid(g), ledger(l) {}

  const EditableMesh& mesh;
  const SurfaceGrid& grid;
  const VolumeLedger& ledger;
  Proposal proposal;
  Random random{0};
  OperationCounts counts;

  // Gathered parts of the mesh.
  Star star, target_star;
  EdgeRing ring;
  StarWalk walk;
  LinkCondition link_condition;

  // Scratch memory of single operations.
  std::vector<float> qualities;                     ///< smoothing and collapse: qualities of the star's tets
  std::vector<CollapseTarget> targets;              ///< collapse
  std::vector<std::size_t> curve_ends;              ///< bounded_curves()
  std::vector<CurveKinds> kinds, target_kinds;      ///< of the edges of the stars
  std::array<std::vector<Index>, 2> chains;         ///< edge removal: points around the edge, by region
  std::array<RingTriangulation, 2> triangulations;  ///< edge removal
  std::vector<float> current, trial;                ///< smoothing: values of the star's tets
  std::vector<std::size_t> order;                   ///< smoothing: the star's tets, the worst first
  Placement placement;                              ///< smoothing and insertion
  std::vector<Cone> cones, fresh, plain;            ///< insertion
  std::vector<Index> plain_cavity;                  ///< insertion
  std::vector<std::uint32_t> hull_edges;            ///< insertion

  /// Star::gather(), including the patches of interface faces.
  Outcome gather(Index point);
  /// Quality that the worst new tet must exceed: that of the worst old one, or less if annealing accepts a
  /// worse result. Draws one random number when annealing.
  float acceptance_limit(const BlockRules& rules, float worst);
  /// Counts a refusal. A success is counted when it wins (Proposal::operation).
  Outcome count(Operation operation, Outcome outcome) {
    if (outcome == Outcome::done) {
      proposal.operation = operation;
    } else {
      counts.add(operation, outcome);
    }
    return outcome;
  }
  /// Tests the proposal's edit of the surface against self-intersection and DeviationBound.
  ///
  /// \return done, self_intersection or surface_error.
  Outcome test_surface(const BlockRules& rules);
  /// Last test of every operation: volumes, overlaps around an edge, edge lengths and the number of tets.
  ///
  /// \return done, volume, self_intersection, edge_length or count.
  Outcome within_bounds(const BlockRules& rules, std::int64_t count_change);
  /// The ends of the star's edges of dimension 1 that stay near the curves of the input. Among labels of a
  /// volume, curves that follow voxels need not.
  const std::vector<std::size_t>& bounded_curves(const BlockRules& rules);
  /// How far the segment that replaces the edge to link point p may be from those curves.
  /// \pre p is one of bounded_curves()
  double max_curve_distance(const BlockRules& rules, std::size_t p) const;
  /// Whether the star's centre is on a crease of a body among labels, neither an end nor a branch of it, and
  /// the given surface has the crease. Fills `kinds`.
  bool is_on_crease(const BlockRules& rules);
  /// Whether the star's centre may be a corner of a body, and is not only one of curves between labels.
  bool may_be_corner(const BlockRules& rules);
  /// Whether one curve between labels meets one crease of a body at the star's centre, in a point or in a
  /// common edge. Such a point may move along the crease: voxels do not say exactly where it is. Fills
  /// `kinds`.
  bool is_crossing(const BlockRules& rules);
  /// Whether the crossing at the star's centre may move to link point b on its crease: if curves between
  /// labels do not lead there, b must lie within a single interface of them.
  /// \pre is_crossing()
  bool may_cross_at(const BlockRules& rules, std::size_t b);
  /// Whether the star's centre is on a single curve between labels that only voxels determine. Such a point
  /// may merge with one on a crease, so that a curve that runs close along a crease leaves no strip between
  /// both. Fills `kinds`.
  bool is_on_label_curve(const BlockRules& rules);
  /// Whether the centre may merge with link point b: their edge is in an interface, and b on a crease, not at
  /// its end, and within a single interface of labels.
  /// \pre is_on_label_curve()
  bool may_merge_with(const BlockRules& rules, std::size_t b);

 private:
  Outcome gather(Index point, Star& into) const;
  bool follows_one_crease(const BlockRules& rules);
};

}  // namespace tetwright
