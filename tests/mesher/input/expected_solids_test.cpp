// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/expected_solids.h"

#include <gtest/gtest.h>

#include "tests/mesher/fields.h"
#include "tests/mesher/test_surfaces.h"

namespace tetwright::expected_solids_test {
namespace {

const TriangleMesh large = make_box(Vec3(0, 0, 0), Vec3(10, 10, 10));

void expect_solid(const std::optional<SurfaceSolid>& solid, double volume, std::size_t components,
                  std::ptrdiff_t handles, std::size_t cavities, SurfaceFlaw flaw = SurfaceFlaw::none) {
  ASSERT_TRUE(solid.has_value());
  EXPECT_EQ(solid->flaw, flaw);
  ASSERT_TRUE(solid->shape.has_value());
  EXPECT_NEAR(solid->shape->volume(), volume, 1e-9 * volume);
  EXPECT_EQ(solid->shape->components(), components);
  EXPECT_EQ(solid->shape->handles(), handles);
  EXPECT_EQ(solid->shape->cavities(), cavities);
}

void expect_none(const std::optional<SurfaceSolid>& solid, SurfaceFlaw flaw) {
  ASSERT_TRUE(solid.has_value());
  EXPECT_EQ(solid->flaw, flaw);
  EXPECT_FALSE(solid->shape.has_value());
}

TEST(ExpectedSolids, OfOneSurface) {
  const TriangleMesh cavity = turned_over(make_box(Vec3(2, 2, 2), Vec3(3, 3, 3)));
  const auto solids =
      expected_solids(make_input({joined(joined(large, cavity), make_box(Vec3(20, 0, 0), Vec3(21, 1, 1)))}));
  ASSERT_EQ(solids.size(), 1u);
  expect_solid(solids[0], 1000 - 1 + 1, 2, 0, 1);
  const auto torus = expected_solids(make_input({make_torus(3, 1)}));
  expect_solid(torus[0], enclosed_volume(make_torus(3, 1)), 1, 1, 0);
}

TEST(ExpectedSolids, LaterBodiesCarveEarlierOnes) {
  const TriangleMesh middle = make_box(Vec3(1, 1, 1), Vec3(5, 5, 5)),
                     inner = make_box(Vec3(2, 2, 2), Vec3(3, 3, 3)),
                     beside = make_box(Vec3(6, 6, 6), Vec3(8, 8, 8)),
                     away = make_box(Vec3(11, 0, 0), Vec3(12, 1, 1));
  const auto solids = expected_solids(make_input({large, middle, inner, beside, away}));
  expect_solid(solids[0], 1000 - 64 - 8, 1, 0, 2);  // the innermost is part of the middle one here
  expect_solid(solids[1], 64 - 1, 1, 0, 1);
  expect_solid(solids[2], 1, 1, 0, 0);
  expect_solid(solids[3], 8, 1, 0, 0);
  expect_solid(solids[4], 1, 1, 0, 0);
}

TEST(ExpectedSolids, JoinedBodiesHaveThoseOfTheirRegions) {
  // The second stands on the first; the third crosses both.
  const std::vector<MaterialSurface> surfaces{{"a", 1, make_box(Vec3(0, 0, 0), Vec3(4, 4, 1)), "a"},
                                              {"b", 2, make_box(Vec3(1, 1, 1), Vec3(3, 3, 3)), "b"},
                                              {"c", 3, make_box(Vec3(-1, 1.5, 0.5), Vec3(5, 2.5, 1.5)), "c"}};
  const auto solids = expected_solids(make_mesher_input(surfaces));
  ASSERT_EQ(solids.size(), 3u);
  expect_solid(solids[0], 16 - 4 * 1 * 0.5, 1, 0, 0, SurfaceFlaw::meeting);
  expect_solid(solids[1], 8 - 2 * 1 * 0.5, 1, 0, 0, SurfaceFlaw::meeting);
  expect_solid(solids[2], 6, 1, 0, 0);
}

TEST(ExpectedSolids, LaterBodiesCoverPartsAndCavities) {
  const TriangleMesh second = make_box(Vec3(20, 0, 0), Vec3(21, 1, 1)),
                     around = make_box(Vec3(19, -1, -1), Vec3(22, 2, 2));
  const auto covered = expected_solids(make_input({joined(large, second), around}));
  expect_solid(covered[0], 1000, 1, 0, 0);
  const TriangleMesh cavity = turned_over(make_box(Vec3(2, 2, 2), Vec3(3, 3, 3))),
                     filling = make_box(Vec3(1, 1, 1), Vec3(4, 4, 4));
  const auto filled = expected_solids(make_input({joined(large, cavity), filling}));
  expect_solid(filled[0], 1000 - 27, 1, 0, 1);
  const TriangleMesh hollow =
      joined(make_box(Vec3(1, 1, 1), Vec3(8, 8, 8)), turned_over(make_box(Vec3(3, 3, 3), Vec3(4, 4, 4))));
  const auto nested = expected_solids(make_input({large, hollow, make_box(Vec3(2, 2, 2), Vec3(5, 5, 5))}));
  expect_solid(nested[0], 1000 - 343, 1, 0, 1);
  expect_solid(nested[1], 343 - 27, 1, 0, 1);
}

TEST(ExpectedSolids, NothingWhereSurfacesDoNotSay) {
  const auto open_ball = [](const Vec3& centre) {
    TriangleMesh ball = make_sphere(1, centre);
    // The rim is a zigzag.
    std::erase_if(ball.triangles,
                  [&](const Triangle& t) { return (ball.points[t[0]] - centre).dot(Vec3(1, 2, 3)) > 2; });
    return ball;
  };
  expect_none(expected_solids(make_input({open_ball(Vec3::Zero())}))[0], SurfaceFlaw::open);
  const auto crossing = expected_solids(make_input({large, make_box(Vec3(5, 5, 5), Vec3(15, 6, 6))}));
  expect_solid(crossing[0], 1000 - 5, 1, 0, 0, SurfaceFlaw::meeting);
  expect_solid(crossing[1], 10, 1, 0, 0);
  // Two boxes with an edge in common.
  const TriangleMesh beside = make_box(Vec3(10, 10, 0), Vec3(20, 20, 10));
  expect_none(expected_solids(make_input({joined(large, beside)}))[0], SurfaceFlaw::touching);
  // An open surface carves the first body.
  const auto carved = expected_solids(make_input({large, open_ball(Vec3(5, 5, 5)), make_sphere(1)}));
  expect_none(carved[0], SurfaceFlaw::open);
  MesherInput layered = make_input({large}, {1.0});
  EXPECT_FALSE(expected_solids(layered)[0]);
}

TEST(ExpectedSolids, AnEstimateWhereAClosedSurfaceIntersectsItself) {
  const TriangleMesh crossing = joined(make_torus(3, 1), make_torus(3.3, 1)),
                     inner = make_box(Vec3(2.8, -0.2, -0.2), Vec3(3.2, 0.2, 0.2));
  const double volume = enclosed_volume(crossing);
  expect_solid(expected_solids(make_input({crossing}))[0], volume, 2, 2, 0, SurfaceFlaw::intersecting);
  // Other surfaces that do not meet it carve it, and are certain on their own.
  const auto carved = expected_solids(make_input({crossing, inner}));
  expect_solid(carved[0], volume - 0.064, 2, 2, 1, SurfaceFlaw::intersecting);
  expect_solid(carved[1], 0.064, 1, 0, 0);
  const auto outer = expected_solids(make_input({make_box(Vec3(-9, -9, -9), Vec3(9, 9, 9)), crossing}));
  expect_solid(outer[0], 5832 - volume, 1, 2, 2, SurfaceFlaw::intersecting);
  // Points with two fans of triangles.
  const TriangleMesh corner = make_box(Vec3(10, 10, 10), Vec3(11, 11, 11));
  expect_solid(expected_solids(make_input({joined(large, corner)}))[0], 1001, 2, 0, 0, SurfaceFlaw::touching);
}

}  // namespace
}  // namespace tetwright::expected_solids_test
