// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/sliver_patches.h"

#include <gtest/gtest.h>

namespace tetwright {
namespace {

/// A strip of rectangles of two triangles each, one after the other along x, each as wide as given and one
/// unit high.
struct Strip {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::uint16_t> patches;

  void add(double width, std::uint16_t patch) {
    if (points.empty()) points = {{0, 0, 0}, {0, 1, 0}};
    const auto first = static_cast<Index>(points.size() - 2);
    const double x = points.back().x() + width;
    points.insert(points.end(), {{x, 0, 0}, {x, 1, 0}});
    triangles.push_back({first, first + 2, first + 3});
    triangles.push_back({first, first + 3, first + 1});
    patches.insert(patches.end(), 2, patch);
  }
  void merge(const std::vector<std::size_t>& sheet_of_patch, double min_area) {
    merge_slivers(points, triangles, sheet_of_patch, min_area, patches);
  }
};

TEST(SliverPatches, ASliverJoinsANeighbour) {
  Strip strip;
  strip.add(1, 0);
  strip.add(1e-3, 1);
  strip.merge({0, 0}, 1e-2);
  EXPECT_EQ(strip.patches, (std::vector<std::uint16_t>{0, 0, 0, 0}));
}

TEST(SliverPatches, LargePatchesStay) {
  Strip strip;
  strip.add(1, 0);
  strip.add(0.1, 1);
  strip.merge({0, 0}, 1e-2);
  EXPECT_EQ(strip.patches, (std::vector<std::uint16_t>{0, 0, 1, 1}));
}

TEST(SliverPatches, SmallPartsOfLargePatchesAreSlivers) {
  Strip strip;
  strip.add(1, 0);
  strip.add(1, 1);
  strip.add(1e-3, 0);
  strip.merge({0, 0}, 1e-2);
  EXPECT_EQ(strip.patches, (std::vector<std::uint16_t>{0, 0, 1, 1, 1, 1}));
}

TEST(SliverPatches, SuccessiveSliversJoinTheSamePatch) {
  Strip strip;
  strip.add(1, 0);
  strip.add(3e-3, 1);
  strip.add(2e-3, 2);
  strip.add(1e-3, 3);
  strip.merge({0, 0, 0, 0}, 1e-2);
  EXPECT_EQ(strip.patches, (std::vector<std::uint16_t>(8, 0)));
}

TEST(SliverPatches, TheLongestBorderDecides) {
  Strip strip;
  strip.add(1, 0);
  strip.add(1e-3, 1);
  // A third patch above the sliver, along its short side.
  strip.points.push_back({1, 100, 0});
  strip.triangles.push_back({3, 5, 6});
  strip.patches.push_back(2);
  strip.merge({0, 0, 0}, 1e-2);
  EXPECT_EQ(strip.patches, (std::vector<std::uint16_t>{0, 0, 0, 0, 2}));
}

TEST(SliverPatches, SheetsStayApart) {
  Strip strip;
  strip.add(1, 0);
  strip.add(1e-3, 1);
  strip.merge({0, 1}, 1e-2);
  EXPECT_EQ(strip.patches, (std::vector<std::uint16_t>{0, 0, 1, 1}));
}

}  // namespace
}  // namespace tetwright
