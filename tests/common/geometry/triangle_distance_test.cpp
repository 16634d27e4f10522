// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/triangle_distance.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/geometry/point_triangle.h"
#include "common/random.h"

namespace tetwright {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

TEST(TriangleDistance, IsThatOfTheNearestPoint) {
  Random random(8);
  const auto number = [&] { return 2 * random.uniform() - 1; };
  const auto anywhere = [&] { return Vec3(number(), number(), number()); };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = anywhere(), b = anywhere();
    Vec3 c = anywhere();
    if (i % 5 == 0) c = a + (0.001 * number()) * (b - a) + 1e-3 * anywhere();  // a needle
    const TriangleDistance triangle(a, b, c);
    for (int k = 0; k < 20; ++k) {
      const Vec3 p = 2 * anywhere();
      const double truth = squared_distance(p, a, b, c);
      EXPECT_NEAR(triangle.squared(p, unbounded), truth, 1e-9);
      EXPECT_EQ(triangle.squared(p, truth / 2), truth / 2);
    }
    for (const Vec3& p : {a, b, c, Vec3((a + b + c) / 3)}) EXPECT_NEAR(triangle.squared(p, 1), 0, 1e-12);
  }
}

TEST(TriangleDistance, OfAFlatOneIsThatOfItsEdges) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(3, 0, 0);
  const TriangleDistance line(a, c, b), point(b, b, b), edge(a, b, b);
  EXPECT_NEAR(line.squared({2, 1, 0}, unbounded), 1, 1e-15);
  EXPECT_NEAR(line.squared({5, 0, 0}, unbounded), 4, 1e-15);
  EXPECT_NEAR(point.squared({1, 2, 0}, unbounded), 4, 1e-15);
  EXPECT_NEAR(edge.squared({0.5, 0, 3}, unbounded), 9, 1e-15);
}

}  // namespace
}  // namespace tetwright
