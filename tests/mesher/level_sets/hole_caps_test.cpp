// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/hole_caps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "mesher/tuning/distance_tuning.h"
#include "tests/mesher/test_surfaces.h"

namespace tetwright::hole_caps_test {
namespace {

const Vec3 centre(20.2, 19.7, 20.4);
constexpr double radius = 9.3;

/// An inside without any surface: a ball whose winding number decreases slowly.
GridReading ball(int x, int y, int z) {
  const double w = DistanceTuning::Caps::inside_winding + 0.02 * (radius - (Vec3(x, y, z) - centre).norm());
  return {w >= DistanceTuning::Caps::inside_winding ? -3.0 : 3.0, w};
}

std::vector<GridEdge> ball_seed() {
  int z = 20;
  while (ball(20, 20, z + 1).distance < 0) ++z;
  return {{morton_encode(20, 20, z), 2}};
}

TEST(HoleCaps, GoesAllAroundFromOneEdge) {
  const TriangleMesh cap = cap_holes(ball_seed(), ball, nullptr);
  for (const Vec3& p : cap.points) EXPECT_NEAR((p - centre).norm(), radius, 0.3);
  EXPECT_NEAR(enclosed_volume(cap), 4.18879 * radius * radius * radius, 100);  // oriented outwards
  std::map<std::pair<Index, Index>, int> sides;
  for (const Triangle& t : cap.triangles)
    for (int k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      sides[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  for (const auto& [edge, balance] : sides) EXPECT_EQ(balance, 0);
}

// One half has a surface. The cap ends where the surface begins.
TEST(HoleCaps, EndsAtTheSurface) {
  const auto read = [](int x, int y, int z) {
    GridReading reading = ball(x, y, z);
    if (z < 20) reading.distance = std::clamp((Vec3(x, y, z) - centre).norm() - radius, -3.0, 3.0);
    return reading;
  };
  const TriangleMesh cap = cap_holes(ball_seed(), read, nullptr);
  ASSERT_FALSE(cap.triangles.empty());
  for (const Vec3& p : cap.points) EXPECT_GT(p.z(), 18);
}

TEST(HoleCaps, NothingToCap) { EXPECT_TRUE(cap_holes({}, ball, nullptr).triangles.empty()); }

TEST(HoleCaps, CanBeCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(cap_holes(ball_seed(), ball, &progress), Interrupted);
}

}  // namespace
}  // namespace tetwright::hole_caps_test
