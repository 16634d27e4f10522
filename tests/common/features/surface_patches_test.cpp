// SPDX-License-Identifier: Apache-2.0
#include "tetwright/surface_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "common/random.h"
#include "tests/common/features/parts.h"
#include "tests/mesher/test_surfaces.h"
#include "tests/simplify/meshes.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::surface_patches_test {
namespace {

using Verdict = SurfacePatches::Verdict;
constexpr FeatureAngle automatic{};
constexpr FeatureAngle off{FeatureAngle::Rule::off, 0};
constexpr FeatureAngle degrees(double angle) { return {FeatureAngle::Rule::degrees, angle}; }

SurfacePatches patches_of(const TriangleMesh& s, const FeatureAngle& angle = automatic, double min_area = 0) {
  return find_patches(s.points, s.triangles, {angle, min_area}, {}, "s.off");
}

SurfaceCreases creases_of(const TriangleMesh& s, const FeatureAngle& angle = automatic) {
  return find_creases(s.points, s.triangles, patches_of(s, angle).patches);
}

TriangleMesh noisy_sphere() {
  TriangleMesh sphere = make_sphere(1);
  Random random(3);
  for (Vec3& p : sphere.points) p *= 1 + 0.05 * (random.uniform() - 0.5);
  return sphere;
}

TEST(SurfacePatches, OfACubeAreItsSides) {
  const TriangleMesh cube = turned(unit_cube());
  const SurfacePatches found = patches_of(cube);
  EXPECT_EQ(found.verdict, Verdict::part);
  EXPECT_EQ(found.count, 6U);
  EXPECT_EQ(found.dropped, 0U);
  // Patches are numbered by their first triangles; all triangles of a patch have the same normal.
  EXPECT_EQ(found.patches.front(), 0);
  std::vector<std::optional<Vec3>> normals(6);
  for (std::size_t t = 0; t < cube.triangles.size(); ++t) {
    const auto& [a, b, c] = cube.triangles[t];
    const Vec3 n = (cube.points[b] - cube.points[a]).cross(cube.points[c] - cube.points[a]).normalized();
    std::optional<Vec3>& known = normals[found.patches[t]];
    if (!known) known = n;
    EXPECT_LT((*known - n).norm(), 1e-12);
  }
  const SurfaceCreases creases = creases_of(cube);
  EXPECT_EQ(creases.segments.size(), 12U);
  EXPECT_EQ(creases.corners.size(), 8U);
}

TEST(SurfacePatches, KeepConcaveEdges) {
  const SurfaceCreases creases = creases_of(turned(l_block()));
  EXPECT_EQ(creases.segments.size(), 18U);
  EXPECT_EQ(creases.corners.size(), 12U);
}

TEST(SurfacePatches, HoldTheFacetsOfACylinderTogether) {
  // The edges between twelve facets turn by 30 degrees, the rims by 90.
  for (const int facets : {12, 64}) {
    const TriangleMesh s = turned(cylinder(facets));
    EXPECT_EQ(patches_of(s).count, 3U) << facets;
    const SurfaceCreases creases = creases_of(s);
    EXPECT_EQ(creases.segments.size(), static_cast<std::size_t>(2 * facets));
    EXPECT_TRUE(creases.corners.empty());
  }
  // A prism of six facets does not count as a cylinder.
  EXPECT_EQ(patches_of(cylinder(6)).count, 8U);
  // An explicit angle takes precedence.
  EXPECT_EQ(patches_of(cylinder(12), degrees(20)).count, 14U);
  EXPECT_EQ(patches_of(cylinder(12), degrees(100)).count, 1U);
}

TEST(SurfacePatches, AreNotLookedForOnScans) {
  EXPECT_EQ(patches_of(make_sphere(1)).verdict, Verdict::smooth);
  const TriangleMesh scan = noisy_sphere();
  const SurfacePatches found = patches_of(scan);
  EXPECT_EQ(found.verdict, Verdict::scan);
  EXPECT_FALSE(found.any());
  EXPECT_GT(found.loose_ends_high, 0.2);
  EXPECT_EQ(found.patches, std::vector<std::uint16_t>(scan.triangles.size(), 0));
  // An explicit angle overrides the verdict.
  EXPECT_EQ(patches_of(scan, degrees(30)).verdict, Verdict::part);
  EXPECT_EQ(patches_of(unit_cube(), off).verdict, Verdict::off);
  EXPECT_FALSE(patches_of(unit_cube(), off).any());
}

TEST(SurfacePatches, OfANoisySurfaceAreItsFlatParts) {
  const TriangleMesh s = terrain(24);
  const SurfacePatches found = patches_of(s);
  EXPECT_EQ(found.verdict, Verdict::part);
  EXPECT_EQ(found.count, 6U);
  EXPECT_GT(std::max(found.loose_ends_low / 0.09, found.loose_ends_high / 0.2), 1);
  EXPECT_NEAR(found.noisy_share, 1.0 / 6, 0.02);
  // The first triangle is of the noise. Its rim is a zigzag without corners other than the four of the walls.
  ASSERT_EQ(found.rough, (std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0}));
  const SurfaceCreases creases = find_creases(s.points, s.triangles, found.patches, 0, found.rough);
  EXPECT_EQ(creases.corners.size(), 8U);
}

TEST(SurfacePatches, CountNoLooseEndsAtOpenBorders) {
  // A wing without ribs: its trailing edge is the only crease, and ends at both of its borders.
  TriangleMesh s;
  constexpr Index around = 24, along = 4;
  for (Index k = 0; k <= along; ++k)
    for (Index i = 0; i < around; ++i) {
      const double t = 2 * std::numbers::pi * i / around, width = std::sin(t / 2);
      s.points.emplace_back(std::cos(t), 0.3 * std::sin(t) * width, k);
    }
  for (Index k = 0; k < along; ++k)
    for (Index i = 0; i < around; ++i) {
      const Index a = k * around + i, b = k * around + (i + 1) % around;
      s.triangles.push_back({a, b, b + around});
      s.triangles.push_back({a, b + around, a + around});
    }
  const SurfacePatches found = patches_of(s);
  EXPECT_EQ(found.loose_ends_high, 0);
  EXPECT_NE(found.verdict, Verdict::scan);
}

TEST(SurfacePatches, LeaveOutCreasesThatFadeOut) {
  EXPECT_EQ(patches_of(folded_strip(8), degrees(35)).count, 1U);
  EXPECT_EQ(patches_of(folded_strip(20), degrees(35)).count, 2U);
}

TEST(SurfacePatches, DoNotHangTogetherAcrossFlatTriangles) {
  // A point in the middle of an edge, used on one side only, and the flat triangle that closes the gap.
  TriangleMesh s = turned(unit_cube());
  const Triangle t = s.triangles[2];  // a wall, with an edge of the bottom
  ASSERT_EQ(patches_of(s).count, 6U);
  const auto middle = static_cast<Index>(s.points.size());
  s.points.push_back((s.points[t[0]] + s.points[t[1]]) / 2);
  s.triangles[2] = {t[0], middle, t[2]};
  s.triangles.push_back({middle, t[1], t[2]});
  s.triangles.push_back({t[0], t[1], middle});
  EXPECT_EQ(patches_of(s).count, 6U);
}

TEST(SurfacePatches, SmallOnesGoToTheirNeighbours) {
  TriangleMesh s = unit_cube();
  // A separate solid next to it: none of its six sides is large, and the last one has no neighbour to merge
  // with.
  const TriangleMesh bump =
      extruded({{0.4, 0.4}, {0.41, 0.4}, {0.41, 0.41}, {0.4, 0.41}}, {0.405, 0.405}, 0.01);
  s = joined(s, bump);
  EXPECT_EQ(patches_of(s).count, 12U);
  const SurfacePatches without = patches_of(s, automatic, 0.01);
  EXPECT_EQ(without.dropped, 5U);
  EXPECT_EQ(without.count, 7U);
}

TEST(SurfacePatches, StayWithinGroups) {
  const TriangleMesh s = make_sphere(1);
  std::vector<std::uint32_t> groups;
  for (const Triangle& t : s.triangles)
    groups.push_back(s.points[t[0]].z() + s.points[t[1]].z() + s.points[t[2]].z() > 0 ? 7 : 3);
  const SurfacePatches found = find_patches(s.points, s.triangles, {off, 0}, groups, "s.off");
  EXPECT_EQ(found.count, 2U);
  for (std::size_t t = 0; t < groups.size(); ++t)
    EXPECT_EQ(found.patches[t] == found.patches[0], groups[t] == groups[0]);
  const SurfaceCreases creases = find_creases(s.points, s.triangles, found.patches);
  EXPECT_EQ(creases.segments.size(), 64U);  // the equator
  EXPECT_TRUE(creases.corners.empty());
}

TEST(SurfacePatches, AreAtMost65535) {
  TriangleMesh s = make_sphere(1, Vec3::Zero(), 7);
  Random random(1);
  for (Vec3& p : s.points) p *= 1 + 0.1 * (random.uniform() - 0.5);
  try {
    (void)patches_of(s, degrees(1));
    FAIL() << "no error";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("--feature-angle"), std::string::npos) << e.what();
  }
}

TEST(SurfacePatches, KinksAreCorners) {
  // The rim of the L's top is a single crease, between the top and the wall around it.
  const TriangleMesh s = l_block();
  std::vector<std::uint16_t> patches;
  for (const Triangle& t : s.triangles) {
    const double z = s.points[t[0]].z() + s.points[t[1]].z() + s.points[t[2]].z();
    patches.push_back(z == 0 ? 0 : z == 3 ? 1 : 2);
  }
  EXPECT_EQ(find_creases(s.points, s.triangles, patches).corners.size(), 12U);
}

TEST(SurfacePatches, AZigzagHasNoCorners) {
  // A strip of squares of width 1, with a border between two patches that alternates up and down by 1, and
  // turns once.
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::uint16_t> patches;
  constexpr int n = 60;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) points.emplace_back(x, y, 0);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const auto p = static_cast<Index>(y * (n + 1) + x), q = p + n + 1;
      const bool inside = x >= 30 + x % 2 && y >= 30 + x % 2;
      for (const Triangle& t : {Triangle{p, p + 1, q + 1}, Triangle{p, q + 1, q}}) {
        triangles.push_back(t);
        patches.push_back(inside ? 1 : 0);
      }
    }
  EXPECT_GT(find_creases(points, triangles, patches).corners.size(), 20U);
  const std::vector<Index> corners = find_creases(points, triangles, patches, 8).corners;
  // Both ends, and the turn within the reach.
  EXPECT_GE(corners.size(), 3U);
  EXPECT_LE(corners.size(), 4U);
  EXPECT_TRUE(std::any_of(corners.begin(), corners.end(),
                          [&](Index c) { return (points[c] - Vec3(30, 30, 0)).norm() < 4; }));
}

TEST(MeshPatches, KeepTheirGroups) {
  TetMesh mesh = grid_mesh({4, 4, 4}, [](int, int, int) { return 1; });
  mesh.interfaces = find_interfaces(mesh);
  const MaterialPair outer{1, std::nullopt};
  for (InterfaceTriangle& t : mesh.interfaces)
    if (std::all_of(t.ids.begin(), t.ids.end(), [&](Index p) { return mesh.points[p].x() <= 2; }))
      t.patch = 9;
  mesh.patch_groups[{outer, 9}] = {0, "half"};
  EXPECT_EQ(find_mesh_patches(mesh, {}, "mesh").count, 10U);
  EXPECT_EQ(mesh.patch_groups.size(), 5U);
  for (const InterfaceTriangle& t : mesh.interfaces) {
    const Vec3 centre = (mesh.points[t.ids[0]] + mesh.points[t.ids[1]] + mesh.points[t.ids[2]]) / 3;
    const auto group = mesh.patch_groups.find({outer, t.patch});
    EXPECT_EQ(group != mesh.patch_groups.end() && group->second.name == "half", centre.x() < 2);
  }
}

TEST(MeshPatches, AreNumberedForEachPairOfMaterials) {
  TetMesh mesh =
      grid_mesh({4, 4, 4}, [](int x, int, int) { return std::optional<MaterialTag>(x < 2 ? 1 : 2); });
  const SurfacePatches found = find_mesh_patches(mesh, automatic, "m.vtu");
  EXPECT_EQ(found.verdict, Verdict::part);
  EXPECT_EQ(found.count, 11U);  // five sides for each material, and the interface
  std::map<MaterialPair, std::set<std::uint16_t>> numbers;
  for (const InterfaceTriangle& t : mesh.interfaces) numbers[t.pair()].insert(t.patch);
  EXPECT_EQ(numbers.at({1, std::nullopt}), (std::set<std::uint16_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(numbers.at({2, std::nullopt}), (std::set<std::uint16_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(numbers.at({1, 2}), std::set<std::uint16_t>{0});
  // Eight edges of 4 x 4 sides that are not on a junction curve, of four or two segments.
  const CreaseCurves curves = mesh_creases(mesh);
  EXPECT_EQ(curves.segments.size(), 8U * 4 + 8U * 2);
}

TEST(MeshPatches, KeepThoseThatAreThere) {
  TetMesh mesh = grid_mesh(3);
  mesh.interfaces = find_interfaces(mesh);
  for (InterfaceTriangle& t : mesh.interfaces) t.patch = mesh.points[t.ids[0]].z() < 1 ? 5 : 0;
  (void)find_mesh_patches(mesh, off, "m.vtu");
  std::set<std::uint16_t> numbers;
  for (const InterfaceTriangle& t : mesh.interfaces) numbers.insert(t.patch);
  EXPECT_EQ(numbers.size(), 2U);
}

TEST(MeshPatches, OfVoxelsAreNone) {
  // Balls of cubes: nearly every edge turns by 90 degrees.
  TetMesh mesh = grid_mesh({24, 24, 24}, [](int x, int y, int z) -> std::optional<MaterialTag> {
    if ((Vec3(x, y, z) - Vec3::Constant(11.5)).norm() < 11) return 1;
    return {};
  });
  EXPECT_EQ(find_mesh_patches(mesh, automatic, "m.vtu").verdict, Verdict::staircase);
  std::vector<Triangle> triangles;
  for (const InterfaceTriangle& t : mesh.interfaces) triangles.push_back(t.ids);
  EXPECT_EQ(find_patches(mesh.points, triangles, {automatic, 50}, {}, "m.off").verdict, Verdict::staircase);
  for (const InterfaceTriangle& t : mesh.interfaces) EXPECT_EQ(t.patch, 0);
}

TEST(MeshPatches, OfManyMaterialsAreFewOfEachPair) {
  // More pairs of materials than patch numbers.
  TetMesh mesh = grid_mesh(
      {30, 30, 30}, [](int x, int y, int z) { return std::optional<MaterialTag>(x + 30 * (y + 30 * z)); });
  const SurfacePatches found = find_mesh_patches(mesh, off, "m.vtu");
  EXPECT_GT(found.count, 65535U);
  for (const InterfaceTriangle& t : mesh.interfaces) EXPECT_EQ(t.patch, 0);
}

}  // namespace
}  // namespace tetwright::surface_patches_test
