#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/predicates.h"
#include "common/quality.h"
#include "common/random.h"
#include "simplify/cavity.h"
#include "simplify/edge_ring.h"
#include "simplify/editable_mesh.h"
#include "simplify/outcome.h"
#include "simplify/slide.h"
#include "simplify/star.h"
#include "simplify/surface_grid.h"
#include "simplify/volume_ledger.h"

namespace tetwright {

/// How good a tet is, for the operations: a larger value is better, 0 is flat or negative and never accepted.
struct Objective {
  enum class Kind : std::uint8_t {
    paper,  ///< Quality(t)^3: angle, volume and longest edge, with the target count in view
    shape   ///< shape alone: for improving at a count that is reached
  };
  Kind kind = Kind::paper;
  TetQuality quality{1, 1, 5, 0};
  ShapeObjective shape = ShapeObjective::both;

  float operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    return static_cast<float>(precise(a, b, c, d));
  }
  /// Below 0 for a flat or negative tet, the more so the worse it is: what shows the way out.
  float signed_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    return static_cast<float>(precise_signed(a, b, c, d));
  }
  /// signed_value() unrounded, for gradients by differences.
  double precise_signed(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    const double value = precise(a, b, c, d);
    if (value > 0) return value;
    const double longest2 = std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (d - a).squaredNorm(),
                                      (c - b).squaredNorm(), (d - b).squaredNorm(), (d - c).squaredNorm()});
    return std::min(0.0, orient3d_value(a, b, c, d) / (longest2 * std::sqrt(longest2)) - 1e-9);
  }

 private:
  double precise(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    return kind == Kind::paper ? quality.cubed(a, b, c, d) : shape_quality(shape, a, b, c, d);
  }
};

/// What all operations of a block go by.
struct BlockRules {
  Objective objective;
  double largest_error = 0;  ///< E, working coordinates
  double gamma = 10;         ///< weight of the volume error
  /// An operation may not leave fewer tets, nor, where it adds some, more.
  std::size_t fewest_tets = 0, most_tets = std::numeric_limits<std::int64_t>::max();
  /// Error(op) takes the net change of each volume, as the paper has it; else what each sheet sweeps adds up.
  bool losses_cancel = false;
  double accept_worse = 0;    ///< annealing: probability of an action that leaves a poorer tet than before
  float annealing_floor = 0;  ///< share of the poorest quality that such an action must keep
  float good_enough = 1;      ///< an action that leaves only better tets is accepted whatever was there
  /// Targets of a collapse that are tried, in the order of their weight.
  std::size_t most_targets = 4;
  /// Weight of the distance that a collapse may move the surface at the point that goes, against E; 0: the
  /// volume alone decides, as in the paper.
  double distance_weight = 0;
  /// How far a new surface triangle's centre may lie from the reference (needs slide), working coordinates;
  /// 0: not looked at. Unlike E it does not add up over several operations.
  double largest_distance = 0;
  /// Points of interfaces, junction curves and corners may also leave them by up to largest_distance (or as
  /// far as they stand away already) where that betters the shapes (needs slide).
  bool leave_surface = false;
  const Slide* slide = nullptr;  ///< what surface points slide along; null: planes of constant volume
};

/// Whether a triangle that an edit adds stays near the reference, as far as the rules ask for it. `inside`
/// and `across` are the regions that it separates.
inline bool near_reference(const BlockRules& rules, const MeshTriangle& t, Region inside, Region across) {
  if (!rules.slide || !(rules.largest_distance > 0)) return true;
  const Vec3 centre = (t.points[0] + t.points[1] + t.points[2]) / 3;
  return rules.slide->onto_surface(centre, inside, across, rules.largest_distance).has_value();
}

/// One task's own things: what it holds, what it reuses, what it counted.
struct Task {
  Task(EditableMesh& m, SurfaceGrid& g, VolumeLedger& l)
      : mesh(m), grid(g), ledger(l), points(m.locks()), cells(g.locks()), slots(m), point_slots(m) {}

  EditableMesh& mesh;
  SurfaceGrid& grid;
  VolumeLedger& ledger;
  HeldLocks points;  ///< of the mesh's points
  HeldLocks cells;   ///< of the grid's cells
  EditableMesh::SlotStock slots;
  EditableMesh::PointStock point_slots;
  SurfaceGrid::Task grid_task;
  SurfaceGrid::Edit edit;
  Star star;
  EdgeRing ring;
  Cavity cavity;
  LocalNumbers numbers;
  std::vector<Index> walk;
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
