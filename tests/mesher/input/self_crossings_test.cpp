// SPDX-License-Identifier: Apache-2.0

// Bodies whose surface crosses itself.
#include "mesher/input/self_crossings.h"

#include <gtest/gtest.h>

#include "common/geometry/self_intersection.h"
#include "tests/common/features/parts.h"

namespace tetwright::self_crossings_test {
namespace {

/// Two unit cubes in one surface, the second one shifted.
TriangleMesh crossing_cubes(const Vec3& shift) {
  TriangleMesh both = unit_cube();
  const TriangleMesh second = unit_cube();
  const auto first = static_cast<Index>(both.points.size());
  for (const Vec3& p : second.points) both.points.push_back(p + shift);
  for (const Triangle& t : second.triangles)
    both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return both;
}

TEST(SelfCrossings, CurvesOfAPartBecomeEdges) {
  const MesherInput input =
      make_mesher_input({{"part", 1, crossing_cubes(Vec3(0.5, 0.25, 0.125)), "part.off"}});
  ASSERT_EQ(input.bodies.size(), 1U);
  const RepairedSurface& s = input.bodies[0].surface;
  EXPECT_TRUE(self_intersections(s.points, s.triangles).empty());
  EXPECT_FALSE(s.intersects_itself);
  EXPECT_EQ(s.closed, s.triangles.size());
  EXPECT_NEAR(s.volume, 2 - 0.5 * 0.75 * 0.875, 1e-12);
  // Something is left of each of the 12 sides.
  const SurfacePatches patches = find_patches(s.points, s.triangles, {}, {}, "part.off");
  EXPECT_EQ(patches.verdict, SurfacePatches::Verdict::part);
  EXPECT_EQ(patches.count, 12U);
}

TEST(SelfCrossings, OpenSurfacesStayAsTheyAre) {
  MesherInput::Body body;
  const TriangleMesh cubes = crossing_cubes(Vec3(0.5, 0.25, 0.125));
  body.surface.points = cubes.points;
  body.surface.triangles = cubes.triangles;
  body.surface.intersects_itself = true;
  body.surface.closed = cubes.triangles.size() - 1;
  EXPECT_FALSE(resolve_self_crossings(body, 1e-5, nullptr));
  body.surface.closed = cubes.triangles.size();
  EXPECT_TRUE(resolve_self_crossings(body, 1e-5, nullptr));
  EXPECT_FALSE(resolve_self_crossings(body, 1e-5, nullptr)) << "there is nothing left to resolve";
}

}  // namespace
}  // namespace tetwright::self_crossings_test
