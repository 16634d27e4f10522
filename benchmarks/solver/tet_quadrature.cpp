// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/solver/tet_quadrature.h"

#include <cmath>

namespace tetwright {

namespace {

struct GaussPoint {
  double place, weight;
};

/// Gauss-Legendre rule of four points on [0, 1], exact to degree 7.
std::array<GaussPoint, 4> gauss_points() {
  const double inner = std::sqrt(3. / 7 - 2. / 7 * std::sqrt(6. / 5));
  const double outer = std::sqrt(3. / 7 + 2. / 7 * std::sqrt(6. / 5));
  const double inner_weight = (18 + std::sqrt(30.)) / 72, outer_weight = (18 - std::sqrt(30.)) / 72;
  return {{{(1 - outer) / 2, outer_weight},
           {(1 - inner) / 2, inner_weight},
           {(1 + inner) / 2, inner_weight},
           {(1 + outer) / 2, outer_weight}}};
}

std::vector<TetQuadraturePoint> collapsed_cube() {
  std::vector<TetQuadraturePoint> points;
  const auto gauss = gauss_points();
  for (const GaussPoint& r : gauss)
    for (const GaussPoint& s : gauss)
      for (const GaussPoint& t : gauss) {
        const double x = r.place, y = (1 - x) * s.place, z = (1 - x) * (1 - s.place) * t.place;
        // Jacobian determinant of the collapse, divided by the tet's volume 1/6.
        const double stretch = 6 * (1 - x) * (1 - x) * (1 - s.place);
        points.push_back({{1 - x - y - z, x, y, z}, stretch * r.weight * s.weight * t.weight});
      }
  return points;
}

}  // namespace

const std::vector<TetQuadraturePoint>& tet_quadrature() {
  static const std::vector<TetQuadraturePoint> points = collapsed_cube();
  return points;
}

}  // namespace tetwright
