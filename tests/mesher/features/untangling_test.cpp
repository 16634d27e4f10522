// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/untangling.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/geometry/predicates.h"

namespace tetwright {
namespace {

/// The star of a point inside an octahedron.
struct Star {
  std::vector<Vec3> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 0, 0}};
  std::vector<Tet> tets;
  std::vector<PointFreedom> freedom = std::vector<PointFreedom>(7, {0});

  Star() {
    freedom[6].dimensions = 3;
    for (const Index x : {0, 1})
      for (const Index y : {2, 3})
        for (const Index z : {4, 5}) {
          Tet t{x, y, z, 6};
          if (!is_positive(t)) std::swap(t[0], t[1]);
          tets.push_back(t);
        }
  }
  bool is_positive(const Tet& t) const {
    return orient3d(points[t[0]], points[t[1]], points[t[2]], points[t[3]]) > 0;
  }
  bool all_positive() const {
    return std::all_of(tets.begin(), tets.end(), [&](const Tet& t) { return is_positive(t); });
  }
};

TEST(Untangling, APointOutsideItsStarReturns) {
  for (const Vec3& away : {Vec3(2, 0.3, 0.1), Vec3(-5, 4, 3), Vec3(0.4, 0.4, 0.4)}) {
    Star star;
    star.points[6] = away;
    ASSERT_FALSE(star.all_positive());
    EXPECT_TRUE(untangle(star.points, star.tets, star.freedom)) << away.transpose();
    EXPECT_TRUE(star.all_positive()) << away.transpose();
  }
}

TEST(Untangling, LockedPointsStay) {
  Star star;
  const std::vector<Vec3> before = star.points;
  star.points[6] = {3, 1, 1};
  untangle(star.points, star.tets, star.freedom);
  for (std::size_t p = 0; p < 6; ++p) EXPECT_EQ(star.points[p], before[p]);
}

TEST(Untangling, FailsWhereNothingIsPositive) {
  Star star;
  star.freedom[6].dimensions = 0;
  star.points[6] = {3, 1, 1};
  EXPECT_FALSE(untangle(star.points, star.tets, star.freedom));
}

TEST(Untangling, PointsStayOnTheirLineOrPlane) {
  for (const int dimensions : {1, 2}) {
    Star star;
    const Vec3 along = Vec3(1, 2, -1).normalized(), across = Vec3(1, 0, 1).normalized();
    star.freedom[6] = {dimensions, {along, across, along.cross(across)}};
    star.points[6] = 3 * along;
    EXPECT_TRUE(untangle(star.points, star.tets, star.freedom));
    EXPECT_TRUE(star.all_positive());
    EXPECT_NEAR(star.points[6].dot(along.cross(across)), 0, 1e-12);
    if (dimensions == 1) EXPECT_NEAR(star.points[6].dot(across), 0, 1e-12);
  }
}

TEST(Untangling, ScaleDoesNotMatter) {
  Star star;
  star.points[6] = {2, 0.3, 0.1};
  for (Vec3& p : star.points) p *= 1e-6;
  EXPECT_TRUE(untangle(star.points, star.tets, star.freedom));
}

}  // namespace
}  // namespace tetwright
