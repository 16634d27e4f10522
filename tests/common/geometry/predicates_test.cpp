// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/predicates.h"

#include <gtest/gtest.h>

#include "common/random.h"

namespace tetwright::predicates_test {
namespace {

Vec3 random_point(Random& random) { return {random.uniform(), random.uniform(), random.uniform()}; }

TEST(Predicates, SignOfTheUnitTet) {
  const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_EQ(orient3d(o, x, y, z), 1);
  EXPECT_EQ(orient3d(o, y, x, z), -1);
  EXPECT_EQ(orient3d_value(o, x, y, z), 1);
}

// On a plane through integer points the rounded determinant is mostly rounding error; one ulp off the plane
// its sign is known.
TEST(Predicates, OneUlpOffAPlaneIsSeen) {
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    // Whole numbers up to 2^20 in the plane z = x + y, shifted far away, so that every coordinate is exact.
    const auto on_plane = [&] {
      const double u = random.below(1u << 20), v = random.below(1u << 20);
      return Vec3(u + 0x1p30, v + 0x1p30, u + v + 0x1p31);
    };
    const Vec3 a = on_plane(), b = on_plane(), c = on_plane();
    Vec3 d = on_plane();
    EXPECT_EQ(orient3d(a, b, c, d), 0);
    // A point above the plane is positive if (a, b, c) turns counter-clockwise seen from above.
    const int turn = orient2d(a, b, c, 0, 1);
    if (turn == 0) continue;
    d.z() = std::nextafter(d.z(), 1e300);
    EXPECT_EQ(orient3d(a, b, c, d), turn);
  }
}

// Even permutations preserve the sign, odd ones reverse it. Near zero this requires exact arithmetic.
TEST(Predicates, PermutationsAgreeNearZero) {
  Random random(8);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 a = random_point(random), b = random_point(random), c = random_point(random);
    const double u = random.uniform(), v = random.uniform();
    const Vec3 d = a + u * (b - a) + v * (c - a);
    const int s = orient3d(a, b, c, d);
    EXPECT_EQ(orient3d(b, c, a, d), s);
    EXPECT_EQ(orient3d(b, a, d, c), s);
    EXPECT_EQ(orient3d(b, a, c, d), -s);
    EXPECT_EQ(orient3d(d, b, c, a), -s);
  }
}

TEST(Predicates, ExtremeScalesAreExact) {
  for (double scale : {0x1p-1000, 0x1p-340, 0x1p-1060, 0x1p340, 0x1p1000}) {
    const Vec3 o = Vec3::Zero(), x(scale, 0, 0), y(0, scale, 0), z(0, 0, scale);
    EXPECT_EQ(orient3d(o, x, y, z), 1) << scale;
    EXPECT_EQ(orient3d(o, y, x, z), -1) << scale;
    EXPECT_EQ(orient3d(x, y, z, Vec3((x + y) * 0.5)), 0) << scale;
    EXPECT_EQ(orient2d(o, x, y, 0, 1), 1) << scale;
  }
}

}  // namespace
}  // namespace tetwright::predicates_test
