#pragma once

#include <cstdint>
#include <vector>

#include "common/quality.h"
#include "common/random.h"
#include "simplify/editable_mesh.h"
#include "simplify/outcome.h"
#include "simplify/star.h"
#include "simplify/surface_grid.h"

namespace tetwright {

/// How good a tet is, for the operations: a larger value is better, 0 is flat or negative and never accepted.
struct Objective {
  enum class Kind : std::uint8_t {
    paper,  ///< Quality(t)^3: angle, volume and longest edge, with the target count in view
    shape   ///< the smallest solid angle over the regular tet's: for improving at a count that is reached
  };
  Kind kind = Kind::paper;
  TetQuality quality{1, 1, 5};

  float operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    return static_cast<float>(kind == Kind::paper ? quality.cubed(a, b, c, d) : quality.shape(a, b, c, d));
  }
};

/// What all operations of a block go by.
struct BlockRules {
  Objective objective;
  double largest_error = 0;     ///< E, working coordinates
  double gamma = 10;            ///< weight of the volume error
  std::size_t fewest_tets = 0;  ///< that an operation may leave
  double accept_worse = 0;      ///< annealing: probability of an action that leaves a poorer tet than before
};

/// One task's own things: what it holds, what it reuses, what it counted.
struct Task {
  Task(EditableMesh& m, SurfaceGrid& g) : mesh(m), grid(g), points(m.locks()), cells(g.locks()), slots(m) {}

  EditableMesh& mesh;
  SurfaceGrid& grid;
  HeldLocks points;  ///< of the mesh's points
  HeldLocks cells;   ///< of the grid's cells
  EditableMesh::SlotStock slots;
  SurfaceGrid::Task grid_task;
  SurfaceGrid::Edit edit;
  Star star;
  LocalNumbers numbers;
  Random random{0};
  OperationCounts counts;
  std::uint64_t lock_conflicts = 0;
  std::uint64_t skipped = 0;  ///< given up after too many conflicts

  void release() {
    cells.release();
    points.release();
  }
};

}  // namespace tetwright
