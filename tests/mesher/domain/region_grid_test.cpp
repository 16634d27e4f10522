// SPDX-License-Identifier: Apache-2.0
#include "tetwright/region_grid.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/random.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/resources.h"

namespace tetwright::region_grid_test {
namespace {

using Regions = std::vector<RegionIndex>;

std::size_t number(const VoxelIndex& size, int x, int y, int z) {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(size[0]) +
         static_cast<std::size_t>(x);
}

int below(Random& random, int n) { return static_cast<int>(random.below(static_cast<std::uint32_t>(n))); }

/// Runs of `regions` different regions.
Regions random_regions(Random& random, const VoxelIndex& size, int regions) {
  Regions all(number(size, 0, 0, size[2]));
  for (std::size_t i = 0; i < all.size();) {
    const std::size_t end = std::min(all.size(), i + 1 + static_cast<std::size_t>(below(random, 40)));
    const auto region = static_cast<RegionIndex>(65535 - 7 * below(random, regions));
    for (; i < end; ++i) all[i] = region;
  }
  return all;
}

/// Compares single voxels, random boxes and all slices.
void expect_regions(const RegionGrid& grid, const Regions& expected, Random& random) {
  const VoxelIndex& size = grid.size();
  ASSERT_EQ(voxels_of(grid), expected);
  for (int round = 0; round < 50; ++round) {
    const int x = below(random, size[0]), y = below(random, size[1]), z = below(random, size[2]);
    ASSERT_EQ(grid.at(x, y, z), expected[number(size, x, y, z)]);
    ASSERT_EQ(grid[number(size, x, y, z)], expected[number(size, x, y, z)]);
    VoxelIndex low, high;
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = below(random, size[a]);
      high[a] = low[a] + 1 + below(random, size[a] - low[a]);
    }
    Regions box;
    for (int k = low[2]; k < high[2]; ++k)
      for (int j = low[1]; j < high[1]; ++j)
        for (int i = low[0]; i < high[0]; ++i) box.push_back(expected[number(size, i, j, k)]);
    Regions read(box.size());
    grid.read(low, high, read);
    ASSERT_EQ(read, box);
  }
}

TEST(RegionGrid, HoldsWhatWasWritten) {
  Random random(1);
  for (const VoxelIndex& size :
       {VoxelIndex{1, 1, 1}, {33, 1, 70}, {64, 32, 96}, {70, 45, 40}, {5, 90, 3}, {100, 33, 65}})
    for (const int regions : {1, 2, 3, 4, 5, 16, 17, 256, 257, 3000}) {
      SCOPED_TRACE(::testing::Message() << size[0] << " " << size[1] << " " << size[2] << ", " << regions);
      const Regions all = random_regions(random, size, regions);
      RegionGrid grid(size);
      EXPECT_EQ(grid.voxels(), all.size());
      EXPECT_EQ(voxels_of(grid), Regions(all.size(), outside_region));
      for (int z = 0; z < size[2]; z += RegionGrid::side) {
        const int end = std::min(size[2], z + RegionGrid::side);
        grid.write_slices(z, std::span(all).subspan(number(size, 0, 0, z),
                                                    number(size, 0, 0, end) - number(size, 0, 0, z)));
      }
      expect_regions(grid, all, random);
      const RegionGrid copy = grid;
      const ThreadLimit limit(4);
      const Regions others = random_regions(random, size, regions);
      grid.write_slices(0, others);
      expect_regions(grid, others, random);
      expect_regions(copy, all, random);
    }
}

TEST(RegionGrid, RunsAreFilledWithAnyRegion) {
  Random random(2);
  for (const int regions : {1, 2, 4, 20, 300}) {
    const VoxelIndex size{75, 40, 37};
    Regions all = random_regions(random, size, std::min(regions, 5));
    RegionGrid grid = grid_of(size, all);
    for (int round = 0; round < 1500; ++round) {
      const int x = below(random, size[0]), y = below(random, size[1]), z = below(random, size[2]);
      const int count = 1 + below(random, size[0] - x);
      const auto region = static_cast<RegionIndex>(below(random, regions));
      grid.fill({x, y, z}, count, region);
      std::fill_n(all.begin() + static_cast<std::ptrdiff_t>(number(size, x, y, z)), count, region);
      if (round % 100 == 0) expect_regions(grid, all, random);
    }
    expect_regions(grid, all, random);
    Regions table(65536);
    for (std::size_t r = 0; r < table.size(); ++r) table[r] = static_cast<RegionIndex>(r / 3);
    grid.renumber(table);
    for (RegionIndex& r : all) r = table[r];
    expect_regions(grid, all, random);
  }
}

TEST(RegionGrid, PalettesLeaveOutWhatNoVoxelHas) {
  RegionGrid grid({32, 32, 32});
  const std::size_t empty = grid.bytes();
  // Each slice at a time has another region, and never are more than three in the tile.
  for (int round = 0; round < 300; ++round)
    for (int y = 0; y < 32; ++y) grid.fill({0, y, round % 2}, 32, static_cast<RegionIndex>(1 + round));
  EXPECT_LT(grid.bytes(), empty + 32 * 32 * 32 / 4 + 100);
}

TEST(RegionGrid, TakesFewBitsForEachVoxel) {
  const VoxelIndex size{256, 256, 64};
  Regions all(number(size, 0, 0, size[2]));
  EXPECT_LT(grid_of(size, all).bytes(), all.size() / 256);
  // A checkerboard of two regions: a bit for each voxel.
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<RegionIndex>(i % 2);
  EXPECT_LT(grid_of(size, all).bytes(), all.size() / 8 + all.size() / 256);
}

}  // namespace
}  // namespace tetwright::region_grid_test
