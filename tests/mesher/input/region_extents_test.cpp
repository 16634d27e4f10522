// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/region_extents.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "tests/mesher/fields.h"

namespace tetwright::region_extents_test {
namespace {

constexpr double pi = std::numbers::pi;

TEST(RegionExtents, BoxAndBallAreMeasuredExactly) {
  const auto box = region_extents(make_input({make_box(Vec3(1, 2, 3), Vec3(3, 5, 4))}));
  ASSERT_TRUE(box[0]);
  EXPECT_NEAR(box[0]->volume, 6, 1e-9);
  EXPECT_NEAR(box[0]->area, 22, 1e-9);
  EXPECT_EQ(box[0]->closed_parts, 1u);
  const auto ball = region_extents(make_input({make_sphere(2)}));
  ASSERT_TRUE(ball[0]);
  EXPECT_NEAR(ball[0]->volume, 32 * pi / 3, 0.01 * ball[0]->volume);
  EXPECT_NEAR(ball[0]->area, 16 * pi, 0.01 * ball[0]->area);
}

TEST(RegionExtents, CavityTakesVolumeAndAddsArea) {
  TriangleMesh cavity = make_sphere(1);
  for (Triangle& t : cavity.triangles) std::swap(t[1], t[2]);
  const auto shell = region_extents(make_input({joined(make_sphere(2), cavity)}));
  ASSERT_EQ(shell.size(), 1u);
  ASSERT_TRUE(shell[0]);
  const RegionExtent outer = *region_extents(make_input({make_sphere(2)}))[0],
                     inner = *region_extents(make_input({make_sphere(1)}))[0];
  EXPECT_NEAR(shell[0]->area, outer.area + inner.area, 1e-9 * outer.area);
  EXPECT_NEAR(shell[0]->volume, outer.volume - inner.volume, 1e-9 * outer.volume);
  EXPECT_EQ(shell[0]->closed_parts, 2u);
}

TEST(RegionExtents, NestedBodiesDivideTheVolumeInAnyOrder) {
  const TriangleMesh outer = make_sphere(2), inner = make_sphere(1, Vec3(0.3, 0, 0)),
                     innermost = make_sphere(0.5, Vec3(0.3, 0, 0));
  const double all = region_extents(make_input({outer}))[0]->volume,
               middle = region_extents(make_input({inner}))[0]->volume,
               least = region_extents(make_input({innermost}))[0]->volume;
  const auto nested = region_extents(make_input({outer, inner, innermost}));
  ASSERT_TRUE(nested[0] && nested[1] && nested[2]);
  EXPECT_NEAR(nested[0]->volume, all - middle, 1e-9 * all);
  EXPECT_NEAR(nested[1]->volume, middle - least, 1e-9 * all);
  EXPECT_NEAR(nested[2]->volume, least, 1e-9 * all);
  EXPECT_EQ(nested[1]->closed_parts, 2u);
}

TEST(RegionExtents, ContactBelongsToBothBodies) {
  const auto boxes = region_extents(
      make_input({make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), make_box(Vec3(1, 0, 0), Vec3(3, 1, 1))}));
  ASSERT_TRUE(boxes[0] && boxes[1]);
  EXPECT_NEAR(boxes[0]->volume, 1, 1e-9);
  EXPECT_NEAR(boxes[0]->area, 6, 1e-9);
  EXPECT_NEAR(boxes[1]->volume, 2, 1e-9);
  EXPECT_NEAR(boxes[1]->area, 10, 1e-9);
  EXPECT_EQ(boxes[0]->open_parts, 2u);
}

}  // namespace
}  // namespace tetwright::region_extents_test
