// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "simplify/operations/block_rules.h"

namespace tetwright {

/// The best triangulation of a polygon p[0..n-1] between the ends a (below) and b (above) of an edge: its
/// worst tet is as good as possible. By the dynamic program of Klincsek (1980, "Minimal triangulations of
/// polygonal domains") as Shewchuk (2002) uses it. O(n^3).
class RingTriangulation {
 public:
  static constexpr std::size_t max_points = 8;  ///< a chain of seven tets has eight

  /// False if no triangulation has only tets better than `limit`. The polygon must live until triangles() was
  /// called.
  bool find(const EditableMesh& mesh, const BlockRules& rules, Index a, Index b,
            const std::vector<Index>& polygon, float limit);

  /// Calls f(i, k, j) for each triangle, places in the polygon in ascending order.
  template <class F>
  void triangles(const F& f) const {
    triangles(0, polygon_->size() - 1, f);
  }

 private:
  template <class F>
  void triangles(std::size_t i, std::size_t j, const F& f) const {
    if (j < i + 2) return;
    const std::size_t k = middle_[i][j];
    f(i, k, j);
    triangles(i, k, f);
    triangles(k, j, f);
  }

  const std::vector<Index>* polygon_ = nullptr;
  /// The worst tet's quality of the best triangulation of p[i..j], and the third corner of the triangle at
  /// its closing edge.
  std::array<std::array<float, max_points>, max_points> best_{};
  std::array<std::array<std::size_t, max_points>, max_points> middle_{};
};

}  // namespace tetwright
