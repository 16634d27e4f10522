// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/laid_curves.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tetwright {
namespace {

/// A roof over the unit square whose ridge is at x = 1/2, in n strips along y.
struct Roof {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;

  explicit Roof(Index n) {
    for (Index i = 0; i <= n; ++i)
      for (Index k = 0; k <= 2; ++k)
        points.emplace_back(k / 2.0, static_cast<double>(i) / n, k == 1 ? 0.1 : 0);
    for (Index i = 0; i < n; ++i)
      for (Index k = 0; k < 2; ++k) {
        const Index a = 3 * i + k;
        triangles.push_back({a, a + 1, a + 4});
        triangles.push_back({a, a + 4, a + 3});
      }
  }
};

double area(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  double out = 0;
  for (const auto& [a, b, c] : triangles)
    out += (points[b] - points[a]).cross(points[c] - points[a]).norm() / 2;
  return out;
}

TEST(LaidCurves, CrossTheRidgeAndKeepTheSurface) {
  Roof roof(7);
  const double before = area(roof.points, roof.triangles);
  const NearCurves curves{{{0.31, 0.13, 0.06}, {0.72, 0.88, 0.05}, {0.2, 0.77, 0.04}},
                          {{0, 1}, {1, 2}, {2, 0}}};
  const auto laid = lay_curves(curves, roof.triangles, 0.02, roof.points);
  ASSERT_TRUE(laid);
  ASSERT_EQ(laid->chains.size(), 3U);
  for (std::size_t s = 0; s < 3; ++s) {
    const std::vector<Index>& chain = laid->chains[s];
    EXPECT_EQ(chain.front(), laid->points[curves.segments[s][0]]);
    EXPECT_EQ(chain.back(), laid->points[curves.segments[s][1]]);
    EXPECT_GT(chain.size(), 3U);
    for (const Index p : chain)
      EXPECT_NEAR(roof.points[p].z(), 0.1 - 0.2 * std::abs(roof.points[p].x() - 0.5), 1e-12);
  }
  EXPECT_NEAR(area(roof.points, laid->triangles), before, 1e-12);
  EXPECT_EQ(laid->source.size(), laid->triangles.size());
}

TEST(LaidCurves, RunThroughPointsNearby) {
  Roof roof(4);
  const std::size_t count = roof.points.size();
  // Along the ridge, but for less than the distance within which they join its points.
  const NearCurves curves{{{0.502, 0.001, 0.1}, {0.498, 0.999, 0.1}}, {{0, 1}}};
  const auto laid = lay_curves(curves, roof.triangles, 0.02, roof.points);
  ASSERT_TRUE(laid);
  EXPECT_EQ(laid->chains[0], (std::vector<Index>{1, 4, 7, 10, 13}));
  EXPECT_EQ(roof.points.size(), count);
  EXPECT_EQ(laid->triangles, roof.triangles);
}

TEST(LaidCurves, AreRefusedAwayFromTheSurfaceOrWhereTheyCross) {
  Roof roof(4);
  const NearCurves away{{{0.3, 0.3, 0.06}, {0.3, 0.3, 0.5}}, {{0, 1}}};
  EXPECT_FALSE(lay_curves(away, roof.triangles, 0.02, roof.points));
  const NearCurves crossing{{{0.2, 0.2, 0.04}, {0.4, 0.4, 0.08}, {0.4, 0.2, 0.08}, {0.2, 0.4, 0.04}},
                            {{0, 1}, {2, 3}}};
  EXPECT_FALSE(lay_curves(crossing, roof.triangles, 0.02, roof.points));
}

}  // namespace
}  // namespace tetwright
