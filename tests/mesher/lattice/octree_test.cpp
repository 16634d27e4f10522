// SPDX-License-Identifier: Apache-2.0
#include "mesher/lattice/octree.h"

#include <gtest/gtest.h>

#include "common/random.h"
#include "mesher/thin/field_thickness.h"
#include "tests/mesher/fields.h"
#include "tests/mesher/random_octree.h"

namespace tetwright::octree_test {
namespace {

/// Expects leaves along the curve to be consecutive, without gaps or overlaps, and to fill the box.
void expect_covers_box(const Octree& octree) {
  double volume = 0;
  for (std::size_t i = 0; i < octree.size(); ++i) {
    const Octree::Leaf leaf = octree.leaf(i);
    if (i + 1 < octree.size()) {
      ASSERT_LE(leaf.key + (MortonKey{1} << 3 * leaf.level), octree.leaf(i + 1).key);
    }
    const auto low = morton_decode(leaf.key);
    for (int a = 0; a < 3; ++a) ASSERT_LE(low[a] + (1 << leaf.level), octree.cells[a]);
    volume += static_cast<double>(MortonKey{1} << 3 * leaf.level);
  }
  EXPECT_EQ(volume, static_cast<double>(octree.cells[0]) * octree.cells[1] * octree.cells[2]);
}

void expect_balanced(const Octree& octree) {
  for (std::size_t i = 0; i < octree.size(); ++i) {
    const Octree::Leaf leaf = octree.leaf(i);
    const int side = 1 << leaf.level;
    const auto low = morton_decode(leaf.key);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          if (std::abs(dx) + std::abs(dy) + std::abs(dz) > 2) continue;  // corners are unrestricted
          const std::array<int, 3> q{low[0] + dx * side, low[1] + dy * side, low[2] + dz * side};
          bool in_box = true;
          for (int a = 0; a < 3; ++a) in_box &= q[a] >= 0 && q[a] < octree.cells[a];
          if (!in_box) continue;
          // The cell of this size beyond is a leaf, in a leaf, or split: only "in a leaf" can be too coarse
          // here.
          const Octree::Leaf other = octree.leaf(octree.find(morton_encode(q)));
          ASSERT_LE(other.level, leaf.level + 1);
        }
  }
}

TEST(Octree, RandomOnesAreBalancedAndCoverTheBox) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Octree octree = make_random_octree(seed);
    expect_covers_box(octree);
    expect_balanced(octree);
  }
}

TEST(Octree, FindsEveryCell) {
  const Octree octree = make_random_octree(4);
  for (int x = 0; x < octree.cells[0]; ++x)
    for (int y = 0; y < octree.cells[1]; ++y)
      for (int z = 0; z < octree.cells[2]; ++z) {
        const MortonKey key = morton_encode(x, y, z);
        const Octree::Leaf leaf = octree.leaf(octree.find(key));
        ASSERT_EQ(key >> 3 * leaf.level << 3 * leaf.level, leaf.key);
        ASSERT_EQ(octree.find(key, octree.size() / 2), octree.find(key));
      }
}

Octree sphere_octree(int resolution, const OctreeOptions& options) {
  const auto field =
      make_field({make_sphere(1, {0.01, 0.02, 0.03}, 5)}, 2.0 / resolution, {}, options.uniform);
  const auto cells = field->interface_voxels();
  Octree octree = build_octree(*field, options, cells, {}, nullptr);
  if (!options.uniform && options.adaptivity == 0) {
    for (MortonKey key : cells) EXPECT_EQ(octree.leaf(octree.find(key)).level, 0);
  }
  return octree;
}

TEST(Octree, GrowsWithTheSurfaceNotTheVolume) {
  for (double adaptivity : {0.0, 0.05}) {
    std::size_t before = 0;
    for (int resolution : {24, 48, 96}) {
      const Octree octree = sphere_octree(resolution, {false, adaptivity});
      expect_covers_box(octree);
      expect_balanced(octree);
      if (before) {
        const double ratio = static_cast<double>(octree.size()) / static_cast<double>(before);
        // With a tolerance, fewer cells are needed at higher resolutions, since the sphere is flatter in
        // smaller cells.
        EXPECT_GT(ratio, adaptivity > 0 ? 2 : 3) << resolution;
        EXPECT_LT(ratio, 5) << resolution;
      }
      before = octree.size();
    }
  }
}

TEST(Octree, UniformHasFinestCellsOnly) {
  const Octree octree = sphere_octree(12, {true, 0.05});
  expect_covers_box(octree);
  for (std::size_t i = 0; i < octree.size(); ++i) EXPECT_EQ(octree.leaf(i).level, 0);
}

TEST(Octree, ToleranceCoarsensFlatInterfaces) {
  const std::size_t finest = sphere_octree(96, {false, 0}).size();
  EXPECT_LT(sphere_octree(96, {false, 0.5}).size(), finest * 2 / 3);
  EXPECT_LE(sphere_octree(96, {false, 0.05}).size(), finest);
}

TEST(Octree, ThinSheetsAreSplitBelowVoxels) {
  const auto voxels = make_field({make_sphere(1), make_sphere(0.97)}, 0.05);
  const ThinSheets sheets = find_thin_sheets(*voxels, voxels->interface_voxels());
  ASSERT_EQ(sheets.finer.refinement, 2);
  const auto field = voxels->refined(sheets.finer.refinement);
  const Octree octree =
      build_octree(*field, {false, 0.05}, voxels->interface_voxels(), sheets.finer.cells, nullptr);
  expect_covers_box(octree);
  expect_balanced(octree);
  for (std::size_t level = 1; level < sheets.finer.cells.size(); ++level)
    for (MortonKey key : sheets.finer.cells[level])
      EXPECT_LT(octree.leaf(octree.find(key << 3 * level)).level, static_cast<int>(level));
}

}  // namespace
}  // namespace tetwright::octree_test
