// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace tetwright {

/// The i-th point of a low-discrepancy sequence in a triangle, as barycentric coordinates of the second and
/// third corner. Points of the unit square (Roberts 2018, "The unreasonable effectiveness of quasirandom
/// sequences", powers of the plastic number's inverse) are folded into the lower triangle.
inline std::array<double, 2> low_discrepancy_barycentric(std::size_t i) {
  constexpr double first_step = 0.7548776662466927, second_step = 0.5698402909980532;
  constexpr std::size_t period = 1 << 20;  // limits the rounding of the products below
  const auto n = static_cast<double>(i % period);
  double u = 0.5 + n * first_step, v = 0.5 + n * second_step;
  u -= std::floor(u);
  v -= std::floor(v);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return {u, v};
}

}  // namespace tetwright
