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

/// Finds the points of a mesh in a box. A k-d tree (Bentley 1975) with up to 32 points in a leaf, updated
/// when points are added, removed or moved: an overflowing leaf is halved at its median, two leaves with few
/// points are merged, and an empty leaf is removed together with its parent, whose other child moves up. The
/// tree thus adapts to moving points. The time of an update is proportional to the depth, memory to the
/// number of points (about 12 bytes each). Working coordinates. One thread at a time.
class PointTree {
 public:
  /// Builds the tree of all live points.
  void build(const EditableMesh& mesh);
  /// Updates the tree after points were added, removed or moved.
  ///
  /// \param changed each changed point once, with its old position.
  void repair(const EditableMesh& mesh, std::span<const ChangeJournal::OldPoint> changed);
  /// The points in a box, borders included, in no particular order.
  std::vector<Index> points_in(const EditableMesh& mesh, const Box3& box) const;
  /// Number of nodes for which memory is allocated; for tests.
  std::size_t node_slots() const { return nodes_.size(); }

 private:
  struct Node {
    double split = 0;          ///< points below it are in the first child, all others in the second
    std::int32_t axis = leaf;  ///< split axis, or `leaf`
    Index parent = no_index;
    std::array<Index, 2> children{};
    std::vector<Index> points;  ///< points of a leaf
  };
  static constexpr std::int32_t leaf = -1;

  void insert(const EditableMesh& mesh, Index point);
  /// \param position of the point when it was inserted.
  void erase(Index point, const Vec3& position);
  Index new_node(Index parent);
  void free_node(Index node);
  Index leaf_of(const Vec3& position) const;
  /// Halves a leaf until each part has at most `max_points` points or only coincident points.
  void halve(const EditableMesh& mesh, Index node, std::size_t max_points);
  /// Merges two sibling leaves with few points, and removes an empty leaf.
  void shrink(Index node);

  std::vector<Node> nodes_;  ///< the root first
  std::vector<Index> free_;
};

}  // namespace tetwright
