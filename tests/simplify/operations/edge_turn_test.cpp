// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/edge_turn.h"

#include <array>
#include <cmath>

#include "tests/simplify/workbench.h"

namespace tetwright::edge_turn_test {
namespace {

/// A solid with a cavity over the triangle 0, 1, 2: its floor is a spike up to point 3, its roof the three
/// triangles to point 4.
TetMesh solid_with_cavity(double floor, double roof) {
  TetMesh mesh;
  for (const double radius : {1.0, 3.0}) {
    for (int k = 0; k < 3; ++k)
      mesh.points.emplace_back(radius * std::cos(2.1 * k), radius * std::sin(2.1 * k), 0);
    if (radius == 1) {
      mesh.points.emplace_back(0, 0, floor);
      mesh.points.emplace_back(0, 0, roof);
    }
  }
  mesh.points.emplace_back(0, 0, 4);
  mesh.points.emplace_back(0, 0, -4);
  constexpr Index spike = 3, top = 4, first_outer = 5, above = 8, below = 9;
  mesh.tets = {{0, 1, 2, spike}, {0, 1, 2, below}};
  for (Index k = 0; k < 3; ++k) {
    const Index p = k, q = (k + 1) % 3, outer_p = first_outer + p, outer_q = first_outer + q;
    mesh.tets.push_back({p, q, top, above});
    for (const Index pole : {above, below}) {
      mesh.tets.push_back({p, q, outer_q, pole});
      mesh.tets.push_back({p, outer_q, outer_p, pole});
    }
  }
  for (Tet& t : mesh.tets)
    if (orient3d(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) < 0)
      std::swap(t[0], t[1]);
  mesh.materials.assign(mesh.tets.size(), 1);
  return mesh;
}

/// Outcome of moving the cavity's top to height `z`.
Outcome move_top(double z) {
  Workbench w(solid_with_cavity(1.2, 1.5));
  const Index top = w.at(0, 0, 1.5);
  const Star& star = w.star(top);
  Proposal& p = w.ws->proposal;
  const Vec3 to =
      w.mesh.position(top) +
      Vec3(0, 0, (z - 1.5) * (w.mesh.position(w.at(0, 0, 4)) - w.mesh.position(top)).norm() / 2.5);
  for (const Star::InterfaceTriangle& s : star.interface_triangles) {
    const Triangle ids{star.centre, star.points[s.first], star.points[s.second]};
    const Vec3 &a = star.positions[s.first], &b = star.positions[s.second];
    p.edit.removed.push_back({ids, {star.centre_position, a, b}});
    p.edit.added.push_back({{ids, {to, a, b}}, s.patch});
  }
  EXPECT_TRUE(w.grid.test(p.edit));  // no triangles intersect
  p.change = Proposal::Change::move;
  p.centre = top;
  p.position = to;
  p.claim_star(star);
  for (const Star::StarTet& t : star.tets) {
    const auto at = [&](std::size_t k) { return star.positions[t.link[k]]; };
    EXPECT_GT(orient3d(to, at(0), at(1), at(2)), 0);  // and all tets are positive
  }
  return w.ws->within_bounds(w.rules, 0);
}

TEST(EdgeTurn, NoCavityIsTurnedInsideOut) {
  EXPECT_EQ(move_top(1.7), Outcome::done);
  EXPECT_EQ(move_top(1.25), Outcome::done);
  EXPECT_EQ(move_top(1.15), Outcome::self_intersection);
  EXPECT_EQ(move_top(0.5), Outcome::self_intersection);
}

}  // namespace
}  // namespace tetwright::edge_turn_test
