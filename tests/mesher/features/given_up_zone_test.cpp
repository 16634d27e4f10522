// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/given_up_zone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/common/features/parts.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/mesher.h"

namespace tetwright::given_up_zone_test {
namespace {

using Fate = CreaseChain::Fate;
using Verdict = SurfacePatches::Verdict;

constexpr double exact = 1e-9;

/// A block of 4 x 1.5 x 1.5 with a slot of this width and depth 1 from above, across x = 3.
TriangleMesh slotted_block(double width) {
  const std::vector<Vec3> profile{{0, 0, 0},           {4, 0, 0},   {4, 0, 1.5}, {3 + width, 0, 1.5},
                                  {3 + width, 0, 0.5}, {3, 0, 0.5}, {3, 0, 1.5}, {0, 0, 1.5}};
  TriangleMesh s;
  const auto n = static_cast<Index>(profile.size());
  s.points = profile;
  for (const Vec3& p : profile) s.points.emplace_back(p + Vec3(0, 1.5, 0));
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    s.triangles.push_back({i, n + j, j});
    s.triangles.push_back({i, n + i, n + j});
  }
  for (const auto& [a, b, c] : {Triangle{0, 1, 4}, Triangle{0, 4, 5}, Triangle{0, 5, 6}, Triangle{0, 6, 7},
                                Triangle{1, 2, 3}, Triangle{1, 3, 4}}) {
    s.triangles.push_back({a, b, c});
    s.triangles.push_back({n + a, n + c, n + b});
  }
  return s;
}

/// The unit cube without the triangles at an edge: a hole that is not flat.
TriangleMesh open_cube() {
  TriangleMesh open = unit_cube();
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return std::count_if(t.begin(), t.end(),
                         [&](Index p) { return open.points[p].x() == 0 && open.points[p].z() == 1; }) == 2;
  });
  return open;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.points) p += by;
  return mesh;
}

DenseMesh mesh_of(const std::vector<MaterialSurface>& surfaces, int resolution) {
  MesherOptions options;
  options.resolution = resolution;
  options.max_refinement = 0;
  return mesh_surfaces(make_mesher_input(surfaces), options, nullptr);
}

bool has_vertex_at(const DenseMesh& dense, const Vec3& place) {
  return std::any_of(dense.mesh.points.begin(), dense.mesh.points.end(),
                     [&](const Vec3& p) { return (p - place).norm() < exact; });
}

/// Number of reported corners; expects that the mesh has a vertex at each.
std::size_t exact_corners(const DenseMesh& dense) {
  for (const Vec3& corner : dense.report.creases.corners)
    EXPECT_TRUE(has_vertex_at(dense, corner)) << corner.transpose();
  return dense.report.creases.corners.size();
}

double length_of(const CreaseCurves& creases) {
  double length = 0;
  for (const auto& [a, b] : creases.segments) length += (creases.points[b] - creases.points[a]).norm();
  return length;
}

/// Number of patches of the boundary.
std::size_t patches_in(const TetMesh& mesh) {
  std::set<std::uint16_t> patches;
  for (const InterfaceTriangle& t : mesh.interfaces) patches.insert(t.patch);
  return patches.size();
}

TEST(GivenUpZone, IsAroundAClosedGapOnly) {
  const DenseMesh dense = mesh_of({{"part", 1, turned(slotted_block(0.02)), "part.off"}}, 40);
  EXPECT_EQ(broken_promise(dense.mesh.points, dense.mesh.tets), "");
  ASSERT_EQ(dense.report.closed_gaps.size(), 1U);
  const SurfacePatches& found = dense.report.features[0].found;
  EXPECT_EQ(found.verdict, Verdict::part);
  EXPECT_EQ(exact_corners(dense), 8U);
  // The edges of the block are 28 long, of which four are cut by the slot.
  EXPECT_NEAR(length_of(dense.report.creases), 28, 8 * 4 * dense.report.cell_size);
  EXPECT_NEAR(found.chains.total(Fate::kept).length, length_of(dense.report.creases), 1e-6);
  EXPECT_GT(found.chains.total(Fate::given_up).length, 6);
  // No face belongs to the sides of the slot, which are inside the solid.
  EXPECT_EQ(patches_in(dense.mesh), 7U);
}

TEST(GivenUpZone, LetsTheSimplifierBe) {
  const TriangleMesh block = slotted_block(0.02);
  const DenseMesh dense = mesh_of({{"part", 1, block, "part.off"}}, 40);
  ASSERT_TRUE(dense.reference && dense.reference->has_patches());
  const Vec3 mouth(3.01, 0, 1.5), away(2, 0, 1.5);
  EXPECT_TRUE(dense.reference->lacks_creases(mouth));
  EXPECT_FALSE(dense.reference->onto_crease(mouth, 0.05));
  EXPECT_FALSE(dense.reference->lacks_creases(away));
  EXPECT_TRUE(dense.reference->onto_crease(away, exact));
}

TEST(GivenUpZone, IsAroundTheContactOfBodiesThatAreNotJoined) {
  const DenseMesh dense = mesh_of({{"open", 1, open_cube(), "open.off"},
                                   {"beside", 2, moved(unit_cube(), Vec3(1, 0.2, 0.3)), "beside.off"}},
                                  40);
  EXPECT_EQ(broken_promise(dense.mesh.points, dense.mesh.tets), "");
  for (const FeatureReport& f : dense.report.features) {
    EXPECT_EQ(f.found.verdict, Verdict::part) << f.name;
    EXPECT_GT(f.found.chains.total(Fate::kept).length, 5) << f.name;
    EXPECT_GT(f.found.chains.total(Fate::given_up).length, 0.5) << f.name;
  }
  // The open cube has two at x = 0, the other one the four at x = 2, and those beside the contact.
  EXPECT_GE(exact_corners(dense), 6U);
  for (const Vec3& corner : dense.report.creases.corners)
    EXPECT_FALSE(corner.x() == 1 && corner.y() < 1 && corner.z() < 1 && corner.y() > 0) << corner.transpose();
}

TEST(GivenUpZone, IsAroundCrossingsOfASurfaceWithItself) {
  // A cube whose lower face is a pyramid that pierces the upper one, without the triangles at an edge.
  TriangleMesh pierced = unit_cube();
  for (Vec3& p : pierced.points) {
    if (p == Vec3(0.5, 0.5, 0)) p.z() = 1.3;
    p.x() *= 3, p.y() *= 3;
  }
  std::erase_if(pierced.triangles, [&](const Triangle& t) {
    return std::count_if(t.begin(), t.end(), [&](Index p) {
             return pierced.points[p].x() == 0 && pierced.points[p].y() == 0;
           }) == 2;
  });
  const MesherInput input = make_mesher_input({{"pierced", 1, pierced, "pierced.off"}});
  ASSERT_TRUE(input.bodies[0].surface.intersects_itself);
  MesherOptions options;
  options.resolution = 60;
  options.max_refinement = 0;
  const DenseMesh dense = mesh_surfaces(input, options, nullptr);
  EXPECT_EQ(broken_promise(dense.mesh.points, dense.mesh.tets), "");
  const SurfacePatches& found = dense.report.features[0].found;
  EXPECT_EQ(found.verdict, Verdict::part);
  EXPECT_TRUE(has_vertex_at(dense, {3, 3, 1}));
  EXPECT_GT(found.chains.total(Fate::kept).length, 24);
  // The edges of the pyramid above the upper face, which the mesh does not have, and next to it.
  EXPECT_NEAR(found.chains.total(Fate::given_up).length, 4 * (0.57 + 0.3), 0.7);
  EXPECT_GE(dense.report.creases.corners.size(), 4U);
  for (const Vec3& p : dense.report.creases.corners) EXPECT_LE(p.z(), 1);
  EXPECT_TRUE(dense.reference->lacks_creases({1.5, 1.2, 1}));
  EXPECT_FALSE(dense.reference->lacks_creases({1.5, 0, 1}));
}

TEST(GivenUpZone, FollowsTheCurvesOfCrossings) {
  // A triangle that passes through a large one: their common segment is from x = 1.5 to x = 2.5.
  RepairedSurface s;
  s.points = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {2, 2, 1}, {1, 2, -1}, {3, 2, -1}};
  s.triangles = {{0, 1, 2}, {3, 4, 5}};
  std::vector<GivenUpZone::Causes> causes(2);
  add_self_crossings(s, causes[0]);
  const GivenUpZone zone(std::move(causes), 0.1);
  EXPECT_TRUE(zone.any() && zone.has(0) && !zone.has(1) && zone.has_only_crossings(0));
  EXPECT_TRUE(zone.contains({2, 2.1, 0}, 0));
  EXPECT_TRUE(zone.contains({1.4, 2, 0}, 0));
  EXPECT_FALSE(zone.contains({1.2, 2, 0}, 0));
  EXPECT_TRUE(zone.affects({1.2, 2, 0}));
  EXPECT_FALSE(zone.affects({4, 2, 0}));
  EXPECT_FALSE(zone.contains({2, 2, 0}, 1));
}

}  // namespace
}  // namespace tetwright::given_up_zone_test
