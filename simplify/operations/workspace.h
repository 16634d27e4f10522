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
#include "simplify/mesh/outcome.h"
#include "simplify/mesh/star.h"
#include "simplify/mesh/star_walk.h"
#include "simplify/operations/block_rules.h"
#include "simplify/operations/proposal.h"
#include "simplify/operations/ring_triangulation.h"

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

/// A tet that an insertion makes: the new point over the face of an old tet opposite its vertex `slot`.
struct Cone {
  Index tet;
  int slot;
  float quality;
};

/// What one worker decides with: the mesh, which it only reads, the proposal that it fills, and the memory
/// that operations reuse, so that none of them allocates.
///
/// An operation that answers `done` has left in `proposal` all that its commit will write. Whether it is
/// carried out is not its affair: an earlier one of the batch may come before it. Any other answer leaves a
/// proposal of no meaning.
struct Workspace {
  Workspace(const EditableMesh& m, const SurfaceGrid& g, const VolumeLedger& l)
      : mesh(m), grid(g), ledger(l) {}

  const EditableMesh& mesh;
  const SurfaceGrid& grid;
  const VolumeLedger& ledger;
  Proposal proposal;
  Random random{0};
  OperationCounts counts;

  // What operations read and change.
  Star star;
  EdgeRing ring;
  StarWalk walk;
  LinkCondition link_condition;

  // Memory of single operations.
  std::vector<float> qualities;                     ///< smoothing and collapse: of the star's tets
  std::vector<CollapseTarget> targets;              ///< collapse
  std::array<std::vector<Index>, 2> chains;         ///< edge removal: points around the edge, by region
  std::array<RingTriangulation, 2> triangulations;  ///< edge removal
  std::vector<float> current, trial;                ///< smoothing: values of the star's tets
  std::vector<std::size_t> order;                   ///< smoothing: the star's tets, the worst first
  Placement placement;                              ///< smoothing and insertion
  std::vector<Cone> cones, fresh, plain;            ///< insertion
  std::vector<Index> plain_cavity;                  ///< insertion
  std::vector<std::uint32_t> hull_edges;            ///< insertion

  /// Star::gather() with the patches of all faces.
  Outcome gather(Index point);
  /// The quality that the worst new tet must exceed: that of the worst old one, or less if annealing accepts
  /// a worse result. Draws one random number when annealing.
  float acceptance_limit(const BlockRules& rules, float worst);
  /// Counts a refusal; what is done is counted when it has won (Proposal::operation).
  Outcome count(Operation operation, Outcome outcome) {
    if (outcome == Outcome::done) {
      proposal.operation = operation;
    } else {
      counts.add(operation, outcome);
    }
    return outcome;
  }
  /// Whether the proposal's edit of the surface neither meets other triangles nor leaves the input's surface
  /// (BlockRules::max_deviation): done, self_intersection or surface_error.
  Outcome test_surface(const BlockRules& rules);
  /// What all operations end with: whether no tets come to overlap around an edge, and the count may change
  /// by that much, and the volumes as the proposal says; then done.
  Outcome within_bounds(const BlockRules& rules, std::int64_t count_change);
};

}  // namespace tetwright
