// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/surface_pinches.h"

#include <gtest/gtest.h>

namespace tetwright {
namespace {

SurfacePinches pinches_of(const std::vector<Triangle>& faces, const std::vector<std::uint32_t>& surfaces) {
  return find_pinches(faces, surfaces, [](Index) { return true; });
}

TEST(SurfacePinches, AFanIsNone) {
  const SurfacePinches found = pinches_of({{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}, {0, 0, 0});
  EXPECT_TRUE(found.edges.empty());
  EXPECT_TRUE(found.points.empty());
}

TEST(SurfacePinches, TwoFansAtAPointAreOne) {
  const SurfacePinches found = pinches_of({{0, 1, 2}, {0, 2, 3}, {0, 4, 5}}, {7, 7, 7});
  ASSERT_EQ(found.points.size(), 1u);
  EXPECT_EQ(found.points[0].point, 0u);
  EXPECT_EQ(found.points[0].surface, 7u);
  EXPECT_EQ(found.points[0].beside, (std::vector<Index>{4, 5}));
}

TEST(SurfacePinches, FansAreJoinedByALaterFace) {
  EXPECT_TRUE(pinches_of({{0, 1, 2}, {0, 3, 4}, {0, 2, 3}}, {0, 0, 0}).points.empty());
}

TEST(SurfacePinches, FansOfDifferentSurfacesAreNone) {
  EXPECT_TRUE(pinches_of({{0, 1, 2}, {0, 3, 4}}, {0, 1}).points.empty());
}

TEST(SurfacePinches, PointsThatAreNotConsideredAreNone) {
  const std::vector<Triangle> faces{{0, 1, 2}, {0, 3, 4}};
  const std::vector<std::uint32_t> surfaces{0, 0};
  EXPECT_TRUE(find_pinches(faces, surfaces, [](Index p) { return p != 0; }).points.empty());
}

TEST(SurfacePinches, AnEdgeOfFourFacesIsOne) {
  const SurfacePinches found = pinches_of({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}}, {2, 2, 2, 2});
  ASSERT_EQ(found.edges.size(), 1u);
  EXPECT_EQ(found.edges[0].ends, (std::array<Index, 2>{0, 1}));
  EXPECT_EQ(found.edges[0].surface, 2u);
}

}  // namespace
}  // namespace tetwright
