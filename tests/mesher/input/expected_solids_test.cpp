// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/expected_solids.h"

#include <gtest/gtest.h>

#include "tests/mesher/fields.h"
#include "tests/mesher/test_surfaces.h"

namespace tetwright::expected_solids_test {
namespace {

const TriangleMesh large = make_box(Vec3(0, 0, 0), Vec3(10, 10, 10));

void expect_solid(const std::optional<SolidShape>& solid, double volume, std::size_t components,
                  std::ptrdiff_t handles, std::size_t cavities) {
  ASSERT_TRUE(solid.has_value());
  EXPECT_NEAR(solid->volume(), volume, 1e-9 * volume);
  EXPECT_EQ(solid->components(), components);
  EXPECT_EQ(solid->handles(), handles);
  EXPECT_EQ(solid->cavities(), cavities);
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
  expect_solid(solids[0], 1000 - 64 - 8, 1, 0, 2);  // the innermost is a part of the middle one here
  expect_solid(solids[1], 64 - 1, 1, 0, 1);
  expect_solid(solids[2], 1, 1, 0, 0);
  expect_solid(solids[3], 8, 1, 0, 0);
  expect_solid(solids[4], 1, 1, 0, 0);
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
  EXPECT_FALSE(expected_solids(make_input({punctured(make_sphere(1), 40)}))[0]);
  EXPECT_FALSE(expected_solids(make_input({joined(make_sphere(1), make_sphere(1, Vec3(1, 0, 0)))}))[0]);
  const auto crossing = expected_solids(make_input({large, make_box(Vec3(5, 5, 5), Vec3(15, 6, 6))}));
  EXPECT_FALSE(crossing[0]);
  EXPECT_TRUE(crossing[1]);
  MesherInput layered = make_input({large}, {1.0});
  EXPECT_FALSE(expected_solids(layered)[0]);
}

}  // namespace
}  // namespace tetwright::expected_solids_test
