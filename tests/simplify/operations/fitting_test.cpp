// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/fitting.h"

#include "tests/simplify/workbench.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::fitting_test {
namespace {

/// The boundary of a grid of 4 x 4 x 4 cubes whose top is a roof of height 1/4 with its ridge along y = 2;
/// input units.
TriangleMesh roofed() {
  TetMesh mesh = grid_mesh(4);
  TriangleMesh out;
  for (Vec3& p : mesh.points)
    if (p.z() == 4) p.z() += 0.25 * (1 - std::abs(p.y() - 2) / 2);
  out.points = mesh.points;
  for (const InterfaceTriangle& t : find_interfaces(mesh)) out.triangles.push_back(t.ids);
  return out;
}

double sum_of_squares(const Workbench& w) {
  double sum = 0;
  SurfaceGrid::Edit edit;
  edit.removed = w.grid.triangles();
  w.grid.find_records(edit);
  for (std::size_t i = 0; i < edit.removed.size(); ++i) {
    const auto& p = edit.removed[i].points;
    w.samples->for_each(edit.removed_records[i],
                        [&](const Vec3& at, float) { sum += squared_distance(at, p[0], p[1], p[2]); });
  }
  return sum;
}

TEST(Fitting, BringsTheSurfaceToItsSamples) {
  Workbench w(grid_mesh(4));
  const TriangleMesh roof = roofed();
  w.own_samples(0.3 * w.mesh.space().scale(), &roof);
  const double before = sum_of_squares(w);
  for (int sweep = 0; sweep < 6; ++sweep)
    for (const Index p : w.live_points()) {
      w.star(p);
      (void)w.carry_out(fit_to_samples(*w.ws, w.rules, 0));
    }
  w.expect_sound();
  EXPECT_LT(sum_of_squares(w), 0.01 * before);
  // Points now lie on the ridge.
  int on_ridge = 0;
  for (const Index p : w.live_points()) {
    const Vec3 at = w.mesh.space().to_input(w.mesh.position(p));
    on_ridge += std::abs(at.y() - 2) < 0.12 && at.z() > 4.2;
  }
  EXPECT_GE(on_ridge, 5);
}

TEST(Fitting, KeepsTheFloorOfShapes) {
  Workbench w(grid_mesh(4));
  const TriangleMesh roof = roofed();
  w.own_samples(0.3 * w.mesh.space().scale(), &roof);
  const Index p = w.at(2, 2, 4);
  const float floor = w.star(p).worst * 0.9999f;
  for (const Index q : w.live_points()) {
    w.star(q);
    if (w.carry_out(fit_to_samples(*w.ws, w.rules, floor)) == Outcome::done) {
      EXPECT_GE(w.star(q).worst, floor);
    }
  }
}

TEST(Fitting, LeavesAllElseAlone) {
  Workbench w(grid_mesh(4), [](EditableMesh& m) {
    std::vector<std::uint8_t> frozen(m.point_slots(), 0);
    for (Index p = 0; p < m.point_slots(); ++p) frozen[p] = m.position(p).x() < 0;
    m.freeze(frozen);
  });
  w.star(w.at(2, 2, 4));
  EXPECT_EQ(fit_to_samples(*w.ws, w.rules, 0), Outcome::no_candidate);  // no triangle owns a sample
  const TriangleMesh roof = roofed();
  w.own_samples(0.3 * w.mesh.space().scale(), &roof);
  w.star(w.at(2, 2, 2));
  EXPECT_EQ(fit_to_samples(*w.ws, w.rules, 0), Outcome::no_candidate);  // inside
  w.star(w.at(2, 2, 0));
  EXPECT_EQ(fit_to_samples(*w.ws, w.rules, 0), Outcome::no_candidate);  // fits already
  for (const Index p : w.live_points())
    if (w.mesh.frozen(p)) {
      w.star(p);
      EXPECT_EQ(fit_to_samples(*w.ws, w.rules, 0), Outcome::no_candidate);
    }
}

}  // namespace
}  // namespace tetwright::fitting_test
