// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_field.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "common/random.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/resources.h"

namespace tetwright::label_field_test {
namespace {

std::shared_ptr<const LabelField> make_field(const LabelInput& labels, double cell, bool uniform = false) {
  return LabelField::make(labels, label_frame(labels, cell, uniform), false, nullptr);
}

LabelInput noise(const std::array<int, 3>& size, std::uint32_t labels,
                 const Eigen::Matrix3d& directions = Eigen::Matrix3d::Identity()) {
  Random random(labels);
  return make_labels(size, [&](int, int, int) { return static_cast<MaterialTag>(random.below(labels)); },
                     directions, {5, -7, 100});
}

std::vector<Eigen::Matrix3d> all_directions() {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).matrix();
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
  shear(0, 1) = 0.4, shear(1, 2) = -0.3;
  return {Eigen::Matrix3d::Identity(),
          Vec3(0.5, 0.7, 2).asDiagonal(),
          Vec3(-1, 1, 1).asDiagonal(),
          turn * Vec3(1, 1.2, -0.8).asDiagonal(),
          shear,
          turn * shear};
}

Vec3 index_of(const LabelInput& labels, std::size_t voxel) {
  const auto x = static_cast<std::size_t>(labels.size[0]), y = static_cast<std::size_t>(labels.size[1]);
  return Vec3(static_cast<double>(voxel % x), static_cast<double>(voxel / x % y),
              static_cast<double>(voxel / (x * y)));
}

TEST(LabelFrame, EndsAtTheBorderOfTheVolume) {
  for (const Eigen::Matrix3d& directions : all_directions())
    for (const double cell : {0.25, 0.5, 1.0, 3.3}) {
      const LabelInput labels = noise({7, 5, 9}, 3, directions);
      const GridFrame frame = label_frame(labels, cell, false);
      EXPECT_EQ(frame.cell_size, cell);
      EXPECT_GT(frame.axes.determinant(), 0);
      std::array<Vec3, 2> ends{Vec3::Constant(HUGE_VAL), Vec3::Constant(-HUGE_VAL)};
      for (int k = 0; k < 8; ++k) {
        Vec3 corner;
        for (int a = 0; a < 3; ++a) corner[a] = (k >> a & 1) ? labels.size[a] - 0.5 : -0.5;
        const Vec3 p = frame.to_grid(labels.origin + directions * corner);
        for (int a = 0; a < 3; ++a)
          EXPECT_NEAR(std::min(std::abs(p[a]), std::abs(p[a] - frame.box[a])), 0, 1e-9);
        ends = {ends[0].cwiseMin(p), ends[1].cwiseMax(p)};
      }
      for (int a = 0; a < 3; ++a) {
        EXPECT_GT(ends[1][a] - ends[0][a], 0.5);
        EXPECT_LE(frame.box[a], frame.cells[a]);
        EXPECT_EQ(frame.cells[a] % (1 << frame.root_level), 0);
        // Whole cells that fill a side deviate by at most half a cell in total.
        const double side = directions.col(a).norm() * labels.size[a];
        EXPECT_NEAR(frame.axes.col(a).norm() * frame.box[a] * cell, side, 1e-9);
        EXPECT_LE(std::abs(frame.box[a] * cell - side), 0.5 * cell + 1e-9);
      }
    }
}

TEST(LabelFrame, CentresAreLatticePoints) {
  for (const Eigen::Matrix3d& directions : all_directions()) {
    const Vec3 spacing = directions.colwise().norm();
    if (directions.determinant() < 0 || (spacing - Vec3::Ones()).norm() > 1e-9) continue;
    for (const double cell : {1.0, 0.5, 0.25}) {
      const LabelInput labels = noise({7, 5, 9}, 3, directions);
      const Vec3 first = label_frame(labels, cell, false).to_grid(labels.origin);
      // A centre of cells, or a corner.
      const Vec3 shift = Vec3::Constant(cell == 1.0 ? 0.5 : 0);
      EXPECT_LT((first - shift - (first - shift).array().round().matrix()).norm(), 1e-9);
    }
  }
}

TEST(LabelField, CentresHaveTheirLabels) {
  for (const Eigen::Matrix3d& directions : all_directions())
    for (const double cell : {1.0, 0.5, 0.77}) {
      const LabelInput labels = noise({9, 18, 7}, 4, directions);
      const auto field = make_field(labels, cell);
      const auto sampler = field->sampler();
      for (std::size_t v = 0; v < labels.voxel_count(); ++v) {
        const Vec3 p = field->frame().to_grid(labels.origin + labels.directions * index_of(labels, v));
        const NearestRegion nearest = sampler->nearest(p);
        ASSERT_EQ(nearest.region, labels.regions[v]) << index_of(labels, v).transpose();
        EXPECT_GT(nearest.margin, 0);
      }
    }
}

TEST(LabelField, LabelsGoOnBeyondTheVolume) {
  const LabelInput labels = make_labels({6, 6, 6}, [](int x, int, int) { return x < 3 ? 1 : 0; });
  const auto field = make_field(labels, 0.5);
  const auto sampler = field->sampler();
  for (const Vec3& p : {Vec3(-1, 3, 3), Vec3(0, 6, 3), Vec3(-1, -1, -1), Vec3(2, 3, 60), Vec3(-1e9, 0, 0)})
    EXPECT_EQ(sampler->nearest(field->frame().to_grid(p)).region, 1) << p.transpose();
  for (const Vec3& p : {Vec3(3, 3, -9), Vec3(60, 3, 3), Vec3(4, -1, 7)})
    EXPECT_EQ(sampler->nearest(field->frame().to_grid(p)).region, outside_region) << p.transpose();
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_LE(sampler->nearest(Vec3(nothing, 0, 0)).region, 1);
}

TEST(LabelField, SurfacesPassTheBorderStraight) {
  // A slab across the volume is as thick at the border as inside.
  const LabelInput labels = make_labels({9, 9, 9}, [](int, int, int z) { return z > 2 && z < 6 ? 1 : 0; });
  const auto field = make_field(labels, 0.5);
  const auto sampler = field->sampler();
  const std::array<RegionIndex, 2> both{0, 1};
  for (const double z : {2.0, 2.5, 3.0, 5.2}) {
    std::array<float, 2> within, at_border, at_corner;
    sampler->values(field->frame().to_grid(Vec3(4, 4, z)), both, within.data());
    sampler->values(field->frame().to_grid(Vec3(-0.5, 4, z)), both, at_border.data());
    sampler->values(field->frame().to_grid(Vec3(8.5, 8.5, z)), both, at_corner.data());
    EXPECT_EQ(within, at_border);
    EXPECT_EQ(within, at_corner);
  }
}

TEST(LabelField, DistancesAreInInputUnitsOfTheSmallestSpacing) {
  for (const double cell : {1.0, 0.5}) {
    const LabelInput labels = make_labels(
        {20, 20, 20}, [](int x, int, int) { return x < 10 ? 1 : 2; }, Vec3(2, 3, 4).asDiagonal());
    const auto field = make_field(labels, 2 * cell);
    const Vec3 inside(9.75, 10, 10);
    const Vec3 p = field->frame().to_grid(labels.directions * inside);
    // A quarter of a voxel of size 2 beyond the interface at 9.5.
    EXPECT_NEAR(field->signed_distance(labels.directions * inside, 1), 0.5, 0.1);
    EXPECT_NEAR(field->signed_distance(labels.directions * inside, 2), -0.5, 0.1);
    const auto sampler = field->sampler();
    std::array<float, 2> values;
    const std::array<RegionIndex, 2> regions{1, 2};
    sampler->values(p, regions, values.data());
    EXPECT_NEAR(values[0], 0.25 / cell, 0.05 / cell);
    EXPECT_NEAR(values[1], -0.25 / cell, 0.05 / cell);
    Vec3 gradient;
    EXPECT_NEAR(sampler->between(1, 2, p, gradient), 0.25 / cell, 0.05 / cell);
    EXPECT_NEAR(gradient.x(), 1, 0.1);
    EXPECT_NEAR(gradient.y(), 0, 1e-6);
    EXPECT_EQ(*sampler->two_nearest(p)->begin(), 1);
    EXPECT_EQ(sampler->two_nearest(p)->size(), 2);
  }
}

TEST(LabelField, GradientsAreThoseOfTheValues) {
  for (const Eigen::Matrix3d& directions : all_directions()) {
    const LabelInput labels = noise({9, 9, 9}, 3, directions);
    const auto field = make_field(labels, 0.6)->refined(1);
    const auto sampler = field->sampler();
    Random random(2);
    for (int i = 0; i < 200; ++i) {
      const Vec3 at(8 * random.uniform(), 8 * random.uniform(), 8 * random.uniform());
      const Vec3 p = field->frame().to_grid(labels.origin + directions * at);
      Vec3 gradient, other;
      const double here = sampler->between(1, 2, p, gradient);
      constexpr double step = 1e-5;
      Vec3 measured;
      for (int a = 0; a < 3; ++a)
        measured[a] = (sampler->between(1, 2, p + step * Vec3::Unit(a), other) - here) / step;
      // Steps across faces of cells between nodes see the next slope.
      const Vec3 within = (at - at.array().floor().matrix()).array() - 0.5;
      if (within.cwiseAbs().maxCoeff() > 0.499) continue;
      EXPECT_LT((gradient - measured).norm(), 1e-3);
    }
  }
}

TEST(LabelField, RefinedFieldsSayTheSame) {
  const LabelInput labels = noise({9, 9, 9}, 4);
  const auto field = make_field(labels, 1);
  const auto finer = field->refined(2);
  const auto coarse_sampler = field->sampler(), finer_sampler = finer->sampler();
  EXPECT_EQ(finer->refinement(), 2);
  EXPECT_NEAR(finer->band(), 4 * field->band(), 1e-9);
  for (int i = 0; i < 13 * 13 * 13; ++i) {
    const Vec3 p(i % 13, i / 13 % 13, i / 169);
    const NearestRegion coarse = coarse_sampler->nearest(p), fine = finer_sampler->nearest(4 * p);
    EXPECT_EQ(coarse.region, fine.region);
    EXPECT_NEAR(4 * coarse.margin, fine.margin, 1e-4);
    EXPECT_EQ(coarse_sampler->nearest_at_voxel(i % 13, i / 13 % 13, i / 169).region, coarse.region);
    EXPECT_EQ(finer_sampler->nearest_at_voxel(i % 13, i / 13 % 13, i / 169).region, coarse.region);
  }
}

TEST(LabelField, VoxelsWithAnInterfaceAreFound) {
  for (const Eigen::Matrix3d& directions : all_directions())
    for (const double cell : {0.5, 1.0, 2.0}) {
      const LabelInput labels = noise({6, 7, 8}, 3, directions);
      const auto field = make_field(labels, cell * voxel_size(labels));
      const std::vector<MortonKey> keys = field->interface_voxels();
      EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
      EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
      const auto sampler = field->sampler();
      const std::array<int, 3>& n = field->frame().box;
      for (int z = 0; z < n[2]; ++z)
        for (int y = 0; y < n[1]; ++y)
          for (int x = 0; x < n[0]; ++x) {
            bool alike = true;
            for (int k = 1; k < 8; ++k)
              alike &= sampler->nearest_at_voxel(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)).region ==
                       sampler->nearest_at_voxel(x, y, z).region;
            ASSERT_TRUE(alike || std::binary_search(keys.begin(), keys.end(), morton_encode(x, y, z)))
                << x << " " << y << " " << z << ", cell " << cell;
          }
    }
}

TEST(LabelField, SmallCellsWithAnInterfaceAreThoseWhosePointsHaveSeveralRegions) {
  for (const Eigen::Matrix3d& directions : all_directions())
    for (const double cell : {0.6, 0.5, 0.3, 0.25, 0.1}) {
      const LabelInput labels = noise({4, 5, 4}, 3, directions);
      const auto field = make_field(labels, cell * voxel_size(labels));
      const std::vector<MortonKey> keys = field->interface_voxels();
      const auto sampler = field->sampler();
      std::vector<MortonKey> expected;
      const std::array<int, 3>& n = field->frame().box;
      for (int z = 0; z < n[2]; ++z)
        for (int y = 0; y < n[1]; ++y)
          for (int x = 0; x < n[0]; ++x) {
            const RegionIndex there = sampler->nearest_at_voxel(x, y, z).region;
            bool mixed = false;
            for (int k = 1; k < 27 && !mixed; ++k) {
              const Vec3 half(k % 3, k / 3 % 3, k / 9);
              mixed = sampler->nearest(Vec3(x, y, z) + 0.5 * half).region != there;
            }
            if (mixed) expected.push_back(morton_encode(x, y, z));
          }
      std::sort(expected.begin(), expected.end());
      EXPECT_EQ(keys, expected) << "cell " << cell;
    }
}

TEST(LabelField, LeavesOfTheBandHoldAllThatIsWithinIt) {
  const LabelInput labels = make_labels({30, 28, 26}, [](int x, int y, int z) {
    return (Vec3(x, y, z) - Vec3(14, 13, 12)).norm() < 9 ? (x < 14 ? 1 : 2) : 0;
  });
  const auto field = make_field(labels, 1);
  const auto sampler = field->sampler();
  for (const RegionIndex region : std::array<RegionIndex, 3>{0, 1, 2}) {
    const std::vector<LeafOrigin> leaves = field->band_leaves(region);
    const std::array<int, 3>& n = field->frame().cells;
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y)
        for (int x = 0; x < n[0]; ++x) {
          float value;
          sampler->values_at_voxel(x, y, z, std::array<RegionIndex, 1>{region}, &value);
          if (std::abs(value) >= field->band()) continue;
          const auto low = [](int v) { return v / leaf_side * leaf_side; };
          ASSERT_TRUE(std::binary_search(leaves.begin(), leaves.end(), LeafOrigin{low(x), low(y), low(z)}));
        }
  }
}

TEST(LabelField, LabelsFarApartDoNotMeet) {
  const LabelInput labels = make_labels({60, 6, 6}, [](int x, int, int) {
    return x < 5 ? 1 : x >= 55 ? 2 : x >= 28 && x < 31 ? 3 : 0;
  });
  const auto field = make_field(labels, 1);
  const auto sampler = field->sampler();
  const auto at = [&](double x) { return field->frame().to_grid(Vec3(x, 3, 3)); };
  EXPECT_EQ(sampler->nearest(at(2)).region, 1);
  EXPECT_EQ(sampler->nearest(at(29)).region, 3);
  EXPECT_EQ(sampler->nearest(at(57)).region, 2);
  EXPECT_EQ(sampler->nearest(at(15)).region, outside_region);
  EXPECT_EQ(sampler->two_nearest(at(15)), std::nullopt);
  EXPECT_NEAR(field->signed_distance(Vec3(15, 3, 3), 1), field->band(), 1e-5);
  EXPECT_NEAR(field->signed_distance(Vec3(57, 3, 3), 1), field->band(), 1e-5);
  EXPECT_GT(field->signed_distance(Vec3(15, 3, 3), 2), 2);
}

TEST(LabelField, TheSameForAnyNumberOfThreads) {
  const LabelInput labels = noise({40, 33, 38}, 6);
  const auto values_with = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    const auto field = make_field(labels, 1);
    const auto sampler = field->sampler();
    std::vector<float> values;
    for (int z = 0; z < 40; ++z)
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) values.push_back(sampler->nearest_at_voxel(x, y, z).margin);
    return std::pair(values, field->interface_voxels());
  };
  EXPECT_EQ(values_with(1), values_with(4));
}

}  // namespace
}  // namespace tetwright::label_field_test
