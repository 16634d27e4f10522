// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_extents.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/mesher/label_volumes.h"
#include "tetwright/resources.h"

namespace tetwright::label_extents_test {
namespace {

constexpr double pi = std::numbers::pi;

LabelInput ball_of(double radius, const Eigen::Matrix3d& directions) {
  const Vec3 centre = directions * Vec3::Constant(19.5);
  return make_labels(
      {40, 40, 40},
      [&](int x, int y, int z) { return (directions * Vec3(x, y, z) - centre).norm() < radius ? 1 : 0; },
      directions);
}

TEST(LabelExtents, BallHasItsAreaWithVoxelsOfAnyShape) {
  for (const Vec3& spacing : {Vec3(1, 1, 1), Vec3(1, 1, 2), Vec3(0.7, 1, 1.6)}) {
    const double radius = 15 * spacing.minCoeff();
    const std::vector<RegionExtent> found = label_extents(ball_of(radius, spacing.asDiagonal()));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].area, 4 * pi * radius * radius, 0.04 * found[0].area) << spacing.transpose();
    EXPECT_NEAR(found[0].volume, 4 * pi / 3 * radius * radius * radius, 0.02 * found[0].volume);
    EXPECT_EQ(found[0].closed_parts, 1u);
  }
}

TEST(LabelExtents, PlateAlongTheAxesHasItsAreaUpToTheBorder) {
  // It reaches the border of the volume, where the mesh has faces, too.
  const RegionExtent plate =
      label_extents(make_labels({50, 50, 9}, [](int, int, int z) { return z == 4 ? 1 : 0; }))[0];
  // Areas along the axes are 7 % too small, those of voxels at edges somewhat more.
  EXPECT_NEAR(plate.area, 2 * 2500 + 4 * 50, 0.1 * 5200);
  EXPECT_NEAR(plate.volume, 2500, 1e-9);
}

TEST(LabelExtents, ContactsCountOnBothSidesAndThreadsDoNotMatter) {
  const LabelInput halves = make_labels({40, 40, 40}, [](int x, int y, int z) {
    return (Vec3(x, y, z) - Vec3::Constant(19.5)).norm() < 15 ? (x < 20 ? 1 : 2) : 0;
  });
  const std::vector<RegionExtent> found = label_extents(halves);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].area, 3 * pi * 225, 0.06 * found[0].area);
  EXPECT_NEAR(found[1].area, found[0].area, 1e-9 * found[0].area);
  EXPECT_EQ(found[0].open_parts, 2u);
  EXPECT_EQ(found[0].closed_parts, 0u);
  with_threads(1, [&] { EXPECT_EQ(label_extents(halves)[0].area, found[0].area); });
  with_threads(7, [&] { EXPECT_EQ(label_extents(halves)[0].area, found[0].area); });
}

TEST(LabelExtents, InterfaceIsClosedWhereOneSideHasNoOther) {
  // Two balls of one label and one of another in a larger one.
  const auto in = [](int x, int y, int z, const Vec3& centre, double radius) {
    return (Vec3(x, y, z) - centre).norm() < radius;
  };
  const std::vector<RegionExtent> found = label_extents(make_labels({40, 40, 40}, [&](int x, int y, int z) {
    if (in(x, y, z, Vec3(12, 19, 19), 5) || in(x, y, z, Vec3(26, 19, 12), 5)) return 2;
    if (in(x, y, z, Vec3(24, 19, 27), 4)) return 3;
    return in(x, y, z, Vec3::Constant(19.5), 18) ? 1 : 0;
  }));
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].closed_parts, 4u);
  EXPECT_EQ(found[1].closed_parts, 2u);
  EXPECT_EQ(found[2].closed_parts, 1u);
  for (const RegionExtent& e : found) EXPECT_EQ(e.open_parts, 0u);
}

}  // namespace
}  // namespace tetwright::label_extents_test
