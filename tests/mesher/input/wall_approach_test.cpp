// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/wall_approach.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/mesher/test_surfaces.h"

namespace tetwright {
namespace {

/// A square in a plane of constant height, from -1 to 1.
SheetSurface square(double z) {
  TriangleMesh mesh;
  mesh.points = {Vec3(-1, -1, z), Vec3(1, -1, z), Vec3(1, 1, z), Vec3(-1, 1, z)};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return {"square", mesh, "square.off", true};
}

/// A box whose top is at height 1 and whose sides are far away.
WallApproach in_box(const std::vector<SheetSurface>& sheets = {}) {
  return {std::vector<MaterialSurface>{{"box", 1, make_box(Vec3(-9, -9, -4), Vec3(9, 9, 1)), "box.off"}},
          sheets};
}

/// The direction in the plane of x and z that rises at an angle, and the normal of a surface along y and it.
Vec3 rising(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return {std::cos(angle), 0, std::sin(angle)};
}
Vec3 normal_to(const Vec3& direction) { return direction.cross(Vec3::UnitY()); }

std::optional<PathTurn> turn_from(const WallApproach& walls, const Vec3& from, const Vec3& direction,
                                  double length = 8) {
  return walls.find_turn(from, direction, normal_to(direction), length, 0.2);
}

TEST(WallApproach, PathsTurnWhereTheyAreCloseToAWallAtANarrowAngle) {
  const WallApproach walls = in_box();
  for (const double degrees : {8.0, 15.0, 22.0}) {
    const Vec3 direction = rising(degrees);
    const auto turn = turn_from(walls, Vec3::Zero(), direction);
    ASSERT_TRUE(turn) << degrees;
    EXPECT_NEAR(turn->along, 0.8 / direction.z(), 0.02 / direction.z());
    EXPECT_NEAR(turn->distance, 0.2, 0.01);
    EXPECT_NEAR(turn->towards.z(), 1, 1e-12);
    const ContinuedPath path = walls.path(Vec3::Zero(), direction, 8, 0.2, turn);
    EXPECT_LT(path.ends[1].z(), 1);
    EXPECT_GT(path.ends[2].z(), 1.1);
    const Vec3 last = (path.ends[2] - path.ends[1]).normalized();
    EXPECT_NEAR(std::asin(last.z()) * 180 / std::numbers::pi, 50, 0.1);
    EXPECT_GT(last.x(), 0);  // onwards
  }
}

TEST(WallApproach, WideAnglesStay) {
  EXPECT_FALSE(turn_from(in_box(), Vec3::Zero(), rising(40)));
  EXPECT_FALSE(turn_from(in_box(), Vec3::Zero(), rising(75)));
}

TEST(WallApproach, WiderAnglesTurnCloserToTheWall) {
  const auto turn = turn_from(in_box(), Vec3::Zero(), rising(31));
  ASSERT_TRUE(turn);
  EXPECT_NEAR(turn->distance, 0.2 * (std::cos(31 * std::numbers::pi / 180) - 0.8) / 0.1, 0.01);
}

TEST(WallApproach, PathsThatEndBeforeOrLeaveByAnotherWallStay) {
  EXPECT_FALSE(turn_from(in_box(), Vec3::Zero(), rising(15), 3));
  EXPECT_FALSE(turn_from(in_box(), Vec3(7, 0, 0), rising(15)));
  EXPECT_FALSE(turn_from(in_box(), Vec3::Zero(), rising(0)));
}

TEST(WallApproach, PathsFromOutsideStay) {
  EXPECT_FALSE(turn_from(in_box(), Vec3(0, 0, 2), rising(-15)));
  EXPECT_EQ(in_box().distance(Vec3(0, 0, 2), Vec3::UnitZ(), 5), 0);
  EXPECT_NEAR(in_box().distance(Vec3(0, 0, 0.25), Vec3::UnitZ(), 5), 0.75, 1e-12);
}

TEST(WallApproach, PathsDoNotTurnOntoWallsBehindOtherSheets) {
  EXPECT_FALSE(turn_from(in_box({square(0.5)}), Vec3::Zero(), rising(15)));
  EXPECT_TRUE(turn_from(in_box({square(0)}), Vec3::Zero(), rising(15)));  // its own
}

TEST(WallApproach, PathsBesideOthersTurnEarlier) {
  const WallApproach walls = in_box();
  const Vec3 direction = rising(15);
  const auto other = turn_from(walls, Vec3::Zero(), direction);
  ASSERT_TRUE(other);
  EXPECT_NEAR(other->foot.z(), 1, 1e-12);
  const auto turn = walls.turn_beside(*other, Vec3::Zero(), direction, 2, 8, 0.2);
  ASSERT_TRUE(turn);
  EXPECT_NEAR(turn->distance, 1 - 2 * direction.z(), 1e-12);
  EXPECT_FALSE(walls.turn_beside(*other, Vec3::Zero(), direction, 0.5, 8, 0.2));  // too far from the wall
  EXPECT_FALSE(walls.turn_beside(*other, Vec3::Zero(), direction, 2, 1.5, 0.2));  // after its end
}

TEST(WallApproach, TurnsGoOnBesideTheWallByWhichPathsLeave) {
  const WallApproach walls = in_box();
  const auto other = turn_from(walls, Vec3::Zero(), rising(15));
  ASSERT_TRUE(other);
  const Vec3 from(7, 0, 0.4);  // 2 from the side
  const auto turn = walls.turn_beside(*other, from, Vec3::UnitX(), 2.3, 8, 0.2);
  ASSERT_TRUE(turn);
  EXPECT_NEAR(turn->distance, 0.6, 1e-12);
  EXPECT_FALSE(walls.turn_beside(*other, from, Vec3::UnitX(), 3, 8, 0.2));
}

TEST(WallApproach, StraightPathsHaveNoPointOnTheWall) {
  const WallApproach walls = in_box();
  const ContinuedPath path = walls.path(Vec3(7, 0, 0), Vec3::UnitX(), 8, 0.2, {});
  EXPECT_NEAR(path.ends[0].x(), 9.2, 1e-12);
  EXPECT_NEAR(path.ends[1].x(), 9.4, 1e-12);
  EXPECT_NEAR(path.ends[2].x(), 15, 1e-12);
}

TEST(WallApproach, TrianglesWithoutPointsAreIgnored) {
  TriangleMesh damaged = make_box(Vec3(-9, -9, -4), Vec3(9, 9, 1));
  damaged.triangles.push_back({0, 1, 99});
  const std::vector<MaterialSurface> bodies{{"box", 1, damaged, "box.off"}};
  EXPECT_TRUE(turn_from({bodies, {}}, Vec3::Zero(), rising(15)));
}

}  // namespace
}  // namespace tetwright
