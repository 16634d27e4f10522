// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/point_triangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/random.h"

namespace tetwright::point_triangle_test {
namespace {

TEST(PointTriangle, RegionsOfOneTriangle) {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);
  EXPECT_DOUBLE_EQ(squared_distance({1, 1, 2}, a, b, c), 4);     // above the face
  EXPECT_DOUBLE_EQ(squared_distance({2, -3, 0}, a, b, c), 9);    // beside an edge
  EXPECT_DOUBLE_EQ(squared_distance({-3, -4, 0}, a, b, c), 25);  // beyond a vertex
  EXPECT_DOUBLE_EQ(squared_distance({4, 3, 0}, a, b, c), 5.76);  // across the long side: 12 / 5
}

TEST(PointTriangle, NeverFartherThanAnyPointOfTheTriangle) {
  Random random(3);
  const auto point = [&] { return Vec3(random.uniform(), random.uniform(), random.uniform()); };
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = point(), a = point(), b = point(), c = point();
    const double d = std::sqrt(squared_distance(p, a, b, c));
    double sampled = 10;
    constexpr int steps = 60;
    for (int u = 0; u <= steps; ++u)
      for (int v = 0; u + v <= steps; ++v)
        sampled = std::min(sampled, (a + (b - a) * u / steps + (c - a) * v / steps - p).norm());
    EXPECT_LE(d, sampled + 1e-12);
    EXPECT_GE(d, sampled - 2.0 / steps);
  }
}

TEST(PointTriangle, WeightsGiveThePoint) {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);
  const auto place = [](const std::array<double, 3>& w, const Vec3& p, const Vec3& q, const Vec3& r) -> Vec3 {
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-15);
    return w[0] * p + w[1] * q + w[2] * r;
  };
  for (const Vec3& p : {Vec3(1, 1, 0), Vec3(4, 0, 0), Vec3(2, 1.5, 0), Vec3(0, 0.25, 0)})
    EXPECT_LT((place(weights_in_triangle(p, a, b, c), a, b, c) - p).norm(), 1e-14);
  const Vec3 half = (a + b) / 2, on(1, 0, 0);
  EXPECT_LT((place(weights_in_triangle(on, a, half, b), a, half, b) - on).norm(), 1e-14);
  EXPECT_EQ(weights_in_triangle(b, b, b, b), (std::array<double, 3>{1, 0, 0}));
}

TEST(PointTriangle, DegenerateOnesAreSegmentsAndPoints) {
  const Vec3 a(0, 0, 0), b(2, 0, 0);
  EXPECT_DOUBLE_EQ(squared_distance({1, 5, 0}, a, b, a), 25);
  EXPECT_DOUBLE_EQ(squared_distance({1, 5, 0}, a, (a + b) / 2, b), 25);
  EXPECT_DOUBLE_EQ(squared_distance({0, 5, 0}, a, a, a), 25);
}

TEST(PointTriangle, NeedlesGiveTheNearestPlace) {
  // The nearest point of such a thin triangle is on its long edge, up to its thickness.
  for (const double thickness : {1e-5, 1e-6, 1e-7, 1e-8, 1e-10, 1e-12}) {
    const Vec3 a(0.1, 0.2, 0.3), b = a + Vec3(1, 1, 0.5), across = Vec3(1, -1, 0).normalized();
    const Vec3 c = a + 0.37 * (b - a) + thickness * across;
    for (const double along : {0.05, 0.3, 0.37, 0.6, 0.95})
      for (const double away : {0.0, 1e-9, 1e-3, 0.5}) {
        const Vec3 p = a + along * (b - a) - away * across;
        EXPECT_NEAR((p - closest_point(p, a, b, c)).norm(), away, 1e-12) << thickness << " " << along;
      }
  }
}

}  // namespace
}  // namespace tetwright::point_triangle_test
