// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/box_tree.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/remesh/change_journal.h"

namespace tetwright {

/// Finds the points of a mesh in a box, and is repaired where points come, go or move: a k-d tree (Bentley
/// 1975) whose leaves hold up to 32 points. A leaf that overflows is halved at its median; two that hold few
/// become one, and an empty one gives its parent's place to the other child. So a tree whose points move away
/// follows them. Time of a change goes with the depth, memory with the number of points: about 12 bytes for
/// each. Working coordinates. One thread at a time.
class PointTree {
 public:
  /// All points of the mesh that have a tet.
  void build(const EditableMesh& mesh);
  /// After points have come, gone or moved: each that changed once, with where it stood before.
  void repair(const EditableMesh& mesh, std::span<const ChangeJournal::OldPoint> changed);
  /// Those in a box, borders included, in no particular order.
  std::vector<Index> points_in(const EditableMesh& mesh, const Box3& box) const;
  /// Nodes and leaves that the memory holds, for tests.
  std::size_t node_slots() const { return nodes_.size(); }

 private:
  struct Node {
    double split = 0;          ///< lower ones go to the first child, all others to the second
    std::int32_t axis = leaf;  ///< or `leaf`
    Index parent = no_index;
    std::array<Index, 2> children{};
    std::vector<Index> points;  ///< of a leaf
  };
  static constexpr std::int32_t leaf = -1;

  void insert(const EditableMesh& mesh, Index point);
  /// `position`: where it stood when it was inserted.
  void erase(Index point, const Vec3& position);
  Index new_node(Index parent);
  void free_node(Index node);
  Index leaf_of(const Vec3& position) const;
  /// Halves a leaf while it has more than `most` points at different places.
  void halve(const EditableMesh& mesh, Index node, std::size_t max_points);
  /// Puts few points of two leaves into one, and takes an empty leaf out.
  void shrink(Index node);

  std::vector<Node> nodes_;  ///< the root first
  std::vector<Index> free_;
};

}  // namespace tetwright
