// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/star.h"

#include "tests/simplify/rings.h"
#include "tests/simplify/workbench.h"

namespace tetwright::star_test {
namespace {

using Tag = std::optional<MaterialTag>;

TEST(Star, InnerPointOfOneMaterialHasDimensionThree) {
  Workbench w(grid_mesh(4));
  const Star& star = w.star(w.at(2, 2, 2));
  EXPECT_EQ(star.tets.size(), 24u);
  EXPECT_EQ(star.points.size(), 14u);
  EXPECT_TRUE(star.interface_triangles.empty());
  EXPECT_EQ(star.dimension(), 3);
}

TEST(Star, BoundaryPointHasDimensionTwo) {
  Workbench w(grid_mesh(4));
  EXPECT_EQ(w.star(w.at(2, 2, 0)).dimension(), 2);
  EXPECT_EQ(w.star(w.at(0, 0, 0)).dimension(), 2);  // a sharp corner is still one fan
}

TEST(Star, JunctionsOfTwoMaterials) {
  Workbench w(grid_mesh({4, 4, 4}, [](int x, int, int) { return Tag(x < 2 ? 1 : 2); }));
  EXPECT_EQ(w.star(w.at(2, 2, 2)).dimension(), 2);  // on the interface, inside
  EXPECT_EQ(w.star(w.at(1, 2, 2)).dimension(), 3);
  const Star& star = w.star(w.at(2, 2, 0));  // where the interface meets the boundary
  EXPECT_EQ(star.dimension(), 1);
  int junctions = 0;
  for (std::size_t p = 0; p < star.points.size(); ++p) junctions += star.edge_dimension(p) == 1;
  EXPECT_EQ(junctions, 2);
}

TEST(Star, FourMaterialsMeetInAPointOfDimensionZero) {
  Workbench w(grid_mesh({4, 4, 4}, [](int x, int y, int z) {
    return Tag(z < 2 ? 1 : x < 2 ? 2 : y < 2 ? 3 : 4);
  }));
  EXPECT_EQ(w.star(w.at(2, 2, 2)).dimension(), 0);
  EXPECT_EQ(w.star(w.at(2, 2, 3)).dimension(), 1);  // three regions around a curve
}

TEST(Star, FourSheetsAlongACurveAreAJunction) {
  Workbench w(grid_mesh({2, 2, 2}, [](int x, int y, int) { return Tag(x == y ? 1 : 2); }));
  const Star& star = w.star(w.at(1, 1, 1));
  EXPECT_EQ(star.dimension(), 1);
}

TEST(Star, FansThatTouchInAPointPinchIt) {
  Workbench w(grid_mesh({2, 2, 2}, [](int x, int y, int z) { return Tag(x == y && y == z ? 1 : 2); }));
  EXPECT_EQ(w.star(w.at(1, 1, 1)).dimension(), 0);
}

TEST(Star, GradientsAreExactForTheVolume) {
  TetMesh mesh = grid_mesh({4, 4, 4}, [](int x, int, int) { return Tag(x < 2 ? 1 : 2); });
  jitter(mesh, 9, 0.2);
  Workbench w(mesh);
  for (Index p : w.live_points()) {
    Star& star = w.star(p);
    star.compute_gradients();
    if (star.interface_triangles.empty()) {
      EXPECT_TRUE(star.gradients.empty());
      continue;
    }
    const Vec3 step = Vec3(0.01, -0.02, 0.015) * w.mesh.space().scale();
    for (const auto& g : star.gradients) {
      double before = 0, after = 0;
      for (const auto& t : star.tets) {
        if (t.region != g.region) continue;
        const auto &x = star.positions[t.link[0]], &y = star.positions[t.link[1]],
                   &z = star.positions[t.link[2]];
        before += tet_volume(star.centre_position, x, y, z);
        after += tet_volume(star.centre_position + step, x, y, z);
      }
      EXPECT_GT(before, 0);
      EXPECT_NEAR(after - before, g.change.dot(step), 1e-14);
    }
  }
}

TEST(Star, OfAPointThatIsGoneOrHasTooManyNeighbours) {
  Workbench w(grid_mesh(4));
  const Index p = w.at(2, 2, 2);
  w.mesh.set_incident_tet(p, no_index);
  EXPECT_EQ(w.ws->star.gather(w.mesh, p), Outcome::stale);
  constexpr int many = static_cast<int>(Star::max_points);
  Workbench wheel(ring_mesh(many, 1));
  EXPECT_EQ(wheel.ws->star.gather(wheel.mesh, wheel.at(0, 0, 1)), Outcome::too_large);
  EXPECT_EQ(wheel.ws->star.gather(wheel.mesh, wheel.at(1, 0, 0)), Outcome::done);
}

}  // namespace
}  // namespace tetwright::star_test
