// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "common/geometry/box_tree.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// Weights, one for each vertex of a tet; none negative, their sum is 1 but for rounding.
using TetWeights = std::array<double, 4>;

/// A tet found for a point, and the point's weights in it.
struct FoundTet {
  Index tet = no_index;
  TetWeights weights{};
};

/// Finds tets by place. Inverted tets count as their mirror images; flat ones hold nothing, but may be
/// nearest. The mesh, whose tets are in range, may not change while the tree lives. All functions may be
/// called concurrently. Built in parallel; the same for any number of threads. About 12 bytes for each tet,
/// 40 while it is built.
class TetTree {
 public:
  enum class Order {
    place,          ///< all tets in Morton order
    material_place  ///< those of each material together, so that a search may be restricted to one
  };

  TetTree(const TetMesh& mesh, Order order);

  /// All tets, as positions in the tree's order.
  BoxTree::Range all() const { return tree_.all(); }
  /// The tets of a material, or all if it has none. Only with Order::material_place.
  BoxTree::Range of(MaterialTag material) const;

  /// A tet of the range that contains `p`, the first in the tree's order, or else the one nearest to it,
  /// with the weights of its nearest place, of several the one of the smallest number; no_index without tets,
  /// or where all of them are farther away than `max_distance`.
  FoundTet find(const Vec3& p, const BoxTree::Range& range,
                double max_distance = std::numeric_limits<double>::infinity()) const;

 private:
  using Corners = std::array<Vec3, 4>;

  Corners corners(Index t) const;
  void sort(Order order);
  FoundTet find_containing(const Vec3& p, const BoxTree::Range& range) const;
  FoundTet find_nearest(const Vec3& p, const BoxTree::Range& range, double max_distance) const;

  const TetMesh& mesh_;
  std::vector<Index> tets_;  ///< in the tree's order
  BoxTree tree_;
};

}  // namespace tetwright
