// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/smoothing.h"

#include "common/random.h"
#include "tests/simplify/workbench.h"

namespace tetwright::smoothing_test {
namespace {

using Tag = std::optional<MaterialTag>;

TEST(Smoothing, BringsADisplacedInnerPointBack) {
  TetMesh mesh = grid_mesh(2);
  for (Vec3& p : mesh.points)
    if (p == Vec3(1, 1, 1)) p = Vec3(1.3, 1.25, 1.2);
  Workbench w(mesh);
  const float before = w.star(w.at(1.3, 1.25, 1.2)).worst;
  ASSERT_EQ(w.carry_out(smooth(*w.ws, w.rules)), Outcome::done);
  const float after = w.star(w.at(1, 1, 1)).worst;  // the centroid of the cube's points
  EXPECT_GT(after, before);
  w.expect_sound();
}

TEST(Smoothing, SlidesOnTheBoundaryWithoutChangingTheVolume) {
  for (auto* operation : {&smooth, &optimise}) {
    TetMesh mesh = grid_mesh(4);
    for (Vec3& p : mesh.points)
      if (p == Vec3(2, 2, 4)) p = Vec3(2.4, 2.3, 4.25);
    Workbench w(mesh);
    const double volume = w.mesh.total_volume();
    w.rules.objective.kind = Objective::Kind::shape;
    const Index p = w.at(2.4, 2.3, 4.25);
    for (const auto& t : w.star(p).tets) {
      const Tet& v = w.mesh.points(t.tet);
      w.mesh.set_quality(t.tet, w.rules.objective(w.mesh.position(v[0]), w.mesh.position(v[1]),
                                                  w.mesh.position(v[2]), w.mesh.position(v[3])));
    }
    const float before = w.star(p).worst;
    ASSERT_EQ(w.carry_out(operation(*w.ws, w.rules)), Outcome::done);
    EXPECT_GT(w.star(p).worst, before);
    EXPECT_NEAR(w.mesh.total_volume(), volume, 1e-14);
    w.expect_sound();
  }
}

TEST(Smoothing, OptimisingBeatsTheCentroid) {
  TetMesh mesh = grid_mesh(3);
  jitter(mesh, 21, 0.6);
  int better = 0, compared = 0;
  for (Index p = 0; p < mesh.points.size(); ++p) {
    float reached[2];
    int i = 0;
    for (auto* operation : {&smooth, &optimise}) {
      Workbench w(mesh);
      w.star(p);
      w.carry_out(operation(*w.ws, w.rules));
      reached[i++] = w.star(p).worst;
      w.expect_sound();
    }
    better += reached[1] >= reached[0];
    ++compared;
  }
  EXPECT_GT(better, compared * 3 / 4);
}

TEST(Smoothing, ACornerStays) {
  Workbench w(grid_mesh({4, 4, 4}, [](int x, int y, int z) {
    return Tag(z < 2 ? 1 : x < 2 ? 2 : y < 2 ? 3 : 4);
  }));
  w.star(w.at(2, 2, 2));
  EXPECT_EQ(smooth(*w.ws, w.rules), Outcome::material_rule);
  EXPECT_EQ(optimise(*w.ws, w.rules), Outcome::material_rule);
}

TEST(Smoothing, ACornerMayLeaveItsPlaceALittleWhereThatIsAsked) {
  const auto material = [](int x, int y, int z) { return Tag(z < 2 ? 1 : x < 2 ? 2 : y < 2 ? 3 : 4); };
  TetMesh mesh = grid_mesh({4, 4, 4}, material);
  for (Vec3& p : mesh.points)
    if (p == Vec3(2, 2, 2)) p = Vec3(2.5, 2.45, 2.4);
  Workbench w(mesh);
  const SurfaceProjection projection(w.mesh, nullptr);
  w.rules.surface.projection = &projection;
  w.rules.surface.leave_surface = true;
  w.rules.surface.max_distance = 0.2 * w.mesh.space().scale();
  const Index p = w.at(2.5, 2.45, 2.4);
  float worst = w.star(p).worst;
  for (int k = 0; k < 10; ++k) {
    w.star(p);
    if (w.carry_out(optimise(*w.ws, w.rules)) != Outcome::done) break;
    EXPECT_GT(w.star(p).worst, worst);
    worst = w.star(p).worst;
  }
  const double moved = (w.mesh.space().to_input(w.mesh.position(p)) - Vec3(2.5, 2.45, 2.4)).norm();
  EXPECT_GT(moved, 0.1);
  EXPECT_LE(moved, 0.2 + 1e-9);  // from its first position, however often it moves
  w.expect_sound();
}

// The boundary of grains is flat; only inside it may their junctions leave the curves.
TEST(Smoothing, PointsThatMayLeaveTheirSurfaceStayOnFlatFacesAndStraightEdges) {
  TetMesh mesh =
      grid_mesh({4, 4, 4}, [](int x, int y, int z) { return Tag(1 + (x * 7 + y * 3 + z * 5) % 4); });
  Random random(5);
  for (Vec3& p : mesh.points)
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] > 0 && p[axis] < 4) p[axis] += 0.35 * (random.uniform() - 0.5);
  // A turned cube: its faces are not those of the lattice of points.
  const Vec3 axes[3] = {Vec3(2, 1, 2) / 3, Vec3(-2, 2, 1) / 3, Vec3(-1, -2, 2) / 3};
  for (const bool turned : {false, true}) {
    TetMesh of_mesh = mesh;
    if (turned)
      for (Vec3& p : of_mesh.points) p = p.x() * axes[0] + p.y() * axes[1] + p.z() * axes[2];
    Workbench w(of_mesh);
    const SurfaceProjection projection(w.mesh, nullptr);
    w.rules.surface.projection = &projection;
    w.rules.surface.leave_surface = true;
    w.rules.surface.max_distance = 0.2 * w.mesh.space().scale();
    std::size_t moved_on_boundary = 0, moved_inside = 0;
    const auto along = [&](const Vec3& p, int axis) { return turned ? axes[axis].dot(p) : p[axis]; };
    for (Index p = 0; p < mesh.points.size(); ++p) {
      const Vec3 was = w.mesh.space().to_input(w.mesh.position(p));
      w.star(p);
      if (w.carry_out(optimise(*w.ws, w.rules)) != Outcome::done) continue;
      const Vec3 now = w.mesh.space().to_input(w.mesh.position(p));
      bool on_boundary = false;
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {0.0, 4.0})
          if (std::fabs(along(was, axis) - side) < 1e-7) {
            on_boundary = true;
            EXPECT_NEAR(along(now, axis), side, 1e-7);
          }
      ++(on_boundary ? moved_on_boundary : moved_inside);
    }
    EXPECT_GT(moved_on_boundary, 30u);
    EXPECT_GT(moved_inside, 15u);
    w.expect_sound();
  }
}

// Where a flat face ends at a curved one there are many planes; that of the flat face counts.
TEST(Smoothing, PointsThatMayLeaveTheirSurfaceStayOnACapWithACurvedRim) {
  TetMesh mesh =
      grid_mesh({6, 6, 4}, [](int x, int y, int z) { return Tag(1 + (x * 7 + y * 3 + z * 5) % 4); });
  Random random(9);
  std::vector<Vec3>
      corners;  // of the grid: a cap may have a single triangle there, which no other one confirms
  for (Vec3& p : mesh.points) {
    const bool cap = p.z() == 0 || p.z() == 4;
    const bool side = p.x() == 0 || p.x() == 6 || p.y() == 0 || p.y() == 6;
    const bool corner = (p.x() == 0 || p.x() == 6) && (p.y() == 0 || p.y() == 6);
    for (int axis = 0; axis < (cap ? 2 : 3); ++axis)
      if (!side) p[axis] += 0.35 * (random.uniform() - 0.5);
    // A barrel: round, and wider in the middle.
    const Vec3 c = p - Vec3(3, 3, 0);
    const double square = std::max(std::fabs(c.x()), std::fabs(c.y())), round = std::hypot(c.x(), c.y());
    const double scale = (round > 0 ? square / round : 1) * (1.2 - 0.05 * (p.z() - 2) * (p.z() - 2));
    p = Vec3(3 + c.x() * scale, 3 + c.y() * scale, p.z());
    if (cap && corner) corners.push_back(p);
  }
  Workbench w(mesh);
  const SurfaceProjection projection(w.mesh, nullptr);
  w.rules.surface.projection = &projection;
  w.rules.surface.leave_surface = true;
  w.rules.surface.max_distance = 0.2 * w.mesh.space().scale();
  std::size_t moved = 0;
  for (Index p = 0; p < mesh.points.size(); ++p) {
    const Vec3 was = w.mesh.space().to_input(w.mesh.position(p));
    w.star(p);
    if (w.carry_out(optimise(*w.ws, w.rules)) != Outcome::done) continue;
    const Vec3 now = w.mesh.space().to_input(w.mesh.position(p));
    if (std::fabs(was.z()) > 1e-7 && std::fabs(was.z() - 4) > 1e-7) continue;
    if (std::any_of(corners.begin(), corners.end(), [&](const Vec3& c) { return (c - was).norm() < 1e-7; }))
      continue;
    EXPECT_NEAR(now.z(), was.z(), 1e-7);
    ++moved;
  }
  EXPECT_GT(moved, 20u);
}

TEST(Smoothing, AJunctionPointStaysOnAStraightCurve) {
  TetMesh mesh = grid_mesh({4, 4, 4}, [](int x, int, int) { return Tag(x < 2 ? 1 : 2); });
  for (Vec3& p : mesh.points)
    if (p == Vec3(2, 2, 0)) p = Vec3(2, 2.4, 0);
  Workbench w(mesh);
  const Index p = w.at(2, 2.4, 0);
  w.star(p);
  ASSERT_EQ(w.carry_out(optimise(*w.ws, w.rules)), Outcome::done);
  const Vec3 now = w.mesh.space().to_input(w.mesh.position(p));
  EXPECT_NEAR(now.x(), 2, 1e-12);
  EXPECT_NEAR(now.z(), 0, 1e-12);
  EXPECT_LT(now.y(), 2.4);
  w.expect_sound();
}

}  // namespace
}  // namespace tetwright::smoothing_test
