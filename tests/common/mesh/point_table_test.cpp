// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/point_table.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "common/random.h"

namespace tetwright::point_table_test {
namespace {

TEST(PointTable, TheFirstOfEqualPointsStands) {
  Random random(11);
  std::vector<Vec3> points(20000);
  for (Vec3& p : points) p = Vec3(random.below(16), random.below(16), random.below(16)) / 7;
  PointTable table(points);
  std::map<std::array<double, 3>, Index> first;
  for (Index i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    const Index expected = first.try_emplace({p.x(), p.y(), p.z()}, i).first->second;
    ASSERT_EQ(table.add(i), expected);
  }
  for (const Vec3& p : points) ASSERT_EQ(table.find(p), first.at({p.x(), p.y(), p.z()}));
  EXPECT_EQ(table.find({0.5, 0, 0}), no_index);
}

TEST(PointTable, MinusZeroIsZeroAndNaNIsNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> points{{0.0, 1, 0.0}, {-0.0, 1, -0.0}, {nan, 0, 0}, {nan, 0, 0}};
  PointTable table(points, points.size());
  EXPECT_EQ(table.add(0), 0u);
  EXPECT_EQ(table.add(1), 0u);
  EXPECT_EQ(table.add(2), 2u);
  EXPECT_EQ(table.add(3), 3u);
  EXPECT_EQ(table.find(points[3]), no_index);
}

}  // namespace
}  // namespace tetwright::point_table_test
