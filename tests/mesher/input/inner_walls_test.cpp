// SPDX-License-Identifier: Apache-2.0

// Walls of zero thickness in the surface of their body become sheets.
#include "mesher/input/inner_walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mesher/complex/labelled_complex.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/mesher_input.h"

namespace tetwright::inner_walls_test {
namespace {

TriangleMesh box() { return make_box({0, 0, 0}, {2, 1, 1}); }

TriangleMesh square(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return {.points = {corner, corner + u, corner + u + v, corner + v}, .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

TriangleMesh baffle() { return square({0.5, 0.25, 0.25}, {0.5, 0, 0}, {0, 0.5, 0.5}); }
constexpr double baffle_area = 0.353553;

MesherInput input_of(const TriangleMesh& mesh, const RegionOptions& regions = {},
                     NestedRule nested = NestedRule::automatic, std::vector<MaterialLayer> layers = {}) {
  return make_mesher_input({{"rock", 7, mesh, "rock.off"}}, std::move(layers), nested, {}, regions);
}

std::vector<std::string> sheet_names(const MesherInput& input) {
  std::vector<std::string> names;
  for (const MesherInput::Sheet& s : input.sheets) names.push_back(s.group.name);
  return names;
}

double sheet_area(const MesherInput& input) {
  double area = 0;
  if (!input.complex) return area;
  const std::vector<Vec3>& p = input.complex->points;
  for (const LabelledComplex::SheetFace& f : input.complex->sheets)
    area += (p[f.ids[1]] - p[f.ids[0]]).cross(p[f.ids[2]] - p[f.ids[0]]).norm() / 2;
  return area;
}

std::string said(const MesherInput& input, DiagnosticCode code) {
  std::string text;
  for (const Diagnostic& f : input.findings)
    if (f.code == code) text += diagnostic_text(f) + "\n";
  return text;
}

/// A body with the volume of the box, closed, and one sheet in it.
void expect_sheet(const MesherInput& input, double area, const std::string& name = "rock_sheet") {
  ASSERT_EQ(input.bodies.size(), 1U);
  EXPECT_EQ(input.bodies[0].name, "rock");
  EXPECT_EQ(input.bodies[0].tag, 7);
  EXPECT_NEAR(input.bodies[0].surface.volume, 2, 1e-9);
  EXPECT_EQ(input.bodies[0].surface.closed, input.bodies[0].surface.triangles.size());
  EXPECT_EQ(sheet_names(input), std::vector<std::string>{name});
  EXPECT_NEAR(sheet_area(input), area, 1e-5);
}

/// Bodies and findings as if walls were not looked for: the cleaned surface is repaired as one.
void expect_repaired(const TriangleMesh& mesh, NestedRule nested = NestedRule::automatic) {
  const MesherInput input = input_of(mesh, {}, nested);
  const SurfaceRepair repaired = repair_surface(mesh, "rock.off", nested);
  EXPECT_TRUE(input.sheets.empty());
  EXPECT_EQ(said(input, DiagnosticCode::walls_kept_as_sheets), "");
  ASSERT_EQ(input.bodies.size(), 1 + repaired.nested.size());
  EXPECT_EQ(input.bodies[0].surface.triangles, repaired.surface.triangles);
  EXPECT_EQ(input.bodies[0].surface.points, repaired.surface.points);
}

TEST(InnerWalls, FloatingPiecesAreKept) {
  const MesherInput input = input_of(joined(box(), baffle()));
  expect_sheet(input, baffle_area);
  EXPECT_EQ(
      said(input, DiagnosticCode::walls_kept_as_sheets),
      "a wall of zero thickness inside 'rock', with an area of 0.353553 (kept as the sheet 'rock_sheet')\n");
  EXPECT_EQ(said(input, DiagnosticCode::inner_walls_dropped), "");
  EXPECT_TRUE(input.holes.empty());
}

TEST(InnerWalls, ListedFromBothSidesAreKeptOnce) {
  expect_sheet(input_of(joined(box(), joined(baffle(), turned_over(baffle())))), baffle_area);
}

TEST(InnerWalls, OnEachOtherAreKeptOnce) {
  // The second one has points between the corners on each side, so that no edge is common.
  TriangleMesh other = square({0.5, 0.25, 0.25}, {0.25, 0, 0}, {0, 0.25, 0.25});
  for (const Vec3& shift : {Vec3(0.25, 0, 0), Vec3(0, 0.25, 0.25), Vec3(0.25, 0.25, 0.25)})
    other = joined(other, square(Vec3(0.5, 0.25, 0.25) + shift, {0.25, 0, 0}, {0, 0.25, 0.25}));
  const MesherInput input = input_of(joined(box(), joined(baffle(), other)));
  expect_sheet(input, baffle_area);
  EXPECT_NE(said(input, DiagnosticCode::inner_walls_dropped), "");
}

TEST(InnerWalls, AcrossTheTubeOfATorusAreKept) {
  const TriangleMesh torus = make_torus(1, 0.3);
  std::vector<Index> ring;
  for (Index p = 0; p < torus.points.size(); ++p)
    if (std::abs(torus.points[p].y()) < 1e-9 && torus.points[p].x() > 0) ring.push_back(p);
  const auto angle = [&](Index p) { return std::atan2(torus.points[p].z(), torus.points[p].x() - 1); };
  std::sort(ring.begin(), ring.end(), [&](Index a, Index b) { return angle(a) < angle(b); });
  TriangleMesh mesh = torus;
  for (std::size_t k = 1; k + 1 < ring.size(); ++k) mesh.triangles.push_back({ring[0], ring[k], ring[k + 1]});
  const MesherInput input = input_of(mesh);
  EXPECT_EQ(sheet_names(input), std::vector<std::string>{"rock_sheet"});
  EXPECT_NEAR(sheet_area(input), 3.1058 * 0.09, 1e-4);  // of a polygon with 24 corners
}

TEST(InnerWalls, AttachedByEdgesOfThreeTrianglesAreKept) {
  // From an edge of the box into its inside.
  for (const bool doubled : {false, true}) {
    const TriangleMesh fin{.points = {{0, 0, 0}, {0, 0, 1}, {0.7, 0.5, 0.5}}, .triangles = {{0, 1, 2}}};
    const MesherInput input = input_of(joined(box(), doubled ? joined(fin, turned_over(fin)) : fin));
    expect_sheet(input, std::sqrt(0.74) / 2);
  }
}

TEST(InnerWalls, EndingOnASideWithoutCommonPointsAreKept) {
  expect_sheet(input_of(joined(box(), square({0.5, 0, 0.25}, {0.5, 0, 0}, {0, 0.5, 0.5}))), baffle_area);
}

TEST(InnerWalls, AttachedAllAroundButOpenInTheMiddleAreKept) {
  TriangleMesh plate{.points = {{1, 0, 0},
                                {1, 1, 0},
                                {1, 1, 1},
                                {1, 0, 1},
                                {1, 0.3, 0.3},
                                {1, 0.7, 0.3},
                                {1, 0.7, 0.7},
                                {1, 0.3, 0.7}}};
  for (Index k = 0; k < 4; ++k) {
    const Index next = (k + 1) % 4;
    plate.triangles.push_back({k, next, next + 4});
    plate.triangles.push_back({k, next + 4, k + 4});
  }
  expect_sheet(input_of(joined(box(), plate)), 1 - 0.16);
}

TEST(InnerWalls, ReachingOutsideAreCutOff) {
  const MesherInput input = input_of(joined(box(), square({1.5, 0.25, 0.5}, {2, 0, 0}, {0, 0.5, 0})));
  expect_sheet(input, 0.25);
  EXPECT_NE(said(input, DiagnosticCode::sheet_cut_off), "");
}

TEST(InnerWalls, GroupsNameThem) {
  TriangleMesh mesh = joined(box(), joined(baffle(), square({1.5, 0.25, 0.5}, {0.25, 0, 0}, {0, 0.5, 0})));
  mesh.groups = {{1, "hull"}, {2, "blade"}};
  mesh.triangle_groups.assign(mesh.triangles.size(), 0);
  mesh.triangle_groups[12] = mesh.triangle_groups[13] = 1;
  const MesherInput input = input_of(mesh);
  // The second wall is in the group of the boundary.
  EXPECT_EQ(sheet_names(input), (std::vector<std::string>{"blade", "rock_sheet"}));
  ASSERT_EQ(input.groups.size(), 1U);
  EXPECT_EQ(input.groups[0].group.name, "hull");
}

TEST(InnerWalls, AreLeftOutIfAskedAndWhereThereAreLayers) {
  const TriangleMesh mesh = joined(box(), baffle());
  for (const bool layers : {false, true}) {
    const MesherInput input = layers ? input_of(mesh, {}, NestedRule::automatic, {{"skin", 3, 0.1}})
                                     : input_of(mesh, {RegionRule::outer});
    EXPECT_TRUE(input.sheets.empty());
    ASSERT_EQ(input.bodies.size(), 1U);
    EXPECT_EQ(input.bodies[0].surface.triangles, input_of(box()).bodies[0].surface.triangles);
    EXPECT_NE(said(input, DiagnosticCode::inner_walls_dropped), "");
  }
}

TEST(InnerWalls, InCellsAreKept) {
  TriangleMesh mesh = joined(box(), square({1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
  // One is attached to the wall between the cells, another floats.
  mesh = joined(mesh, square({1, 0, 0}, {0.5, 0, 0}, {0, 1, 0.5}));
  mesh = joined(mesh, square({0.2, 0.2, 0.2}, {0.5, 0, 0}, {0, 0.5, 0}));
  const MesherInput input = input_of(mesh);
  EXPECT_EQ(input.bodies.size(), 2U);
  EXPECT_EQ(sheet_names(input), std::vector<std::string>{"rock_sheet"});
  EXPECT_NEAR(sheet_area(input), 0.25 + 0.5 * std::sqrt(1.25), 1e-6);
  EXPECT_NE(said(input, DiagnosticCode::walls_kept_as_sheets).find("2 walls"), std::string::npos);
}

TEST(InnerWalls, ScansWithHolesAndLoosePiecesOutsideHaveNone) {
  TriangleMesh open = make_sphere(1);
  open.triangles.resize(open.triangles.size() - 7);
  const TriangleMesh debris = square({0, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0});
  expect_repaired(joined(open, debris));
  expect_repaired(joined(open, make_sphere(0.1, {0.3, 0, 0}, 2)));
  expect_repaired(joined(make_sphere(1), square({3, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0})));
  expect_repaired(joined(joined(make_sphere(1), debris), square({3, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0})));
}

TEST(InnerWalls, TinyPiecesAreNone) {
  expect_repaired(joined(make_sphere(1), square({0, 0, 0}, {0.005, 0, 0}, {0, 0.005, 0})));
}

TEST(InnerWalls, InCavitiesAreNone) {
  const TriangleMesh hollow = joined(make_sphere(1), turned_over(make_sphere(0.5)));
  const TriangleMesh mesh = joined(hollow, square({0, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0}));
  expect_repaired(mesh);
  EXPECT_EQ(input_of(mesh, {}, NestedRule::solid).sheets.size(), 1U);
  EXPECT_EQ(input_of(joined(hollow, square({0.6, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0}))).sheets.size(), 1U);
}

TEST(InnerWalls, ThatCannotBeSheetsAreLeftOut) {
  TriangleMesh strip = make_moebius_strip();
  for (Vec3& p : strip.points) p = 0.2 * p + Vec3(1, 0.5, 0.5);
  const MesherInput input = input_of(joined(box(), strip));
  EXPECT_TRUE(input.sheets.empty());
  EXPECT_NE(said(input, DiagnosticCode::inner_walls_dropped).find("one-sided"), std::string::npos);
  EXPECT_EQ(input.bodies[0].surface.triangles.size(), 12U);
}

}  // namespace
}  // namespace tetwright::inner_walls_test
