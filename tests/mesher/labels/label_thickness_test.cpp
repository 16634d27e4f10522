// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_thickness.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "common/random.h"
#include "mesher/labels/label_field.h"
#include "mesher/tuning/domain_tuning.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/resources.h"

namespace tetwright::label_thickness_test {
namespace {

using Size = std::array<int, 3>;

/// A literal implementation of the rules: tries boxes at every voxel, and for the outside also beyond the
/// volume.
std::vector<Vec3> thin_by_the_rules(const LabelInput& labels, const Size& sides) {
  const auto at = [&](const Size& v) {
    for (int a = 0; a < 3; ++a)
      if (v[a] < 0 || v[a] >= labels.size[a]) return outside_region;
    return labels.regions[(static_cast<std::size_t>(v[2]) * labels.size[1] + v[1]) * labels.size[0] + v[0]];
  };
  const auto all_voxels = [&](const Size& low, const Size& high, auto&& work) {
    for (int z = low[2]; z < high[2]; ++z)
      for (int y = low[1]; y < high[1]; ++y)
        for (int x = low[0]; x < high[0]; ++x) work(Size{x, y, z});
  };
  std::set<Size> thick;
  const Size before{-sides[0], -sides[1], -sides[2]};
  all_voxels(before, labels.size, [&](const Size& low) {
    const Size high{low[0] + sides[0], low[1] + sides[1], low[2] + sides[2]};
    bool alike = true;
    all_voxels(low, high, [&](const Size& v) { alike &= at(v) == at(low); });
    if (alike) all_voxels(low, high, [&](const Size& v) { thick.insert(v); });
  });
  std::vector<Vec3> thin;
  all_voxels({0, 0, 0}, labels.size, [&](const Size& v) {
    if (thick.count(v)) return;
    for (int a = 0; a < 3; ++a)
      for (int step : {-1, 1}) {
        Size next = v;
        next[a] += step;
        if (next[a] >= 0 && next[a] < labels.size[a] && thick.count(next) && at(next) == at(v)) return;
      }
    thin.emplace_back(v[0], v[1], v[2]);
  });
  return thin;
}

/// True if the face-connected island of a voxel has fewer than eight voxels.
bool in_small_island(const LabelInput& labels, const Vec3& voxel) {
  const auto place = [&](const Size& v) {
    return (static_cast<std::size_t>(v[2]) * labels.size[1] + v[1]) * labels.size[0] + v[0];
  };
  const Size first{static_cast<int>(voxel[0]), static_cast<int>(voxel[1]), static_cast<int>(voxel[2])};
  std::set<Size> island{first};
  std::vector<Size> open{first};
  while (!open.empty()) {
    const Size v = open.back();
    open.pop_back();
    for (int a = 0; a < 3; ++a)
      for (int step : {-1, 1}) {
        Size next = v;
        next[a] += step;
        if (next[a] >= 0 && next[a] < labels.size[a] &&
            labels.regions[place(next)] == labels.regions[place(first)] && island.insert(next).second)
          open.push_back(next);
      }
  }
  return labels.regions[place(first)] != outside_region && island.size() < 8;
}

Size box_sides(const LabelInput& labels, const GridFrame& frame, int depth) {
  const double cell = std::ldexp(frame.cell_size, -depth);
  Size sides;
  for (int a = 0; a < 3; ++a)
    sides[a] = std::max(1, static_cast<int>(std::ceil(2 * cell / labels.directions.col(a).norm() - 1e-6)));
  return sides;
}

/// The voxels whose cells are halved at a depth: thin ones, and small islands twice more.
std::vector<Vec3> voxels_by_the_rules(const LabelInput& labels, const GridFrame& frame, int depth) {
  const Size one{1, 1, 1};
  int thin_depths = 0;
  while (box_sides(labels, frame, thin_depths) != one) ++thin_depths;
  if (depth < thin_depths) return thin_by_the_rules(labels, box_sides(labels, frame, depth));
  if (depth >= thin_depths + 2) return {};
  std::vector<Vec3> thin =
      thin_by_the_rules(labels, thin_depths > 0 ? box_sides(labels, frame, thin_depths - 1) : Size{2, 2, 2});
  std::erase_if(thin, [&](const Vec3& v) { return !in_small_island(labels, v); });
  if (thin.size() > 32) thin.clear();
  return thin;
}

/// Cells of the frame, halved `depth` times, that reach within 0.75 voxels of a thin voxel's centre.
std::vector<MortonKey> cells_by_the_rules(const LabelInput& labels, const GridFrame& frame, int depth) {
  std::vector<MortonKey> keys;
  for (const Vec3& v : voxels_by_the_rules(labels, frame, depth)) {
    Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
    for (int k = 0; k < 8; ++k) {
      const Vec3 corner = v + 1.5 * (Vec3(k & 1, k >> 1 & 1, k >> 2) - Vec3::Constant(0.5));
      const Vec3 p = std::ldexp(1, depth) * frame.to_grid(labels.origin + labels.directions * corner);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const auto first = [](double x) { return std::max(0, static_cast<int>(std::floor(x + 1e-9))); };
    for (int a = 0; a < 3; ++a) high[a] = std::min(high[a], std::ldexp(frame.box[a], depth));
    for (int z = first(low[2]); z < high[2] - 1e-9; ++z)
      for (int y = first(low[1]); y < high[1] - 1e-9; ++y)
        for (int x = first(low[0]); x < high[0] - 1e-9; ++x) keys.push_back(morton_encode(x, y, z));
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

LabelInput random_labels(Random& random, const Eigen::Matrix3d& directions) {
  const Size size{1 + static_cast<int>(random.below(11)), 1 + static_cast<int>(random.below(11)),
                  1 + static_cast<int>(random.below(11))};
  const std::uint32_t labels = 2 + random.below(3), boxes = 1 + random.below(6);
  std::vector<std::array<int, 7>> all;
  for (std::uint32_t i = 0; i < boxes; ++i) {
    std::array<int, 7> box{};
    for (int a = 0; a < 3; ++a) {
      box[a] = static_cast<int>(random.below(size[a]));
      box[a + 3] = box[a] + 1 + static_cast<int>(random.below(6));
    }
    box[6] = static_cast<int>(random.below(labels));
    all.push_back(box);
  }
  return make_labels(
      size,
      [&](int x, int y, int z) {
        MaterialTag label = x == 0 && y == 0 && z == 0 ? 1 : 0;
        for (const auto& b : all)
          if (x >= b[0] && x < b[3] && y >= b[1] && y < b[4] && z >= b[2] && z < b[5]) label = b[6];
        return x == 0 && y == 0 && z == 0 ? 1 : label;
      },
      directions);
}

TEST(LabelThickness, TheSameAsByBoxesTriedEverywhere) {
  Random random(1);
  const std::vector<Vec3> spacings{{1, 1, 1}, {0.5, 0.6, 1.4}, {2, 1, 1}};
  std::size_t thin_volumes = 0;
  for (int round = 0; round < 120; ++round) {
    const Vec3 spacing = spacings[random.below(3)];
    const LabelInput labels = random_labels(random, spacing.asDiagonal());
    const double cell = spacing.minCoeff() * std::array<double, 4>{1, 0.5, 2, 1.37}[random.below(4)];
    const GridFrame frame = label_frame(labels, cell, false);
    const ThinLabels thin = find_thin_labels(labels, frame, nullptr);
    SCOPED_TRACE(::testing::Message() << "round " << round << ", " << labels.size[0] << " x "
                                      << labels.size[1] << " x " << labels.size[2] << ", cell " << cell);
    const int refinement = thin.finer.refinement;
    thin_volumes += refinement > 0;
    ASSERT_EQ(thin.finer.cells.size(), static_cast<std::size_t>(refinement) + 1);
    EXPECT_TRUE(thin.finer.cells[0].empty());
    for (int depth = 0; depth < refinement; ++depth)
      ASSERT_EQ(thin.finer.cells[refinement - depth], cells_by_the_rules(labels, frame, depth)) << depth;
    EXPECT_TRUE(refinement == DomainTuning::Refinement::max_levels ||
                cells_by_the_rules(labels, frame, refinement).empty());
  }
  EXPECT_GT(thin_volumes, 40u);
}

TEST(LabelThickness, TheSameSlabBySlab) {
  Random random(4);
  for (const Size& sides : {Size{2, 2, 2}, Size{1, 3, 2}, Size{3, 3, 9}, Size{2, 2, 1}})
    for (int round = 0; round < 5; ++round) {
      std::vector<std::array<int, 4>> boxes;  // low corners, labels
      for (int i = 0; i < 250; ++i)
        boxes.push_back({static_cast<int>(random.below(10)), static_cast<int>(random.below(9)),
                         static_cast<int>(random.below(150)), static_cast<int>(random.below(3))});
      std::vector<MaterialTag> voxels(11 * 10 * 150, 0);
      voxels[0] = 1;
      for (const auto& [x, y, z, label] : boxes)
        for (int k = 0; k < 8 * 4 * 12; ++k)
          if (x + k % 4 < 11 && y + k / 4 % 4 < 10 && z + k / 16 < 150)
            voxels[((z + k / 16) * 10 + y + k / 4 % 4) * 11 + x + k % 4] = label;
      const LabelInput labels =
          make_labels({11, 10, 150}, [&](int x, int y, int z) { return voxels[(z * 10 + y) * 11 + x]; });
      const std::vector<std::size_t> whole = thin_voxels(labels, sides, std::size_t{1} << 28, nullptr);
      EXPECT_FALSE(whole.empty());
      EXPECT_EQ(thin_voxels(labels, sides, 0, nullptr), whole);
    }
}

/// A cube of 12 voxels in a volume of 20, of label 1 except for the caller's labels.
LabelInput cube(const VoxelLabels& label) {
  return make_labels({20, 20, 20}, [&](int x, int y, int z) {
    const MaterialTag put = label(x, y, z);
    if (put >= 0) return put;
    return std::min({x, y, z}) >= 4 && std::max({x, y, z}) < 16 ? 1 : 0;
  });
}

ThinLabels thin_labels(const LabelInput& labels, double cell) {
  return find_thin_labels(labels, label_frame(labels, cell, false), nullptr);
}

TEST(LabelThickness, NothingIsThinInCellsOfHalfAVoxel) {
  const LabelInput labels = cube([](int x, int, int) { return x == 9 ? 2 : -1; });
  EXPECT_EQ(thin_labels(labels, 0.5).finer.refinement, 0);
  EXPECT_EQ(thin_labels(labels, 1).finer.refinement, 1);
  EXPECT_EQ(thin_labels(labels, 2).finer.refinement, 2);
  EXPECT_EQ(thin_labels(labels, 4).finer.refinement, 3);
}

TEST(LabelThickness, RoughnessOfAVoxelIsNotThin) {
  const LabelInput labels = cube([](int x, int y, int z) { return x == 16 && y == 9 && z == 9 ? 1 : -1; });
  EXPECT_EQ(thin_labels(labels, 1).finer.refinement, 0);
  const LabelInput longer =
      cube([](int x, int y, int z) { return (x == 16 || x == 17) && y == 9 && z == 9 ? 1 : -1; });
  EXPECT_EQ(thin_labels(longer, 1).finer.refinement, 1);
}

TEST(LabelThickness, GapsAreThinToo) {
  const LabelInput labels = cube([](int x, int y, int) { return x == 9 && y < 10 ? 0 : -1; });
  EXPECT_EQ(thin_labels(labels, 1).finer.refinement, 1);
}

TEST(LabelThickness, GapsAreThinAtEitherEnd) {
  const auto refinement = [](int from, int to) {
    const LabelInput labels =
        make_labels({12, 12, 12}, [&](int x, int y, int) { return y == 5 && x >= from && x < to ? 0 : 1; });
    return thin_labels(labels, 1).finer.refinement;
  };
  EXPECT_EQ(refinement(0, 12), 1);
  EXPECT_EQ(refinement(10, 12), 1);
  EXPECT_EQ(refinement(0, 2), 1);
}

TEST(LabelThickness, WhatIsStillTooThinIsNamed) {
  const LabelInput labels = cube([](int x, int, int) { return x == 9 ? 2 : -1; });
  const ThinLabels thin = thin_labels(labels, 8);
  EXPECT_EQ(thin.finer.refinement, 3);
  ASSERT_EQ(thin.too_thin.size(), 1u);
  EXPECT_EQ(thin.too_thin[0].region, region_of(labels, 2));
  EXPECT_EQ(thin.too_thin[0].places, 400u);
}

TEST(LabelThickness, TheSameForAnyNumberOfThreads) {
  Random random(3);
  const LabelInput labels =
      make_labels({30, 20, 25}, [&](int, int, int) { return static_cast<MaterialTag>(random.below(2)); });
  const auto cells_with = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return thin_labels(labels, 1).finer.cells;
  };
  EXPECT_EQ(cells_with(1), cells_with(4));
}

}  // namespace
}  // namespace tetwright::label_thickness_test
