#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "common/geometry/triangle_intersection.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/locks.h"
#include "simplify/mesh/outcome.h"

namespace tetwright {

/// The boundary and interface triangles of an EditableMesh with their coordinates, in a hashed spatial grid
/// whose cells carry try-locks: the explicit test against self-intersection, which positive tets alone do not
/// prevent (two parts of a surface may pass through each other from outside).
///
/// A cell's list is read and written while its lock is held; a triangle's record is written while all cells
/// that its bounding box touches are held, read while one is. The coordinates stand in the record, so that no
/// point's position is read without its lock.
class SurfaceGrid {
 public:
  /// What an operation takes away and puts in; kept by the task, so that its memory is reused.
  struct Edit {
    std::vector<MeshTriangle> removed, added;
    void clear() {
      removed.clear();
      added.clear();
    }
  };

  /// A task's free records, and its scratch.
  struct Workspace {
    std::vector<std::uint32_t> free_records;
    std::vector<std::uint32_t> cells;            ///< that the edit touches, ascending
    std::vector<std::uint32_t> removed_records;  ///< found by begin_edit()
  };

  /// All interface triangles of the mesh; while no task runs. `min_cell` (working coordinates) is the
  /// size that triangles are about to grow to; `spare`: how many triangles may be added beyond those taken
  /// away.
  void build(const EditableMesh& mesh, double min_cell, std::size_t spare = 0);

  /// Locks every cell that the edit touches and tests each added triangle against those that stand and
  /// against the other added ones. done: the cells stay held, and commit() may follow. lock_taken,
  /// self_intersection or no_room: nothing was changed; `held` has what was locked. The task must hold all
  /// points of the edit's triangles.
  Outcome begin_edit(Edit& edit, Workspace& ws, HeldLocks& held);
  /// Carries out what begin_edit() allowed.
  void commit(const Edit& edit, Workspace& ws);

  TryLocks& locks() { return locks_; }
  /// All that stand, ids ascending within each; while no task runs, for tests.
  std::vector<MeshTriangle> triangles() const;

 private:
  struct Cell3 {
    std::int32_t x, y, z;
    bool operator==(const Cell3&) const = default;
  };
  Cell3 cell_at(const Vec3& p) const;
  std::uint32_t slot(const Cell3& c) const;
  /// Calls f(cell) for each cell that the triangle's box touches.
  template <class F>
  void for_cells(const MeshTriangle& t, const F& f) const;
  bool hits_standing(const MeshTriangle& t, const Workspace& ws) const;

  const EditableMesh* mesh_ = nullptr;  ///< tells which points are one and the same
  Vec3 origin_ = Vec3::Zero();
  double to_cell_ = 1;
  std::uint32_t mask_ = 0;
  std::vector<std::vector<std::uint32_t>> cells_;  ///< records, by slot
  std::vector<MeshTriangle> records_;              ///< ids ascending, points in the same order
  TryLocks locks_;
  std::atomic<std::size_t> next_spare_{0};  ///< the first record that nobody took
};

}  // namespace tetwright
