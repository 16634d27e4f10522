#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/random.h"
#include "simplify/constraints/link_condition.h"
#include "simplify/constraints/surface_grid.h"
#include "simplify/constraints/volume_ledger.h"
#include "simplify/mesh/cavity.h"
#include "simplify/mesh/edge_ring.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/free_slots.h"
#include "simplify/mesh/locks.h"
#include "simplify/mesh/outcome.h"
#include "simplify/mesh/star.h"
#include "simplify/mesh/star_walk.h"
#include "simplify/operations/block_rules.h"
#include "simplify/operations/retriangulation.h"
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

/// What one worker of a block uses: the locks it has taken, its free slots, its counts, and the memory that
/// operations reuse, so that none of them allocates.
struct Workspace {
  Workspace(EditableMesh& m, SurfaceGrid& g, VolumeLedger& l)
      : mesh(m),
        grid(g),
        ledger(l),
        points(m.locks()),
        cells(g.locks()),
        free_tets(m.free_tets()),
        free_points(m.free_points()) {}

  EditableMesh& mesh;
  SurfaceGrid& grid;
  VolumeLedger& ledger;
  HeldLocks points;  ///< of the mesh's points
  HeldLocks cells;   ///< of the grid's cells
  FreeSlots free_tets, free_points;
  Random random{0};
  OperationCounts counts;
  std::uint64_t lock_conflicts = 0;
  std::uint64_t skipped = 0;  ///< items given up after too many conflicts

  // What operations read and change.
  Star star;
  EdgeRing ring;
  Cavity cavity;
  SurfaceGrid::Edit edit;
  SurfaceGrid::Workspace grid_workspace;
  StarWalk walk;
  LinkCondition link_condition;
  Retriangulation retriangulation;

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

  void release() {
    cells.release();
    points.release();
  }
  /// Locks a point unless this worker holds it; false if another one does.
  bool lock(Index point) { return points.holds(point) || points.try_lock(point); }
  /// The quality that the worst new tet must exceed: that of the worst old one, or less if annealing accepts
  /// a worse result. Draws one random number when annealing.
  float acceptance_limit(const BlockRules& rules, float worst);
};

}  // namespace tetwright
