// SPDX-License-Identifier: Apache-2.0

// Patches of boundary and interfaces: read from the mesh, kept with their borders, written back.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/simplify/patches.h"
#include "tests/simplify/workbench.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/simplify.h"

namespace tetwright::patches_test {
namespace {

constexpr int n = 8;
/// Sums and midpoints of points on a plane lie on it within rounding; see common/tolerances.h for other
/// tolerances.
constexpr double rounding = 1e-9;

std::map<Index, std::set<std::uint16_t>> patches_at_points(const TetMesh& mesh) {
  std::map<Index, std::set<std::uint16_t>> out;
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (Index p : t.ids) out[p].insert(t.patch);
  return out;
}

/// Distance of a point from the side of the cube with that number.
double from_side(const Vec3& p, int side) {
  const int axis = (side - 1) / 2;
  return std::abs(p[axis] - ((side - 1) % 2) * n);
}

/// \param leave max distance of points within a side from it.
void expect_sides(const TetMesh& before, const TetMesh& after, double leave) {
  for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
  for (const std::string& d : topology_differences(topology(before), topology(after))) ADD_FAILURE() << d;
  std::array<double, 7> area{};
  for (const InterfaceTriangle& t : after.interfaces) {
    ASSERT_GE(t.patch, 1);
    ASSERT_LE(t.patch, 6);
    const Vec3 &a = after.points[t.ids[0]], &b = after.points[t.ids[1]], &c = after.points[t.ids[2]];
    area[t.patch] += (b - a).cross(c - a).norm() / 2;
    for (const Vec3& p : {a, b, c}) EXPECT_LT(from_side(p, t.patch), leave) << p.transpose();
  }
  for (int side = 1; side <= 6; ++side) EXPECT_NEAR(area[side], n * n, leave * n * n) << side;
  std::size_t corners = 0, on_edges = 0;
  for (const auto& [p, patches] : patches_at_points(after)) {
    on_edges += patches.size() == 2;
    if (patches.size() > 1) {
      for (int side : patches) EXPECT_LT(from_side(after.points[p], side), rounding);
    }
    if (patches.size() < 3) continue;
    ++corners;
    for (int a = 0; a < 3; ++a)
      EXPECT_TRUE(after.points[p][a] == 0 || after.points[p][a] == n) << after.points[p].transpose();
  }
  EXPECT_EQ(corners, 8u);
  EXPECT_LT(on_edges, 12u * (n - 1));
}

struct Case {
  const char* name;
  Schedule schedule;
  std::size_t target;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class Patches : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Schedules, Patches,
                         testing::Values(Case{"tuned", Schedule::tuned, 300},
                                         Case{"tuned_as_far_as_it_goes", Schedule::tuned, 1},
                                         Case{"paper", Schedule::paper, 300}),
                         [](const auto& c) { return c.param.name; });

TEST_P(Patches, SidesOfACubeKeepTheirEdgesAndCorners) {
  const TetMesh mesh = cube_with_sides(n, 1);
  SimplifyOptions options;
  options.target_tets = GetParam().target;
  options.schedule = GetParam().schedule;
  const TetMesh after = simplify(mesh, options);
  EXPECT_LT(after.tets.size(), mesh.tets.size() / 5);
  // The final improvement lets points at bad tets leave a surface by a third of an ideal edge.
  expect_sides(mesh, after, GetParam().schedule == Schedule::paper ? rounding : 0.6);
}

TEST(Patches, SidesStayThroughImprovement) {
  const TetMesh mesh = cube_with_sides(n, 2, 0.9);
  expect_sides(mesh, improve(mesh, ImproveOptions()), 0.3);
}

TEST_P(Patches, ACreaseInAnInterfaceStays) {
  const TetMesh mesh = two_halves(n, 3);
  SimplifyOptions options;
  options.target_tets = GetParam().target;
  options.schedule = GetParam().schedule;
  const TetMesh after = simplify(mesh, options);
  EXPECT_LT(after.tets.size(), mesh.tets.size() / 4);
  for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
  for (const std::string& d : topology_differences(topology(mesh), topology(after))) ADD_FAILURE() << d;
  double low = n, high = 0;
  std::size_t on_crease = 0;
  std::array<std::size_t, 3> triangles{};
  for (const InterfaceTriangle& t : after.interfaces) {
    ASSERT_EQ(t.patch != 0, t.other.has_value());
    ++triangles.at(t.patch);
  }
  EXPECT_GT(triangles[1], 0u);
  EXPECT_GT(triangles[2], 0u);
  for (const auto& [p, patches] : patches_at_points(after)) {
    if (!patches.count(1) || !patches.count(2)) continue;
    ++on_crease;
    const Vec3& at = after.points[p];
    EXPECT_NEAR(at.x(), n / 2, rounding);
    EXPECT_NEAR(at.y(), n / 2, rounding);
    low = std::min(low, at.z());
    high = std::max(high, at.z());
  }
  EXPECT_EQ(low, 0);
  EXPECT_EQ(high, n);
  EXPECT_LT(on_crease, static_cast<std::size_t>(n + 1));
}

// Points at bad tets may leave a surface slightly, but not where patches meet.
TEST(Patches, ImprovementKeepsACrease) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    TetMesh mesh = two_halves(n, seed, 0.9);
    const TetMesh after = improve(mesh, ImproveOptions());
    for (const auto& [p, patches] : patches_at_points(after))
      if (patches.count(1) && patches.count(2)) {
        EXPECT_NEAR(after.points[p].x(), n / 2, rounding);
        EXPECT_NEAR(after.points[p].y(), n / 2, rounding);
      }
  }
}

// Without patches the cube's edges are cut.
TEST(Patches, WithoutThemEdgesMayGo) {
  TetMesh mesh = cube_with_sides(n, 1);
  for (InterfaceTriangle& t : mesh.interfaces) t.patch = 0;
  SimplifyOptions options;
  options.target_tets = 1;
  const TetMesh after = simplify(mesh, options);
  std::size_t corners = 0;
  for (const Vec3& p : after.points)
    corners += (p.x() == 0 || p.x() == n) && (p.y() == 0 || p.y() == n) && (p.z() == 0 || p.z() == n);
  EXPECT_LT(corners, 8u);
  for (const InterfaceTriangle& t : after.interfaces) EXPECT_EQ(t.patch, 0);
}

TEST(Patches, WhatHasThemAndIsNotChangedComesBackWithThem) {
  for (const TetMesh& mesh : {cube_with_sides(3, 4), two_halves(4, 5)}) {
    EditableMesh editable(TetMesh(mesh), "mesh");
    editable.compact(10, 10);
    const TetMesh after = std::move(editable).to_mesh();
    const auto listed = [](const TetMesh& m) {
      std::vector<std::pair<std::array<double, 9>, std::uint16_t>> out;
      for (const InterfaceTriangle& t : m.interfaces) {
        std::array<std::array<double, 3>, 3> corners;
        for (int k = 0; k < 3; ++k) {
          const Vec3& p = m.points[t.ids[k]];
          corners[k] = {p.x(), p.y(), p.z()};
        }
        std::sort(corners.begin(), corners.end());
        std::array<double, 9> flat;
        for (std::size_t i = 0; i < 9; ++i) flat[i] = corners[i / 3][i % 3];
        out.emplace_back(flat, t.patch);
      }
      std::sort(out.begin(), out.end());
      return out;
    };
    EXPECT_EQ(listed(after), listed(mesh));
  }
}

TEST(Patches, OfFacesThatAreNoneAreRefused) {
  TetMesh mesh = cube_with_sides(3, 4);
  for (InterfaceTriangle& t : mesh.interfaces)
    if (t.patch == 3) t.ids[0] = t.ids[0] == 0 ? 1 : 0;
  EXPECT_THROW(EditableMesh(std::move(mesh), "mesh"), InputError);
}

TEST(Patches, MakeCornersAndCreasesOfAStar) {
  Workbench w(cube_with_sides(4, 1, 0));
  EXPECT_EQ(w.star(w.at(2, 2, 2)).dimension(), 3);
  EXPECT_EQ(w.star(w.at(2, 2, 0)).dimension(), 2);
  EXPECT_EQ(w.star(w.at(0, 0, 0)).dimension(), 0);
  const Star& star = w.star(w.at(2, 0, 0));
  EXPECT_EQ(star.dimension(), 1);
  for (std::size_t p = 0; p < star.points.size(); ++p) {
    const Vec3 at = w.mesh.space().to_input(star.positions[p]);
    const int on = (at.y() == 0) + (at.z() == 0);
    EXPECT_EQ(star.edge_dimension(p), 3 - on) << at.transpose();
  }
  // The mesh alone has no patches of interface faces.
  Workbench two(two_halves(4, 1, 0));
  EXPECT_EQ(two.star(two.at(2, 2, 2)).dimension(), 1);
  EXPECT_EQ(two.star(two.at(2, 2, 0)).dimension(), 0);
  EXPECT_EQ(two.star(two.at(2, 1, 2)).dimension(), 2);
  EXPECT_EQ(two.star(two.at(2, 1, 0)).dimension(), 1);
}

}  // namespace
}  // namespace tetwright::patches_test
