// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/solver/tet_quadrature.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tetwright {
namespace {

double factorial(int n) { return std::tgamma(n + 1); }

/// Mean of x^i y^j z^k over the tet of the unit vectors and the origin.
double mean_of_monomial(int i, int j, int k) {
  double sum = 0;
  for (const TetQuadraturePoint& q : tet_quadrature()) {
    const Vec3 p = q.in({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)});
    sum += q.weight * std::pow(p.x(), i) * std::pow(p.y(), j) * std::pow(p.z(), k);
  }
  return sum;
}

double closed_form(int i, int j, int k) {
  return 6 * factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
}

TEST(TetQuadrature, IsExactToDegreeFive) {
  for (int i = 0; i <= 5; ++i)
    for (int j = 0; i + j <= 5; ++j)
      for (int k = 0; i + j + k <= 5; ++k)
        EXPECT_NEAR(mean_of_monomial(i, j, k), closed_form(i, j, k), 1e-14) << i << j << k;
  EXPECT_GT(std::abs(mean_of_monomial(8, 0, 0) - closed_form(8, 0, 0)), 1e-9);
}

TEST(TetQuadrature, PointsLieInsideWithPositiveWeights) {
  EXPECT_EQ(tet_quadrature().size(), 64u);
  for (const TetQuadraturePoint& q : tet_quadrature()) {
    EXPECT_GT(q.weight, 0);
    EXPECT_GT(q.barycentric.minCoeff(), 0);
    EXPECT_NEAR(q.barycentric.sum(), 1, 1e-15);
  }
}

}  // namespace
}  // namespace tetwright
