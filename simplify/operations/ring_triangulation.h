// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "simplify/operations/block_rules.h"

namespace tetwright {

/// The triangulation of a polygon p[0..n-1] between the ends a (below) and b (above) of an edge whose worst
/// tet is best. Dynamic program of Klincsek (1980, "Minimal triangulations of polygonal domains") as used by
/// Shewchuk (2002). O(n^3).
class RingTriangulation {
 public:
  static constexpr std::size_t max_points = 8;  ///< a chain of seven tets has eight

  /// Finds the best triangulation. False if each has a tet no better than `limit`.
  ///
  /// \param polygon must outlive the calls of triangles().
  bool find(const EditableMesh& mesh, const BlockRules& rules, Index a, Index b,
            const std::vector<Index>& polygon, float limit);

  /// Calls f(i, k, j) for each triangle: indices into the polygon, ascending.
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
  /// For p[i..j]: the best triangulation's worst quality, and the third corner of its triangle at the edge
  /// (i, j).
  std::array<std::array<float, max_points>, max_points> best_{};
  std::array<std::array<std::size_t, max_points>, max_points> middle_{};
};

}  // namespace tetwright
