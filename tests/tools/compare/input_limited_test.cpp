// SPDX-License-Identifier: Apache-2.0
#include "tools/compare/input_limited.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tetwright/mesh_quality.h"

namespace tetwright::input_limited_test {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// A wedge between two planes that meet in the x axis, filled with tets of about the same length.
TetMesh wedge(double angle, int length) {
  TetMesh mesh;
  for (int i = 0; i <= length; ++i) {
    mesh.points.emplace_back(i, 0, 0);
    mesh.points.emplace_back(i, 1, 0);
    mesh.points.emplace_back(i, std::cos(angle), std::sin(angle));
  }
  for (Index i = 0; i < static_cast<Index>(length); ++i) {
    const Index a = 3 * i, b = a + 1, c = a + 2, d = a + 3, e = a + 4, f = a + 5;
    for (const Tet& t : {Tet{a, b, c, d}, Tet{b, e, c, d}, Tet{c, e, f, d}}) {
      mesh.tets.push_back(t);
      mesh.materials.push_back(1);
    }
  }
  return mesh;
}

CreaseCurves edge_of_wedge(int length) {
  CreaseCurves creases;
  creases.points = {Vec3(0, 0, 0), Vec3(length, 0, 0)};
  creases.segments = {{0, 1}};
  return creases;
}

TEST(InputLimited, NarrowestWedges) {
  // Approximately equal to the solid angle while both are small, since the cones of tets are then half as
  // high as wide.
  EXPECT_NEAR(narrowest_wedge(0.1) / degree, 6.3, 0.5);
  EXPECT_GT(narrowest_wedge(0.3), 2.5 * narrowest_wedge(0.1));
  EXPECT_LE(narrowest_wedge(0.55), std::acos(1.0 / 3));
}

TEST(InputLimited, AreThoseInWedgesThatAreTooNarrow) {
  constexpr int length = 5;
  for (const double degrees : {3.0, 12.0}) {
    const TetMesh mesh = wedge(degrees * degree, length);
    const std::size_t bad = mesh_statistics(mesh, 0.1).below_count;
    ASSERT_EQ(bad, mesh.tets.size());
    // All of them except one in three have an edge on the crease.
    EXPECT_EQ(input_limited_tets(mesh, edge_of_wedge(length), 0.1),
              degrees < 6 ? static_cast<std::size_t>(length) : 0U);
    EXPECT_EQ(input_limited_tets(mesh, {}, 0.1), 0U);
    // A crease elsewhere limits nothing.
    CreaseCurves elsewhere = edge_of_wedge(length);
    for (Vec3& p : elsewhere.points) p.z() -= 1;
    EXPECT_EQ(input_limited_tets(mesh, elsewhere, 0.1), 0U);
  }
}

TEST(InputLimited, AreThoseAtCornersThatAreTooSharp) {
  TetMesh mesh;
  mesh.points = {Vec3(0, 0, 0), Vec3(1, 0, 10), Vec3(0, 1, 10), Vec3(-1, -1, 10)};
  mesh.tets = {{0, 2, 1, 3}};
  mesh.materials = {1};
  CreaseCurves creases = edge_of_wedge(1);
  EXPECT_EQ(input_limited_tets(mesh, creases, 0.1), 0U);
  creases.corners = {Vec3(0, 0, 0)};
  EXPECT_EQ(input_limited_tets(mesh, creases, 0.1), 1U);
}

}  // namespace
}  // namespace tetwright::input_limited_test
