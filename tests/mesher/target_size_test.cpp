// SPDX-License-Identifier: Apache-2.0

// Cells chosen for a target number of tets.
#include <gtest/gtest.h>

#include <cmath>

#include "common/samples/samples.h"
#include "tests/mesher/fields.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/error.h"
#include "tetwright/mesher.h"

namespace tetwright::target_size_test {
namespace {

LabelInput ball(int side, double radius) {
  const double centre = 0.5 * (side - 1);
  return make_labels({side, side, side}, [=](int x, int y, int z) {
    return (Vec3(x, y, z) - Vec3::Constant(centre)).squaredNorm() < radius * radius ? 1 : 0;
  });
}

DenseMesh mesh_with(const LabelInput& labels, double cell) {
  MesherOptions options;
  options.voxel_size = cell;
  return mesh_labels(labels, options, nullptr);
}

std::size_t dense_tets(const MesherInput& input, int resolution) {
  MesherOptions options;
  options.resolution = resolution;
  return mesh_surfaces(input, options, nullptr).mesh.tets.size();
}

TEST(TargetSize, SurfacesHaveAmpleTetsAndMoreWithCreases) {
  const MesherInput ball = make_mesher_input({{"", 1, make_sphere(1), ""}});
  EXPECT_EQ(resolution_for_target(ball, 1, {}), 32);
  const std::size_t for_ball = dense_tets(ball, resolution_for_target(ball, 5000, {}));
  EXPECT_GT(for_ball, 25u * 5000);
  EXPECT_LT(for_ball, 60u * 5000);
  EXPECT_THROW(resolution_for_target(ball, 0, {}), UsageError);

  const MesherInput cube = make_input({std::get<TriangleMesh>(make_sample("cube"))});
  const int with_creases = resolution_for_target(cube, 5000, {}),
            without = resolution_for_target(cube, 5000, {.rule = FeatureAngle::Rule::off});
  EXPECT_NEAR(with_creases, std::sqrt(2.5) * without, 0.1 * without);
}

TEST(TargetSize, VolumesTakeLargerCellsForFewTetsAndSmallerOnesForMany) {
  const LabelInput labels = ball(64, 28);
  const double few = cell_size_for_target(labels, 500, {});
  EXPECT_EQ(few, 4);
  EXPECT_EQ(cell_size_for_target(labels, 2500, {}), 2);
  EXPECT_EQ(cell_size_for_target(labels, 20000, {}), 1);
  const double many = cell_size_for_target(labels, 500000, {});
  EXPECT_LT(many, 1);
  EXPECT_GE(many, 0.25);
  EXPECT_THROW(cell_size_for_target(labels, 0, {}), UsageError);

  // The result has enough tets and preserves the volume.
  const DenseMesh dense = mesh_with(labels, few);
  EXPECT_GT(dense.mesh.tets.size(), 20u * 500);
  EXPECT_LT(compare_with_voxels(labels, dense.mesh).worst_volume, 0.02);
  MesherOptions uniform;
  uniform.uniform = true;
  EXPECT_EQ(cell_size_for_target(labels, 500, uniform), 1);
}

TEST(TargetSize, CellsOfVolumesStaySmallForSmallLabelsAndWhereLabelsAreThin) {
  // Chords of larger cells would take more than 1 % off the ball.
  EXPECT_EQ(cell_size_for_target(ball(64, 20), 100, {}), 2);
  EXPECT_EQ(cell_size_for_target(ball(64, 9), 100, {}), 1);
  const auto two_balls = [](int x, int y, int z) {
    return (Vec3(x % 32, y, z) - Vec3::Constant(15.5)).squaredNorm() < 10 * 10 ? 1 : 0;
  };
  EXPECT_EQ(cell_size_for_target(make_labels({64, 32, 32}, two_balls), 50, {}), 1);
  // Sheets of two voxels require voxel-sized cells everywhere.
  const LabelInput sheets = make_labels({48, 48, 48}, [](int, int, int z) { return 1 + z / 2 % 2; });
  EXPECT_EQ(cell_size_for_target(sheets, 500, {}), 1);
}

}  // namespace
}  // namespace tetwright::target_size_test
