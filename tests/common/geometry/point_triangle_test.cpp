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

TEST(PointTriangle, DegenerateOnesAreSegmentsAndPoints) {
  const Vec3 a(0, 0, 0), b(2, 0, 0);
  EXPECT_DOUBLE_EQ(squared_distance({1, 5, 0}, a, b, a), 25);
  EXPECT_DOUBLE_EQ(squared_distance({1, 5, 0}, a, (a + b) / 2, b), 25);
  EXPECT_DOUBLE_EQ(squared_distance({0, 5, 0}, a, a, a), 25);
}

}  // namespace
}  // namespace tetwright::point_triangle_test
