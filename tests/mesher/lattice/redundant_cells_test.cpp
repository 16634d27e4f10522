// SPDX-License-Identifier: Apache-2.0
#include "mesher/lattice/redundant_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "common/random.h"
#include "mesher/labels/label_field.h"
#include "mesher/labels/label_thickness.h"
#include "tests/mesher/checked_labels.h"

namespace tetwright::redundant_cells_test {
namespace {

/// The cells to be split of a volume in cells of `cell` voxels, all and those that are kept.
struct Cells {
  RefinementRegions all, kept;
};
Cells split_cells(const LabelInput& labels, double cell) {
  const GridFrame frame = label_frame(labels, cell, false);
  const ThinLabels thin = find_thin_labels(labels, frame, nullptr);
  Cells cells{thin.finer, thin.finer};
  const auto field = LabelField::make(labels, frame, false, nullptr);
  drop_redundant_cells(cells.kept, *field, thin.island_levels, largest_redundant_cell(labels, frame),
                       nullptr);
  return cells;
}

std::size_t count(const RefinementRegions& regions) {
  std::size_t all = 0;
  for (const std::vector<MortonKey>& cells : regions.cells) all += cells.size();
  return all;
}

/// Labels with sheets, rods and steps of one and two voxels.
LabelInput thin_labels() {
  return make_labels({24, 24, 24}, [](int x, int y, int z) -> MaterialTag {
    if (std::min({x, y, z}) < 3 || std::max({x, y, z}) > 20) return 0;
    if (z == 12) return 2;                     // a sheet along the axes
    if (x + y == 24 || x + y == 25) return 3;  // a diagonal one
    if (y == 8 && z == 16) return 4;           // a rod
    return z < 12 ? 1 : 5;
  });
}

TEST(RedundantCells, TopologyIsThatOfAllCells) {
  const LabelInput labels = thin_labels();
  for (const double cell : {1.0, 2.0}) {
    const Cells cells = split_cells(labels, cell);
    EXPECT_LT(count(cells.kept), count(cells.all));
    const DenseMesh meshed = checked_mesh(labels, cell);
    const LabelComparison with_voxels = compare_with_voxels(labels, meshed.mesh);
    EXPECT_EQ(with_voxels.lost, 0u) << comparison_line(with_voxels);
    EXPECT_EQ(text(meshed.mesh), text(checked_mesh(labels, 0.5).mesh));
  }
}

TEST(RedundantCells, TopologyAtTheBorderOfTheVolume) {
  // Walks of three labels, most of them along the border, where tets have corners in the centres of faces.
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    constexpr int size = 8;
    std::array<std::array<std::array<MaterialTag, size>, size>, size> tags{};
    const auto background = static_cast<MaterialTag>(random.below(2));
    for (auto& slice : tags)
      for (auto& row : slice) row.fill(background);
    for (MaterialTag tag = 2; tag < 5; ++tag) {
      std::array<std::size_t, 3> at{};
      for (std::size_t& c : at) c = random.below(2) == 0 ? 0 : random.below(size);
      for (std::uint32_t steps = 15 + random.below(45); steps > 0; --steps) {
        tags[at[2]][at[1]][at[0]] = tag;
        std::size_t& c = at[random.below(3)];
        if (random.below(2) == 0)
          c -= c > 0 ? 1 : 0;
        else
          c += c + 1 < size ? 1 : 0;
      }
    }
    const LabelInput labels = make_labels({size, size, size}, [&](int x, int y, int z) {
      const auto index = [](int c) { return static_cast<std::size_t>(c); };
      return tags[index(z)][index(y)][index(x)];
    });
    MesherOptions options;
    options.voxel_size = 1;
    const TetMesh mesh = mesh_labels(labels, options, nullptr).mesh;
    options.voxel_size = 0.5;
    EXPECT_EQ(text(mesh), text(mesh_labels(labels, options, nullptr).mesh)) << seed;
  }
}

TEST(RedundantCells, CellsLargerThanAVoxelAreKept) {
  const Cells cells = split_cells(thin_labels(), 2);
  ASSERT_GE(cells.all.cells.size(), 3u);
  EXPECT_EQ(cells.kept.cells.back(), cells.all.cells.back());
  EXPECT_LT(count(cells.kept), count(cells.all));
}

TEST(RedundantCells, AnIslandDoesNotExemptOthers) {
  const auto volume = [](bool island) {
    return make_labels({32, 32, 32}, [=](int x, int y, int z) -> MaterialTag {
      if (island && x == 28 && y == 28 && z == 28) return 3;
      return z == 8 && std::min(x, y) > 2 && std::max(x, y) < 30 ? 2 : 1;
    });
  };
  const std::size_t with = count(split_cells(volume(true), 2).kept),
                    without = count(split_cells(volume(false), 2).kept);
  EXPECT_LT(with, without + without / 4);
}

TEST(RedundantCells, KeptCellsContainThoseOfTheNextLevel) {
  const Cells cells = split_cells(thin_labels(), 2);
  ASSERT_GT(cells.kept.refinement, 0);
  for (std::size_t level = 1; level < cells.kept.cells.size(); ++level)
    for (const MortonKey cell : cells.kept.cells[level - 1])
      EXPECT_TRUE(
          std::binary_search(cells.kept.cells[level].begin(), cells.kept.cells[level].end(), cell >> 3));
}

TEST(RedundantCells, AThickBlockNeedsNone) {
  // A corner of the block is thinner than two cells only at its edges.
  const LabelInput labels = make_labels({20, 20, 20}, [](int x, int y, int z) -> MaterialTag {
    return std::min({x, y, z}) > 4 && std::max({x, y, z}) < 15 ? 1 : 0;
  });
  EXPECT_EQ(count(split_cells(labels, 1).kept), 0u);
}

TEST(RedundantCells, IslandsKeepTheirCells) {
  const LabelInput labels = make_labels(
      {12, 12, 12}, [](int x, int y, int z) -> MaterialTag { return x == 6 && y == 5 && z == 6 ? 2 : 1; });
  const Cells cells = split_cells(labels, 1);
  EXPECT_EQ(count(cells.kept), count(cells.all));
  checked_mesh(labels, 1.0);  // fails if a material is missing
}

}  // namespace
}  // namespace tetwright::redundant_cells_test
