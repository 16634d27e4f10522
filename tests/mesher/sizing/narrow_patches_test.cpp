// SPDX-License-Identifier: Apache-2.0
#include "mesher/sizing/narrow_patches.h"

#include <gtest/gtest.h>

#include "tests/common/features/parts.h"
#include "tetwright/mesher_input.h"

namespace tetwright::narrow_patches_test {
namespace {

/// A unit cube with one edge along z cut off, leaving a face of the given width between its neighbours.
TriangleMesh chamfered(double width) {
  const double cut = width / std::numbers::sqrt2;
  return extruded({{0, 0}, {1, 0}, {1, 1 - cut}, {1 - cut, 1}, {0, 1}}, {0.4, 0.4}, 1);
}

struct Found {
  NarrowPatches narrow;
  GridFrame frame;
};

Found find(double width_in_cells, int max_depth, double max_tets = 1e9) {
  constexpr double cell = 1.0 / 32;
  const MesherInput input = make_mesher_input({{"part", 1, chamfered(width_in_cells * cell), "p.off"}});
  const RepairedSurface& surface = input.bodies[0].surface;
  const GridFrame frame = make_grid_frame(input.low, input.high, cell, false);
  const SurfacePatches patches = find_patches(surface.points, surface.triangles, {}, {}, "p.off");
  EXPECT_EQ(patches.count, 7U);
  return {find_narrow_patches(surface, patches, frame, max_depth, max_tets), frame};
}

TEST(NarrowPatches, GetCellsOfHalfTheirWidth) {
  EXPECT_EQ(find(2.1, 3).narrow.finer.refinement, 0);
  EXPECT_EQ(find(1.5, 3).narrow.finer.refinement, 1);
  EXPECT_EQ(find(0.8, 3).narrow.finer.refinement, 2);
  EXPECT_EQ(find(0.4, 3).narrow.finer.refinement, 3);
  EXPECT_EQ(find(0.1, 3).narrow.finer.refinement, 3);
  EXPECT_EQ(find(0.4, 1).narrow.finer.refinement, 1);
  EXPECT_EQ(find(0.4, 0).narrow.finer.refinement, 0);
}

TEST(NarrowPatches, AreNotWhereCreasesMeetInACorner) {
  const Found found = find(0.8, 3);
  ASSERT_FALSE(found.narrow.voxels.empty());
  EXPECT_TRUE(std::is_sorted(found.narrow.voxels.begin(), found.narrow.voxels.end()));
  // All of the chamfer except its ends, and nothing else.
  const Vec3 low = found.frame.to_grid({1, 1, 0}), high = found.frame.to_grid({1, 1, 1});
  double lowest = 1e9, highest = 0;
  for (const MortonKey key : found.narrow.voxels) {
    const auto [x, y, z] = morton_decode(key);
    EXPECT_LT(std::abs(x + 0.5 - low.x()), 4);
    EXPECT_LT(std::abs(y + 0.5 - low.y()), 4);
    lowest = std::min<double>(lowest, z);
    highest = std::max<double>(highest, z);
  }
  EXPECT_LT(lowest, low.z() + 4);
  EXPECT_GT(highest, high.z() - 5);
}

TEST(NarrowPatches, StayWithinWhatTheyMayTake) {
  const std::size_t all = find(0.4, 3).narrow.finer.refinement;
  EXPECT_EQ(all, 3U);
  EXPECT_LT(find(0.4, 3, 5e4).narrow.finer.refinement, 3);
  EXPECT_TRUE(find(0.4, 3, 10).narrow.voxels.empty());
}

}  // namespace
}  // namespace tetwright::narrow_patches_test
