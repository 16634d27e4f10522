// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/field_solid.h"

#include <gtest/gtest.h>

#include "mesher/body_field.h"
#include "tests/mesher/fields.h"
#include "tests/mesher/test_surfaces.h"

namespace tetwright::field_solid_test {
namespace {

SolidShape solid_of(const MesherInput& input, double cell, RegionIndex region) {
  const GridFrame frame = make_grid_frame(input.low, input.high, cell, false);
  const auto field = build_field(input, frame, false, {}, {}, {}, nullptr).field;
  return field_solid(*field, field->interface_voxels(), region);
}

TEST(FieldSolid, IsTheSolidOfTheSurface) {
  const TriangleMesh torus = make_torus(3, 1);
  const SolidShape solid = solid_of(make_input({torus}), 0.1, 1);
  EXPECT_TRUE(solid.manifold);
  EXPECT_EQ(solid.components(), 1u);
  EXPECT_EQ(solid.handles(), 1);
  EXPECT_EQ(solid.cavities(), 0u);
  EXPECT_NEAR(solid.volume(), enclosed_volume(torus), 0.005 * enclosed_volume(torus));
}

TEST(FieldSolid, OfOpenAndCarvedOnes) {
  const TriangleMesh ball = make_sphere(2), inner = make_sphere(1);
  const SolidShape open = solid_of(make_input({punctured(ball, 50)}), 0.1, 1);
  EXPECT_EQ(open.components(), 1u);
  EXPECT_EQ(open.handles(), 0);
  EXPECT_NEAR(open.volume(), enclosed_volume(ball), 0.02 * enclosed_volume(ball));
  const SolidShape shell = solid_of(make_input({ball, inner}), 0.1, 1);
  EXPECT_EQ(shell.components(), 1u);
  EXPECT_EQ(shell.cavities(), 1u);
  EXPECT_NEAR(shell.volume(), enclosed_volume(ball) - enclosed_volume(inner), 0.01 * shell.volume());
}

}  // namespace
}  // namespace tetwright::field_solid_test
