#include "mesher/material_field.h"

#include <gtest/gtest.h>

#include "common/random.h"
#include "test_surfaces.h"

namespace tetwright {
namespace {

struct Sphere {
  Vec3 centre{1.5, -2, 0.25};
  double radius = 2;
  GridFrame frame;
  std::unique_ptr<MaterialField> field;
  explicit Sphere(double cell) {
    const ClosedSurface s = close_surface(make_sphere(radius, centre, 6), "");
    frame = make_grid_frame(s.low, s.high, cell, false);
    field = std::make_unique<MaterialField>(s, MaterialField::Material{"ball", 7}, frame, nullptr);
  }
};

TEST(MaterialField, DistancesOfASphere) {
  const Sphere sphere(0.1);
  Random random(3);
  FieldSampler sampler(*sphere.field);
  for (int i = 0; i < 2000; ++i) {
    Vec3 direction(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    direction.normalize();
    const double distance = 0.9 * (random.uniform() - 0.5);
    const Vec3 p = sphere.centre + (sphere.radius + distance) * direction;
    const double read = sphere.field->signed_distance(p, 7);
    // Farther than two voxels away OpenVDB hands distances on from voxel to voxel.
    if (std::abs(distance) < 0.1) {
      EXPECT_NEAR(read, distance, 0.003);
    } else if (std::abs(distance) < 0.25) {
      EXPECT_NEAR(read, distance, 0.02);
    } else {
      EXPECT_EQ(read < 0, distance < 0);
    }
    Vec3 gradient;
    sampler.at(sphere.frame.to_grid(p), gradient);
    if (std::abs(distance) < 0.1) {
      EXPECT_GT(gradient.normalized().dot(direction), 0.99);
      const auto foot = sphere.field->project(p, 7, std::nullopt, 1);
      ASSERT_TRUE(foot);
      EXPECT_NEAR((*foot - sphere.centre).norm(), sphere.radius, 0.003);
      EXPECT_NEAR((*foot - p).norm(), std::abs(distance), 0.01);
    }
  }
  EXPECT_LT(sphere.field->signed_distance(sphere.centre, 7), 0);
  EXPECT_FALSE(sphere.field->project(sphere.centre + Vec3(2.2, 0, 0), 7, std::nullopt, 0.1));
}

TEST(MaterialField, InterfaceCellsAreThoseWithBothSigns) {
  const Sphere sphere(0.25);
  const std::vector<MortonKey> keys = sphere.field->interface_cells();
  FieldSampler sampler(*sphere.field);
  std::size_t found = 0;
  const auto& n = sphere.frame.cells;
  for (int x = 0; x < n[0]; ++x)
    for (int y = 0; y < n[1]; ++y)
      for (int z = 0; z < n[2]; ++z) {
        int inside = 0;
        for (int k = 0; k < 8; ++k)
          inside += sampler.at_node(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)) < 0;
        const bool listed = std::binary_search(keys.begin(), keys.end(), morton_encode(x, y, z));
        EXPECT_EQ(listed, inside != 0 && inside != 8);
        found += listed;
      }
  EXPECT_EQ(found, keys.size());
}

// Wherever the surface lies relative to the leaves of the tree, no cell away from it is listed.
TEST(MaterialField, NoInterfaceCellsDeepInside) {
  for (double x : {6.5, 7.5, 8.5, 9.5, 10.5, 11.5, 12.5, 13.5}) {
    const ClosedSurface s = close_surface(
        joined(make_box({0, 0, 0}, {2, 2, 2}), make_box({x, 6.5, 6.5}, {x + 30, 36.5, 36.5})), "");
    const GridFrame frame = make_grid_frame(s.low, s.high, 1, false);
    const MaterialField field(s, {"", 1}, frame, nullptr);
    FieldSampler sampler(field);
    for (const MortonKey key : field.interface_cells()) {
      const auto cell = morton_decode(key);
      int inside = 0;
      for (int k = 0; k < 8; ++k)
        inside +=
            sampler.at_node(static_cast<int>(cell[0]) + (k & 1), static_cast<int>(cell[1]) + (k >> 1 & 1),
                            static_cast<int>(cell[2]) + (k >> 2)) < 0;
      ASSERT_TRUE(inside != 0 && inside != 8) << x;
    }
  }
}

TEST(MaterialField, CanBeCancelled) {
  Progress progress;
  progress.cancel();
  const ClosedSurface s = close_surface(make_sphere(1), "");
  EXPECT_THROW(MaterialField(s, {"", 1}, make_grid_frame(s.low, s.high, 0.1, false), &progress), Interrupted);
}

}  // namespace
}  // namespace tetwright
