// SPDX-License-Identifier: Apache-2.0
#include "mesher/body_field.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <numbers>

#include "mesher/labels/label_field.h"
#include "tests/common/temporary_folder.h"
#include "tests/mesher/fields.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright::body_field_test {
namespace {

/// A ball of label 2 whose lower third is label 1, 32 voxels along each side, with the given directions.
LabelVolume two_part_ball(const Eigen::Matrix3d& directions) {
  constexpr int n = 32;
  LabelVolume volume;
  volume.size = {n, n, n};
  volume.directions = directions;
  volume.origin = {100, -50, 7};
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double r = (Vec3(i, j, k) - Vec3::Constant(0.5 * (n - 1))).norm();
        volume.labels.push_back(r > 12 ? 0 : k < 12 ? 1 : 2);
      }
  return volume;
}

/// Writes and reads the labels' level sets: each preserves its volume and position, for any axes and cells.
void expect_same_again(const Eigen::Matrix3d& directions, double cells_per_voxel, double tolerance) {
  const TemporaryFolder folder;
  const LabelVolume volume = two_part_ball(directions);
  const LabelInput labels =
      make_label_input(std::make_unique<MemoryLabelSource>(volume), "ball.nrrd", {}, nullptr);
  const double cell = voxel_size(labels) / cells_per_voxel;
  const auto field = LabelField::make(labels, label_frame(labels, cell, false), false, nullptr);
  write_fields(*field, folder / "ball.vdb");
  const std::vector<NamedSurface> surfaces = read_level_sets(folder / "ball.vdb");
  ASSERT_EQ(surfaces.size(), 2u);
  const double voxel = std::abs(directions.determinant());
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_EQ(surfaces[m].name, labels.materials[m].name);
    const double expected = voxel * static_cast<double>(labels.materials[m].voxels);
    EXPECT_NEAR(enclosed_volume(surfaces[m].surface), expected, tolerance * expected)
        << m << ' ' << cells_per_voxel;
    Vec3 middle = Vec3::Zero(), centre = Vec3::Zero();
    for (const Vec3& p : surfaces[m].surface.points)
      middle += p / static_cast<double>(surfaces[m].surface.points.size());
    std::size_t i = 0, count = 0;
    for (int z = 0; z < volume.size[2]; ++z)
      for (int y = 0; y < volume.size[1]; ++y)
        for (int x = 0; x < volume.size[0]; ++x, ++i)
          if (volume.labels[i] == labels.materials[m].tag) {
            centre += volume.to_input(Vec3(x, y, z));
            ++count;
          }
    EXPECT_LT((middle - centre / static_cast<double>(count)).norm(), 2 * directions.norm());
  }
}

TEST(FieldBuilder, FieldsOfLabelsAreWrittenWithTheirOwnBand) {
  const Eigen::Matrix3d straight = Vec3(1, 1, 1.5).asDiagonal();
  expect_same_again(straight, 1, 0.05);
  expect_same_again(straight, 2.5, 0.05);  // the band is wider than that of surfaces
  expect_same_again(straight, 0.4, 0.15);  // rims thinner than a cell are not resolved
}

TEST(FieldBuilder, FieldsOfTurnedAndMirroredLabels) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix() *
                               Eigen::Matrix3d(Vec3(1, 1.2, 0.8).asDiagonal());
  expect_same_again(turn, 1, 0.05);
  Eigen::Matrix3d mirrored = turn;
  mirrored.col(2) = -mirrored.col(2);
  expect_same_again(mirrored, 1, 0.05);
  expect_same_again(mirrored, 0.4, 0.16);
  // A tilted gantry: axes that are not perpendicular.
  Eigen::Matrix3d tilted = turn;
  tilted.col(2) += 0.3 * tilted.col(1);
  expect_same_again(tilted, 1, 0.05);
}

/// Where the outside between two bodies gives way, all of it becomes the later one.
TEST(BodyField, AClosedGapLeavesTheEarlierBodyAsItIs) {
  constexpr double cell = 0.05;
  const TriangleMesh box = make_box(Vec3::Zero(), Vec3::Ones());
  const std::array<TriangleMesh, 2> others{make_box({1, 1, 0}, {2, 2, 1}),
                                           make_sphere(0.45, Vec3(0.5, 0.5, 1.45))};
  for (const TriangleMesh& other : others) {
    const auto field = make_field({box, other}, cell);
    const auto sampler = field->sampler();
    std::size_t filled = 0;
    for (double x = 0.01; x < 2; x += 0.4 * cell)
      for (double y = 0.01; y < 2; y += 0.4 * cell)
        for (const double z : {0.5, 1.01, 1.02, 1.03, 1.04}) {
          const Vec3 p(x, y, z);
          const RegionIndex region = sampler->nearest(field->frame().to_grid(p)).region;
          const bool is_in_box = p.maxCoeff() < 1;
          EXPECT_EQ(region == 1, is_in_box) << p.transpose();
          const bool is_in_other =
              &other == &others[0] ? x > 1 && y > 1 && z < 1 : (p - Vec3(0.5, 0.5, 1.45)).norm() < 0.45;
          filled += region == 2 && !is_in_other;
        }
    EXPECT_GT(filled, 10u);
  }
}

}  // namespace
}  // namespace tetwright::body_field_test
