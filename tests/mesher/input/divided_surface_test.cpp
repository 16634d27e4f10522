// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/divided_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/mesher/prepared.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"
#include "tetwright/mesher_input.h"

namespace tetwright::divided_surface_test {
namespace {

TriangleMesh without_wall(TriangleMesh mesh, int axis, double at) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](Index p) { return mesh.points[p][axis] == at; });
  });
  return mesh;
}

/// Boxes along x that share walls, each listed once.
TriangleMesh row_of_boxes(const std::vector<double>& ends) {
  TriangleMesh row = make_box({ends[0], 0, 0}, {ends[1], 1, 1});
  for (std::size_t k = 1; k + 1 < ends.size(); ++k)
    row = joined(row, without_wall(make_box({ends[k], 0, 0}, {ends[k + 1], 1, 1}), 0, ends[k]));
  return row;
}

TriangleMesh square(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return {.points = {corner, corner + u, corner + u + v, corner + v}, .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

MesherInput input_of(const TriangleMesh& mesh, const RegionOptions& regions = {},
                     NestedRule nested = NestedRule::automatic) {
  return make_mesher_input({{"rock", 7, mesh, "rock.off"}}, {}, nested, {}, regions);
}

std::vector<std::string> names(const MesherInput& input) {
  std::vector<std::string> all;
  for (const MesherInput::Body& b : input.bodies) all.push_back(b.name);
  return all;
}

std::size_t count(const MesherInput& input, DiagnosticCode code) {
  for (const Diagnostic& f : input.findings)
    if (f.code == code) return f.count;
  return 0;
}

TEST(DividedSurface, InnerWallsMakeMaterialsByVolume) {
  for (const std::size_t step : {1000, 2, 3}) {
    const MesherInput input = input_of(partly_turned_over(row_of_boxes({0, 1, 3, 3.5}), step));
    EXPECT_EQ(names(input), (std::vector<std::string>{"rock_1", "rock_2", "rock_3"}));
    const double volumes[] = {2, 1, 0.5};
    for (std::size_t b = 0; b < input.bodies.size(); ++b) {
      const RepairedSurface& s = input.bodies[b].surface;
      EXPECT_NEAR(s.volume, volumes[b], 1e-12);
      EXPECT_EQ(s.closed, 12U);
      EXPECT_FALSE(s.intersects_itself);
    }
    EXPECT_EQ(input.bodies[0].tag, 7);
    EXPECT_EQ(input.bodies[1].tag, 1);
    EXPECT_EQ(count(input, DiagnosticCode::cells_separated), 3U);
    EXPECT_EQ(count(input, DiagnosticCode::inner_walls_dropped), 0U);
    ASSERT_EQ(input.contacts.size(), 2U);
    EXPECT_NEAR(input.contacts[0].area, 1, 1e-12);
    EXPECT_TRUE(input.complex);
  }
}

TEST(DividedSurface, EqualCellsAreOrderedByTheirLowestPoint) {
  TriangleMesh row = row_of_boxes({0, 1, 2, 3});
  for (Vec3& p : row.points) p = {p.y(), p.z(), -p.x()};
  const MesherInput input = input_of(row);
  ASSERT_EQ(input.bodies.size(), 3U);
  for (std::size_t b = 0; b < 3; ++b) EXPECT_EQ(input.bodies[b].surface.low.z(), static_cast<double>(b) - 3);
}

TEST(DividedSurface, WallsThatCrossWithoutCommonEdgesAreCut) {
  // One wall is part of the block's surface, the other runs across it.
  const TriangleMesh mesh = joined(row_of_boxes({0, 1, 2}), square({0, 0, 0.25}, {2, 0, 0}, {0, 1, 0}));
  const MesherInput input = input_of(mesh);
  ASSERT_EQ(input.bodies.size(), 4U);
  const double volumes[] = {0.75, 0.75, 0.25, 0.25};
  for (std::size_t b = 0; b < 4; ++b) EXPECT_NEAR(input.bodies[b].surface.volume, volumes[b], 1e-9);
}

TEST(DividedSurface, TheOuterBodyAloneIfAsked) {
  const MesherInput input = input_of(row_of_boxes({0, 1, 3}), {RegionRule::outer});
  ASSERT_EQ(input.bodies.size(), 1U);
  EXPECT_EQ(input.bodies[0].name, "rock");
  EXPECT_NEAR(input.bodies[0].surface.volume, 3, 1e-12);
  EXPECT_EQ(count(input, DiagnosticCode::inner_walls_dropped), 2U);
}

TEST(DividedSurface, ClosedShellsAreNoWalls) {
  const TriangleMesh cube = make_box({0, 0, 0}, {1, 1, 1});
  const std::vector<TriangleMesh> meshes{
      joined(cube, make_box({1, 0, 0}, {2, 1, 1})),               // share a face, listed from both sides
      joined(cube, turned_over(make_box({1, 0, 0}, {2, 1, 1}))),  // from one side, twice
      joined(cube, make_box({1, 1, 0}, {2, 2, 1})),               // share an edge
      joined(cube, make_box({0.5, 0.5, 0.5}, {2, 2, 2})),         // cross
      joined(cube, make_box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8})),   // nested
  };
  for (const TriangleMesh& mesh : meshes)
    for (const NestedRule nested : {NestedRule::automatic, NestedRule::material}) {
      const MesherInput cells = input_of(mesh, {}, nested),
                        outer = input_of(mesh, {RegionRule::outer}, nested);
      EXPECT_EQ(names(cells), names(outer));
      EXPECT_EQ(cells.findings.size(), outer.findings.size());
      for (std::size_t b = 0; b < cells.bodies.size(); ++b) {
        EXPECT_EQ(cells.bodies[b].surface.triangles, outer.bodies[b].surface.triangles);
        EXPECT_EQ(cells.bodies[b].surface.points, outer.bodies[b].surface.points);
      }
    }
}

TEST(DividedSurface, FinsAndFoldsOfAScanMakeNoMaterials) {
  const TriangleMesh sphere = make_sphere(1);
  // A fin outside, and a blister over one triangle.
  for (const double height : {0.5, 1e-4}) {
    TriangleMesh mesh = sphere;
    const auto [a, b, c] = mesh.triangles[5];
    const auto tip = static_cast<Index>(mesh.points.size());
    mesh.points.emplace_back((1 + height) / 3 * (mesh.points[a] + mesh.points[b] + mesh.points[c]));
    mesh.triangles.push_back({a, b, tip});
    if (height < 0.5) mesh.triangles.insert(mesh.triangles.end(), {{b, c, tip}, {c, a, tip}});
    EXPECT_EQ(input_of(mesh).bodies.size(), 1U);
  }
}

TEST(DividedSurface, GroupsNameTheCellsTheyAreTheWholeOutsideOf) {
  TriangleMesh mesh = row_of_boxes({0, 1, 3});
  mesh.groups = {{1, "ore"}, {2, "gangue"}, {3, "inlet"}};
  for (const Triangle& t : mesh.triangles) {
    const double x = (mesh.points[t[0]].x() + mesh.points[t[1]].x() + mesh.points[t[2]].x()) / 3;
    mesh.triangle_groups.push_back(x <= 1 ? 0 : x < 3 ? 1 : 2);
  }
  const MesherInput input = input_of(mesh);
  // A cell with two groups outside has no name.
  EXPECT_EQ(names(input), (std::vector<std::string>{"rock_1", "ore"}));
  EXPECT_EQ(input.bodies[0].surface.groups.size(), input.bodies[0].surface.triangles.size());
  EXPECT_EQ(std::count(input.bodies[0].surface.groups.begin(), input.bodies[0].surface.groups.end(), 0U), 2);
}

TEST(DividedSurface, ClosedShellsWithinCellsFollowTheRuleForNestedOnes) {
  const TriangleMesh mesh =
      joined(joined(row_of_boxes({0, 1, 3}), make_box({2, 0.25, 0.25}, {2.5, 0.75, 0.75})),
             make_box({2.1, 0.4, 0.4}, {2.2, 0.6, 0.6}));
  for (const NestedRule nested : {NestedRule::automatic, NestedRule::material}) {
    const MesherInput input = input_of(mesh, {}, nested);
    ASSERT_EQ(input.bodies.size(), 4U);
    EXPECT_NEAR(input.bodies[2].surface.volume, 0.125, 1e-12);
  }
  const MesherInput hollow = input_of(mesh, {}, NestedRule::cavity);
  ASSERT_EQ(hollow.bodies.size(), 3U);
  EXPECT_NEAR(hollow.bodies[0].surface.volume, 2 - 0.125, 1e-12);
  EXPECT_NEAR(hollow.bodies[2].surface.volume, 0.004, 1e-12);
  const MesherInput solid = input_of(mesh, {}, NestedRule::solid);
  ASSERT_EQ(solid.bodies.size(), 2U);
  EXPECT_NEAR(solid.bodies[0].surface.volume, 2, 1e-12);
  EXPECT_EQ(count(solid, DiagnosticCode::cavities_filled), 2U);
}

TEST(DividedSurface, SeedsNameCells) {
  const TriangleMesh row = row_of_boxes({0, 1, 3});
  RegionOptions regions{
      .seeds = {{"air", {0.5, 0.5, 0.5}}, {"oil", {2, 0.5, 0.5}}, {"oil", {2.5, 0.5, 0.5}}}};
  EXPECT_EQ(names(input_of(row, regions)), (std::vector<std::string>{"oil", "air"}));
  regions.seeds.push_back({"water", {2, 0.4, 0.4}});
  EXPECT_THROW(input_of(row, regions), UsageError);
  regions.seeds = {{"far", {9, 9, 9}}};
  EXPECT_THROW(input_of(row, regions), UsageError);
  // A body without inner walls has its own name.
  regions.seeds = {{"ball", {0, 0, 0}}};
  EXPECT_THROW(input_of(make_sphere(1), regions), UsageError);
}

}  // namespace
}  // namespace tetwright::divided_surface_test
