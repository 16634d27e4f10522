// SPDX-License-Identifier: Apache-2.0
#include "tetwright/image_values.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "tests/common/images/images.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

ImageVolume noise(const std::array<int, 3>& size) {
  Random random(11);
  return image_of(size, [&](int, int, int) { return random.uniform(); });
}

/// Separate tets of a size in voxels inside an image.
TetMesh tets_in(const ImageVolume& image, double size, std::size_t count) {
  Random random(12);
  TetMesh mesh;
  for (std::size_t t = 0; t < count; ++t) {
    Vec3 centre;
    for (int a = 0; a < 3; ++a) {
      const double free = image.size[static_cast<std::size_t>(a)] - size;
      centre[a] = -0.5 + size / 2 + free * random.uniform();
    }
    for (const Vec3& p : random_tet(random, centre, size)) mesh.points.push_back(image.to_input(p));
    const auto first = static_cast<Index>(4 * t);
    mesh.tets.push_back({first, first + 1, first + 2, first + 3});
    mesh.materials.push_back(1);
  }
  return mesh;
}

std::array<Vec3, 4> corners(const TetMesh& mesh, const LabelGrid& grid, std::size_t t) {
  std::array<Vec3, 4> tet;
  for (std::size_t i = 0; i < 4; ++i)
    tet[i] = grid.directions.inverse() * (mesh.points[mesh.tets[t][i]] - grid.origin);
  return tet;
}

ImageValues values_of(const TetMesh& mesh, const ImageVolume& image, const ImageMask& mask = {}) {
  return image_values(mesh, image, mask, {0, true, true, true}, "image.nrrd", "mesh.vtu");
}

LabelVolume labels_like(const LabelGrid& grid, const std::function<MaterialTag(int, int, int)>& label) {
  LabelVolume volume;
  static_cast<LabelGrid&>(volume) = grid;
  for (int z = 0; z < grid.size[2]; ++z)
    for (int y = 0; y < grid.size[1]; ++y)
      for (int x = 0; x < grid.size[0]; ++x) volume.labels.push_back(label(x, y, z));
  return volume;
}

}  // namespace

TEST(ImageValues, LinearImagesHaveTheValueOfTheCentroid) {
  ImageVolume image = image_of({58, 56, 60}, [](int x, int y, int z) { return 2 * x - 3 * y + z; });
  rotate(image);
  for (const double size : {0.01, 0.3, 2.0, 50.0}) {
    const TetMesh mesh = tets_in(image, size, size > 5 ? 2 : 50);
    const ImageValues values = values_of(mesh, image);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const std::array<Vec3, 4> tet = corners(mesh, image, t);
      // In the outer halves of voxels the image is constant.
      if (std::any_of(tet.begin(), tet.end(), [&](const Vec3& p) {
            return (p.array() < 0).any() || p.x() > 57 || p.y() > 55 || p.z() > 59;
          }))
        continue;
      const Vec3 c = (tet[0] + tet[1] + tet[2] + tet[3]) / 4;
      EXPECT_NEAR(values.mean[t], 2 * c.x() - 3 * c.y() + c.z(), 1e-8) << size;
    }
    EXPECT_EQ(values.partly_outside.count, 0u);
    EXPECT_EQ(values.nearest.count, 0u);
  }
}

TEST(ImageValues, ProductsOfCoordinatesHaveTheirExactMean) {
  ImageVolume image = image_of({20, 20, 20}, [](int x, int y, int z) { return x * y * z; });
  rotate(image);
  const TetMesh mesh = tets_in(image, 7, 20);
  const ImageValues values = values_of(mesh, image);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::array<Vec3, 4> tet = corners(mesh, image, t);
    if (std::any_of(tet.begin(), tet.end(),
                    [](const Vec3& p) { return p.minCoeff() < 0 || p.maxCoeff() > 19; }))
      continue;
    Vec3 sum = Vec3::Zero();
    double pairs = 0, all = 0;
    for (const Vec3& p : tet) {
      sum += p;
      all += p.prod();
    }
    for (const Vec3& p : tet)
      pairs += sum.x() * p.y() * p.z() + sum.y() * p.x() * p.z() + sum.z() * p.x() * p.y();
    EXPECT_NEAR(values.mean[t], (sum.prod() + pairs + 2 * all) / 120, 1e-9 * 6859);
  }
}

TEST(ImageValues, NoiseHasTheMeanOfItsInterpolation) {
  ImageVolume image = noise({14, 12, 13});
  rotate(image);
  for (const double size : {0.05, 0.6, 1.7, 5.0, 11.0}) {
    const TetMesh mesh = tets_in(image, size, 4);
    const ImageValues values = values_of(mesh, image);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const double expected =
          mean_by_parts([&](const VoxelPoint& p) { return trilinear(image, p); }, corners(mesh, image, t));
      EXPECT_NEAR(values.mean[t], expected, 1e-3) << size;
    }
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
      const Vec3 index = image.directions.inverse() * (mesh.points[p] - image.origin);
      EXPECT_NEAR(values.at_points[p], trilinear(image, {index.x(), index.y(), index.z()}), 1e-6);
    }
  }
}

TEST(ImageValues, SquaresHaveTheMeanOfTheirPiecewiseLinearInterpolation) {
  const ImageVolume image = image_of({16, 16, 16}, [](int x, int, int) { return x * x; });
  const TetMesh mesh = tets_in(image, 6, 5);
  const ImageValues values = values_of(mesh, image);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double expected = mean_by_parts(
        [](const VoxelPoint& p) {
          // Constant in the outer halves of voxels.
          const double x = std::clamp(p[0], 0.0, 15.0), low = std::floor(x);
          return low * low + (x - low) * (2 * low + 1);
        },
        corners(mesh, image, t));
    EXPECT_NEAR(values.mean[t], expected, 1e-4 * 225);
  }
}

TEST(ImageValues, StatisticsAreThoseOfTheVoxelsWithAShare) {
  const ImageVolume image = image_of({4, 4, 4}, [](int x, int, int) {
    return x == 1 ? 3 : x == 2 ? 7 : 1000;
  });
  TetMesh mesh;
  mesh.points = {{1.2, 1.2, 1.2}, {1.6, 1.2, 1.2}, {1.2, 1.6, 1.2}, {1.2, 1.2, 1.6}};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.materials = {1};
  const ImageValues values = values_of(mesh, image);
  const double upper = 0.3;  // share of the voxels at x = 2
  EXPECT_NEAR(values.mean[0], 3 + 4 * upper, 1e-12);
  EXPECT_NEAR(values.deviation[0], 4 * std::sqrt(upper * (1 - upper)), 1e-12);
  EXPECT_EQ(values.minimum[0], 3);
  EXPECT_EQ(values.maximum[0], 7);
  // Touching the plane of the next voxels gives them no share.
  mesh.points[1].x() = 2;
  mesh.points[0].x() = 0.7;
  EXPECT_EQ(values_of(mesh, image).maximum[0], 1000);
  mesh.points[0].x() = mesh.points[2].x() = mesh.points[3].x() = 1;
  EXPECT_EQ(values_of(mesh, image).maximum[0], 7);
}

TEST(ImageValues, OnlyVoxelsOfTheMaskCount) {
  // Bone of 1000 next to air: without a mask the tets at the surface are made of both.
  ImageVolume image = image_of({12, 12, 12}, [](int x, int, int) { return x < 6 ? 1000 : -1000; });
  rotate(image);
  const TetMesh mesh = tets_in(image, 4, 60);
  const LabelVolume bone = labels_like(image, [](int x, int, int) { return x < 6 ? 5 : 0; });
  const ImageValues all = values_of(mesh, image);
  const ImageValues masked = values_of(mesh, image, ImageMask::nonzero(image, bone));
  EXPECT_LT(*std::min_element(all.mean.begin(), all.mean.end()), -900);
  for (const double mean : masked.mean) EXPECT_NEAR(mean, 1000, 1e-4);
  for (const double value : masked.at_points) EXPECT_NEAR(value, 1000, 1e-4);
  EXPECT_GT(masked.nearest.count, 0u);
  EXPECT_LT(masked.nearest.count, 60u);
}

TEST(ImageValues, SharesOfTheMaskAreScaledToOne) {
  Random random(8);
  const ImageVolume image = noise({9, 9, 9});
  std::vector<double> counts;
  const LabelVolume mask = labels_like(image, [&](int, int, int) {
    counts.push_back(random.uniform() < 0.5 ? 1 : 0);
    return static_cast<MaterialTag>(counts.back());
  });
  ImageVolume product = image, indicator = image;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    indicator.channels[0][i] = static_cast<float>(counts[i]);
    product.channels[0][i] *= static_cast<float>(counts[i]);
  }
  const TetMesh mesh = tets_in(image, 3, 30);
  const ImageValues masked = values_of(mesh, image, ImageMask::nonzero(image, mask));
  const ImageValues of_product = values_of(mesh, product), of_indicator = values_of(mesh, indicator);
  for (std::size_t t = 0; t < 30; ++t)
    EXPECT_NEAR(masked.mean[t], of_product.mean[t] / of_indicator.mean[t], 1e-6);
}

TEST(ImageValues, ATetCountsTheVoxelsOfItsOwnLabel) {
  const ImageVolume image = image_of({8, 8, 8}, [](int x, int, int) { return x < 4 ? 10 : 20; });
  // The labels have a grid of their own, which covers half of the image.
  LabelVolume labels = labels_like(image, [](int x, int, int) { return x < 8 ? 1 : 2; });
  labels.size = {16, 8, 2};
  labels.directions.col(0) /= 2;
  labels.origin.x() = -0.25;
  labels.labels.clear();
  for (int i = 0; i < 16 * 8 * 2; ++i) labels.labels.push_back(i % 16 < 8 ? 1 : 2);
  TetMesh mesh;
  mesh.points = {{2, 0, 0}, {5, 0, 0}, {2, 3, 0}, {2, 0, 1.4}};
  mesh.tets = {{0, 1, 2, 3}, {0, 1, 2, 3}, {0, 1, 2, 3}};
  mesh.materials = {1, 2, 9};
  const ImageValues values = values_of(mesh, image, ImageMask::own_label(image, labels));
  EXPECT_EQ(values.mean[0], 10);
  EXPECT_EQ(values.mean[1], 20);
  EXPECT_EQ(values.nearest.count, 1u);
  EXPECT_EQ(values.mean[2], 10);  // no voxel has label 9: the nearest one of any label
  EXPECT_EQ(values.at_points[0], 10);
  EXPECT_EQ(values.at_points[1], 20);
}

TEST(ImageValues, TetsWithoutAVoxelThatCountsHaveTheNearestOne) {
  ImageVolume image = noise({30, 25, 20});
  rotate(image);
  Random random(9);
  std::vector<std::size_t> counting;
  std::size_t voxel = 0;
  const LabelVolume mask = labels_like(image, [&](int, int, int) {
    if (random.uniform() < 0.002) counting.push_back(voxel);
    return static_cast<MaterialTag>(!counting.empty() && counting.back() == voxel++);
  });
  (void)mask;
  LabelVolume sparse = mask;
  std::fill(sparse.labels.begin(), sparse.labels.end(), 0);
  for (const std::size_t v : counting) sparse.labels[v] = 1;
  const TetMesh mesh = tets_in(image, 1, 300);
  const ImageValues values = values_of(mesh, image, ImageMask::nonzero(image, sparse));
  ASSERT_GT(values.nearest.count, 200u);
  std::size_t found = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3 centroid = Vec3::Zero();
    for (const Index p : mesh.tets[t]) centroid += mesh.points[p] / 4;
    double best = std::numeric_limits<double>::infinity(), value = 0;
    for (const std::size_t v : counting) {
      const Vec3 at = image.to_input(
          Vec3(static_cast<double>(v % 30), static_cast<double>(v / 30 % 25), static_cast<double>(v / 750)));
      if ((at - centroid).norm() >= best) continue;
      best = (at - centroid).norm();
      value = image.channels[0][v];
    }
    found += values.mean[t] == value;
  }
  EXPECT_GE(found, values.nearest.count);
}

TEST(ImageValues, VoxelsThatAreNotFiniteDoNotCount) {
  ImageVolume image = image_of({6, 6, 6}, [](int x, int, int) { return x == 3 ? NAN : 4; });
  const TetMesh mesh = tets_in(image, 5, 10);
  const ImageValues values = values_of(mesh, image);
  EXPECT_EQ(values.not_finite, 36u);
  for (const double mean : values.mean) EXPECT_EQ(mean, 4);
  std::fill(image.channels[0].begin(), image.channels[0].end(), NAN);
  EXPECT_THROW(values_of(mesh, image), InputError);
}

TEST(ImageValues, AnImageElsewhereIsRefusedWithBothBoxes) {
  ImageVolume image = noise({6, 6, 6});
  TetMesh mesh = tets_in(image, 2, 5);
  for (Vec3& p : mesh.points) p.x() += 7;
  try {
    values_of(mesh, image);
    FAIL();
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("image.nrrd: no part of the image is in mesh.vtu"), std::string::npos) << what;
    EXPECT_NE(what.find("(-0.5, -0.5, -0.5) to (5.5, 5.5, 5.5)"), std::string::npos) << what;
  }
  // Tets that are partly outside are counted, and the first one is located.
  for (Vec3& p : mesh.points) p.x() -= 3;
  const ImageValues values = values_of(mesh, image);
  EXPECT_GT(values.partly_outside.count, 0u);
  EXPECT_GT(values.partly_outside.first.x(), 4);
}

TEST(ImageValues, DoNotDependOnThreadsOrTheOrderOfTets) {
  ImageVolume image = noise({20, 20, 20});
  rotate(image);
  TetMesh mesh = tets_in(image, 3, 1000);
  const ImageValues values = values_of(mesh, image);
  ImageValues with_one;
  with_threads(1, [&] { with_one = values_of(mesh, image); });
  EXPECT_EQ(values.mean, with_one.mean);
  EXPECT_EQ(values.deviation, with_one.deviation);
  EXPECT_EQ(values.at_points, with_one.at_points);
  std::reverse(mesh.tets.begin(), mesh.tets.end());
  std::vector<double> reversed = values_of(mesh, image).mean;
  std::reverse(reversed.begin(), reversed.end());
  EXPECT_EQ(values.mean, reversed);
}

}  // namespace tetwright
