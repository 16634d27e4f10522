// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "common/samples/samples.h"
#include "tetwright/label_volume.h"
#include "tetwright/surface_mesh.h"

namespace tetwright::coordinate_space_test {
namespace {

const char* const lps = "left-posterior-superior";
const char* const ras = "right-anterior-superior";

/// Positive if the triangles are counter-clockwise seen from outside.
double volume_of(const TriangleMesh& surface) {
  double six = 0;
  for (const Triangle& t : surface.triangles)
    six += surface.points[t[0]].dot(surface.points[t[1]].cross(surface.points[t[2]]));
  return six / 6;
}

TEST(CoordinateSpace, OfASurfaceChangesByARotation) {
  const auto sample = std::get<TriangleMesh>(make_sample("torus"));
  TriangleMesh surface = sample;
  surface.space = lps;
  EXPECT_TRUE(change_space(surface, ras));
  EXPECT_EQ(surface.space, ras);
  EXPECT_EQ(surface.triangles, sample.triangles);
  for (std::size_t p = 0; p < sample.points.size(); ++p) {
    const Vec3& q = sample.points[p];
    ASSERT_EQ(surface.points[p], Vec3(-q.x(), -q.y(), q.z()));
  }
}

TEST(CoordinateSpace, AReflectionKeepsTheOrientation) {
  auto surface = std::get<TriangleMesh>(make_sample("torus"));
  surface.space = ras;
  const double before = volume_of(surface), x = surface.points[1].x(), y = surface.points[1].y();
  EXPECT_TRUE(change_space(surface, "left-anterior-superior"));
  EXPECT_EQ(surface.points[1].x(), -x);
  EXPECT_EQ(surface.points[1].y(), y);
  EXPECT_GT(before, 0);
  EXPECT_DOUBLE_EQ(volume_of(surface), before);
}

TEST(CoordinateSpace, AnUnknownOneIsKept) {
  for (const auto& [from, to] : {std::pair{"", lps}, {lps, ""}, {lps, lps}, {lps, "scanner-xyz"}}) {
    TriangleMesh surface{{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}, {{0, 1, 2}}};
    surface.space = from;
    EXPECT_FALSE(change_space(surface, to));
    EXPECT_EQ(surface.space, from);
    EXPECT_EQ(surface.points[0], Vec3(1, 2, 3));
  }
}

}  // namespace
}  // namespace tetwright::coordinate_space_test
