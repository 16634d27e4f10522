// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/projection_tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/random.h"

namespace tetwright {
namespace {

TEST(ProjectionTree, FindsWhatASearchOfAllFinds) {
  Random random(4);
  const auto number = [&] { return 2 * random.uniform() - 1; };
  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> items;
  for (Index i = 0; i < 500; ++i) {
    const Vec3 c(number(), number(), number());
    for (int k = 0; k < 3; ++k) points.push_back(c + 0.1 * Vec3(number(), number(), number()));
    items.push_back({{3 * i, 3 * i + 1, i % 7 ? 3 * i + 2 : 3 * i + 1}, {i % 3, 9, i % 2}});
  }
  const ProjectionTree tree(points, items);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = 1.2 * Vec3(number(), number(), number());
    const ProjectionTree::Kind kind{static_cast<std::uint32_t>(i % 3), 9, static_cast<std::uint32_t>(i % 2)};
    double best = 0.3;
    for (const auto& item : items)
      if (item.kind == kind)
        best = std::min(best, std::sqrt(squared_distance(p, points[item.corners[0]], points[item.corners[1]],
                                                         points[item.corners[2]])));
    const auto found = tree.nearest(p, kind, 0.3);
    ASSERT_EQ(found.has_value(), best < 0.3);
    if (found) {
      EXPECT_NEAR((*found - p).norm(), best, 1e-12);
    }
    EXPECT_FALSE(tree.nearest(p, {5, 6, 0}, 10));
    const auto hit = tree.nearest_of(p, 10, [](const auto&) { return true; });
    ASSERT_TRUE(hit);
    EXPECT_EQ(tree.closest_on(hit->item, p), hit->point);
    const double distance = (hit->point - p).norm();
    EXPECT_TRUE(tree.any_within(p, distance * (1 + 1e-12)));
    EXPECT_FALSE(tree.any_within(p, distance * (1 - 1e-12)));
  }
  EXPECT_FALSE(ProjectionTree().nearest({0, 0, 0}, {}, 10));
  EXPECT_FALSE(ProjectionTree().any_within({0, 0, 0}, 10));
}

}  // namespace
}  // namespace tetwright
