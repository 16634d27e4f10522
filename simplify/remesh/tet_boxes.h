#pragma once

#include <vector>

#include "common/geometry/box_tree.h"
#include "simplify/mesh/editable_mesh.h"

namespace tetwright {

/// Finds the tets near a place, and is repaired where tets change: a binary tree of boxes over blocks of tet
/// slots, which are near each other since compaction numbers tets along a space-filling curve. 3 bytes for
/// each tet. Working coordinates.
class TetBoxes {
 public:
  /// All tets of the mesh; while no task runs.
  void build(const EditableMesh& mesh);
  /// After tets in these slots have come, gone or changed: time goes with their number.
  void repair(const EditableMesh& mesh, const std::vector<Index>& slots);
  /// The living tets with a point in the box, ascending.
  std::vector<Index> tets_in(const EditableMesh& mesh, const Box3& box) const;

 private:
  Box3 block_box(const EditableMesh& mesh, std::size_t block) const;

  std::size_t leaves_ = 0;   ///< a power of two, at least the number of blocks
  std::vector<Box3> boxes_;  ///< the children of node k are 2k and 2k + 1, the root is 1
};

}  // namespace tetwright
