// SPDX-License-Identifier: Apache-2.0
#include "common/images/voxel_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/common/images/images.h"

namespace tetwright {

namespace {

constexpr std::array<int, 3> grid_size{5, 4, 6};

/// Shares of all voxels in a tet.
std::vector<double> shares_of(const std::array<Vec3, 4>& tet, const std::array<int, 3>& size,
                              VoxelWeights::Measures* measures = nullptr) {
  VoxelWeights weights(size);
  std::vector<double> shares(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  const VoxelWeights::Measures found =
      weights.for_each_run(tet, [&](std::size_t voxel, const double* run, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) shares[voxel + i] += run[i];
      });
  if (measures) *measures = found;
  return shares;
}

double volume_of(const std::array<Vec3, 4>& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]).dot(t[3] - t[0]) / 6;
}

/// The six tets of a box around its diagonal.
std::vector<std::array<Vec3, 4>> tets_of_box(const Vec3& low, const Vec3& high) {
  std::vector<std::array<Vec3, 4>> tets;
  std::array<int, 3> axes{0, 1, 2};
  do {
    std::array<Vec3, 4> tet;
    tet[0] = low;
    for (std::size_t i = 0; i < 3; ++i) {
      tet[i + 1] = tet[i];
      tet[i + 1][axes[i]] = high[axes[i]];
    }
    tets.push_back(tet);
  } while (std::next_permutation(axes.begin(), axes.end()));
  return tets;
}

}  // namespace

TEST(VoxelWeights, TheTetsOfTheWholeBoxGiveEachVoxelItsOwnVolume) {
  std::vector<double> sum(5 * 4 * 6);
  for (const auto& tet : tets_of_box(Vec3(-0.5, -0.5, -0.5), Vec3(4.5, 3.5, 5.5))) {
    const std::vector<double> shares = shares_of(tet, grid_size);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += shares[i];
  }
  for (const double share : sum) EXPECT_NEAR(share, 1, 1e-13);
}

TEST(VoxelWeights, PartsOfTheBoxAddUpWhereverTheyAreCut) {
  Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 inner(-0.5 + 5 * random.uniform(), -0.5 + 4 * random.uniform(), -0.5 + 6 * random.uniform());
    std::vector<double> sum(5 * 4 * 6);
    for (const auto& tet : tets_of_box(Vec3(-0.5, -0.5, -0.5), Vec3(4.5, 3.5, 5.5))) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        std::array<Vec3, 4> part = tet;
        part[corner] = inner;
        // Parts outside the tet are inverted, and count negatively here.
        const double sign = (volume_of(part) < 0) != (volume_of(tet) < 0) ? -1 : 1;
        const std::vector<double> shares = shares_of(part, grid_size);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += sign * shares[i];
      }
    }
    for (const double share : sum) ASSERT_NEAR(share, 1, 1e-12);
  }
}

TEST(VoxelWeights, SharesOfTetsInsideTheImageSumToTheirVolumeAndAreNotNegative) {
  Random random(4);
  const std::array<int, 3> size{56, 52, 54};
  for (const double edge : {0.01, 0.1, 0.5, 1.0, 3.0, 10.0, 50.0})
    for (int trial = 0; trial < (edge > 5 ? 1 : 20); ++trial) {
      const std::array<Vec3, 4> tet = random_tet(
          random,
          Vec3(27.5, 25.5, 26.5) +
              (51 - edge) / 2 * Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5),
          edge);
      VoxelWeights::Measures measures;
      const std::vector<double> shares = shares_of(tet, size, &measures);
      const double volume = std::abs(volume_of(tet));
      EXPECT_NEAR(measures.volume / volume, 1, 1e-14);
      EXPECT_NEAR(measures.inside / volume, 1, 1e-9) << edge;
      EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0) / volume, 1, 1e-9) << edge;
      EXPECT_GE(*std::min_element(shares.begin(), shares.end()), -1e-9 * volume);
    }
}

TEST(VoxelWeights, SharesAreTheIntegralsOfTheWeights) {
  Random random(5);
  for (int trial = 0; trial < 4; ++trial) {
    const std::array<Vec3, 4> tet = random_tet(random, Vec3(2, 1.5, 2.5), trial < 2 ? 1.5 : 6);
    VoxelWeights::Measures measures;
    const std::vector<double> shares = shares_of(tet, grid_size, &measures);
    for (int voxel = 0; voxel < 120; voxel += 17) {
      const ImageVolume hat =
          image_of(grid_size, [&](int x, int y, int z) { return (z * 4 + y) * 5 + x == voxel; });
      const double expected =
          measures.volume * mean_by_parts([&](const VoxelPoint& p) { return trilinear(hat, p); }, tet);
      EXPECT_NEAR(shares[static_cast<std::size_t>(voxel)], expected, 2e-3 * measures.volume);
    }
  }
}

TEST(VoxelWeights, PartsOutsideTheImageHaveNoShare) {
  Random random(6);
  for (int trial = 0; trial < 9; ++trial) {
    const Vec3 centre(trial % 3 == 0 ? -1 : 4, trial % 3 == 1 ? -0.5 : 3, trial % 3 == 2 ? 6 : 0);
    const std::array<Vec3, 4> tet = random_tet(random, centre, 3);
    VoxelWeights::Measures measures;
    (void)shares_of(tet, grid_size, &measures);
    const double inside = mean_by_parts(
        [](const VoxelPoint& p) {
          return p[0] >= -0.5 && p[1] >= -0.5 && p[2] >= -0.5 && p[0] <= 4.5 && p[1] <= 3.5 && p[2] <= 5.5
                     ? 1.0
                     : 0.0;
        },
        tet);
    EXPECT_NEAR(measures.inside / measures.volume, inside, 0.01);
  }
  VoxelWeights::Measures measures;
  (void)shares_of(random_tet(random, Vec3(-20, 1, 1), 5), grid_size, &measures);
  EXPECT_EQ(measures.inside, 0);
  (void)shares_of(random_tet(random, Vec3(1, 1, 50), 5), grid_size, &measures);
  EXPECT_EQ(measures.inside, 0);
}

TEST(VoxelWeights, FacesOnPlanesBetweenCellsCountOnce) {
  const std::array<Vec3, 4> tet{Vec3(1, 1, 1), Vec3(3, 1, 1), Vec3(1, 3, 1), Vec3(1, 1, 3)};
  VoxelWeights::Measures measures;
  const std::vector<double> shares = shares_of(tet, grid_size, &measures);
  EXPECT_NEAR(measures.inside, 8.0 / 6, 1e-14);
  double mean = 0;
  for (std::size_t i = 0; i < shares.size(); ++i)
    mean += shares[i] * static_cast<double>(i % 5) / measures.inside;
  EXPECT_NEAR(mean, 1.5, 1e-14);
}

TEST(VoxelWeights, InvertedTetsHavePositiveSharesAndFlatOnesThoseOfTheirCentroid) {
  std::array<Vec3, 4> tet{Vec3(0.2, 0.3, 0.1), Vec3(3.3, 0.4, 0.5), Vec3(0.6, 2.7, 0.8), Vec3(0.9, 1.1, 4.2)};
  const std::vector<double> shares = shares_of(tet, grid_size);
  std::swap(tet[0], tet[1]);
  const std::vector<double> inverted = shares_of(tet, grid_size);
  for (std::size_t i = 0; i < shares.size(); ++i) EXPECT_NEAR(shares[i], inverted[i], 1e-14);
  tet[3] = 0.5 * tet[0] + 0.3 * tet[1] + 0.2 * tet[2];
  VoxelWeights::Measures measures;
  const std::vector<double> flat = shares_of(tet, grid_size, &measures);
  EXPECT_EQ(measures.volume, 1);
  const Vec3 centroid = (tet[0] + tet[1] + tet[2] + tet[3]) / 4;
  double x = 0;
  for (std::size_t i = 0; i < flat.size(); ++i) x += flat[i] * static_cast<double>(i % 5);
  EXPECT_NEAR(x, centroid.x(), 1e-14);
}

TEST(VoxelWeights, OneVoxelHasTheWholeBox) {
  double sum = 0;
  for (const auto& tet : tets_of_box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)))
    sum += shares_of(tet, {1, 1, 1})[0];
  EXPECT_NEAR(sum, 1, 1e-14);
}

}  // namespace tetwright
