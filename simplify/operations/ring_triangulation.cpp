// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/ring_triangulation.h"

#include <algorithm>
#include <limits>

namespace tetwright {

bool RingTriangulation::find(const EditableMesh& mesh, const BlockRules& rules, Index a, Index b,
                             const std::vector<Index>& polygon, float limit) {
  polygon_ = &polygon;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i + 1 < n; ++i) best_[i][i + 1] = std::numeric_limits<float>::infinity();
  for (std::size_t length = 2; length < n; ++length)
    for (std::size_t i = 0; i + length < n; ++i) {
      const std::size_t j = i + length;
      best_[i][j] = 0;
      for (std::size_t k = i + 1; k < j; ++k) {
        const float known = std::min(best_[i][k], best_[k][j]);
        if (known <= limit || known <= best_[i][j]) continue;
        const float above = quality_of(mesh, rules, {polygon[i], polygon[k], polygon[j], b});
        if (above <= limit || above <= best_[i][j]) continue;
        const float below = quality_of(mesh, rules, {polygon[i], polygon[j], polygon[k], a});
        const float value = std::min({known, above, below});
        if (value <= limit || value <= best_[i][j]) continue;
        best_[i][j] = value;
        middle_[i][j] = k;
      }
    }
  return best_[0][n - 1] > limit;
}

}  // namespace tetwright
