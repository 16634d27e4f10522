// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "common/samples/samples.h"
#include "tetwright/label_volume.h"
#include "tetwright/sizes.h"
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

TEST(CoordinateSpace, OfSizesChangesWhereTheyAre) {
  TetMesh tet{{{1, 2, 3}, {2, 2, 3}, {1, 3, 3}, {1, 2, 4}}, {{0, 1, 2, 3}}, {1}, {}};
  tet.space = lps;
  const std::shared_ptr<const SizeSource> sizes = tet_mesh_sizes(tet, {5, 6, 7, 8}, "size");
  EXPECT_EQ(sizes->space(), lps);
  const auto changed = change_space(sizes, lps, ras);
  ASSERT_TRUE(changed);
  EXPECT_EQ(changed->space(), ras);
  EXPECT_EQ(changed->field(), "size");
  EXPECT_TRUE(changed->fills_space());
  EXPECT_FALSE(changed->at({1, 2, 3}));
  ASSERT_TRUE(changed->at({-2, -2, 3}));
  EXPECT_EQ(changed->at({-2, -2, 3})->length, 6);
  std::vector<Vec3> places;
  changed->for_each_value([&](const Vec3& place, double) { places.push_back(place); });
  EXPECT_EQ(places, (std::vector<Vec3>{{-1, -2, 3}, {-2, -2, 3}, {-1, -3, 3}, {-1, -2, 4}}));
  for (const auto& [from, to] : {std::pair{"", lps}, {lps, ""}, {lps, lps}, {lps, "scanner-xyz"}})
    EXPECT_FALSE(change_space(sizes, from, to));
}

}  // namespace
}  // namespace tetwright::coordinate_space_test
