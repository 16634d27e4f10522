// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/surface_projection.h"

#include "tests/simplify/workbench.h"

namespace tetwright::slide_test {
namespace {

TEST(SurfaceProjection, KnowsSurfacesByTheirMaterialsAndJunctionCurves) {
  Workbench w(
      grid_mesh({4, 4, 4}, [](int x, int, int) { return std::optional<MaterialTag>(x < 2 ? 1 : 2); }));
  const SurfaceProjection projection(w.mesh, nullptr);
  const double s = w.mesh.space().scale();
  const auto at = [&](double x, double y, double z) { return w.mesh.space().to_working({x, y, z}); };
  const auto interface = projection.onto_surface(at(1.7, 2.2, 2.1), 0, 1, 0, s);
  ASSERT_TRUE(interface);
  EXPECT_NEAR((*interface - at(2, 2.2, 2.1)).norm(), 0, 1e-12);
  const auto boundary = projection.onto_surface(at(1, 2.2, 0.3), 0, outside_id, 0, s);
  ASSERT_TRUE(boundary);
  EXPECT_NEAR((*boundary - at(1, 2.2, 0)).norm(), 0, 1e-12);
  EXPECT_FALSE(projection.onto_surface(at(3, 2.2, 0.3), 0, outside_id, 0,
                                       0.5 * s));  // that is the boundary of the other material
  const auto curve = projection.onto_curve(at(2.1, 3, 0.2), s);
  ASSERT_TRUE(curve);
  EXPECT_NEAR((*curve - at(2, 3, 0)).norm(), 0, 1e-12);
  EXPECT_FALSE(projection.onto_curve(at(2, 2, 2), s));
}

TEST(SurfaceProjection, KnowsWhereJunctionCurvesBranch) {
  Workbench w(grid_mesh({4, 4, 4}, [](int x, int y, int z) {
    return std::optional<MaterialTag>(z < 2 ? 1 : x < 2 ? 2 : y < 2 ? 3 : 4);
  }));
  const SurfaceProjection projection(w.mesh, nullptr);
  const double s = w.mesh.space().scale();
  const auto at = [&](double x, double y, double z) { return w.mesh.space().to_working({x, y, z}); };
  const auto corner = projection.onto_corner(at(2.2, 1.9, 2.3), s);
  ASSERT_TRUE(corner);
  EXPECT_NEAR((*corner - at(2, 2, 2)).norm(), 0, 1e-12);
  const auto on_boundary = projection.onto_corner(at(2.1, 2, 3.8), s);
  ASSERT_TRUE(on_boundary);
  EXPECT_NEAR((*on_boundary - at(2, 2, 4)).norm(), 0, 1e-12);
  EXPECT_FALSE(projection.onto_corner(at(2, 0.9, 2), 0.5 * s));  // a curve, but no corner
}

}  // namespace
}  // namespace tetwright::slide_test
