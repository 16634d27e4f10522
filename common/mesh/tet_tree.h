// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "common/geometry/box_tree.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Barycentric weights, one for each vertex of a tet: none negative, with sum 1 up to rounding.
using TetWeights = std::array<double, 4>;

/// Tet found for a point, with the point's weights in it.
struct FoundTet {
  Index tet = no_index;
  TetWeights weights{};
  double distance = 0;  ///< of the point from the tet, input units
};

/// Tets that are positive and not flat, so that they have weights: tolerance::flat_squared.
std::vector<Index> usable_tets(const TetMesh& mesh);

/// Finds tets by position. Inverted tets count as their mirror images; flat ones contain no point but may be
/// nearest. All functions may be called concurrently. Built in parallel; the result does not depend on the
/// number of threads. About 12 bytes for each tet, 40 during construction.
/// \pre tets in range; the mesh does not change during the tree's lifetime
class TetTree {
 public:
  enum class Order {
    place,          ///< all tets in Morton order
    material_place  ///< grouped by material, so that a search can be restricted to one
  };

  TetTree(const TetMesh& mesh, Order order);
  /// \param tets those to be found; any others are ignored
  TetTree(const TetMesh& mesh, std::vector<Index> tets, Order order = Order::place);

  /// All tets, as a range of positions in the tree's order.
  BoxTree::Range all() const { return tree_.all(); }
  /// Tets of a material, or all tets if there are none. Requires Order::material_place.
  BoxTree::Range of(MaterialTag material) const;

  /// Finds the tet of the range that contains `p`, the first in the tree's order.
  /// \return this tet; if there is none, the tet nearest to `p`, with the smallest index among equals, and
  ///   the weights of its nearest point; no_index if there are no tets or all are farther away than
  ///   `max_distance`
  FoundTet find(const Vec3& p, const BoxTree::Range& range,
                double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Finds the tet with the smallest index that contains `p`, as exact predicates decide; faces, edges and
  /// points belong to a tet. The weights reproduce `p` up to the rounding of its coordinates.
  /// \return this tet; if there is none, the nearest one, as find() does; no_index if there are no tets
  /// \pre all tets are among usable_tets()
  FoundTet find_exactly(const Vec3& p) const;

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
