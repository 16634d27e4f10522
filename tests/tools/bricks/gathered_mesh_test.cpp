// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/gathered_mesh.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/tools/bricks/cut_meshes.h"
#include "tetwright/resources.h"

namespace tetwright::gathered_mesh_test {
namespace {

using namespace cut_meshes;

void expect_equal(const MeshStatistics& a, const MeshStatistics& b) {
  EXPECT_EQ(a.tets, b.tets);
  EXPECT_EQ(a.points, b.points);
  EXPECT_NEAR(a.volume, b.volume, 1e-12 * b.volume);
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (const auto& [tag, material] : b.materials) {
    ASSERT_EQ(a.materials.count(tag), 1u) << tag;
    EXPECT_EQ(a.materials.at(tag).tets, material.tets) << tag;
    EXPECT_NEAR(a.materials.at(tag).volume, material.volume, 1e-12 * material.volume) << tag;
  }
  EXPECT_EQ(a.min_solid_angle, b.min_solid_angle);
  EXPECT_NEAR(a.mean_solid_angle, b.mean_solid_angle, 1e-12);
  EXPECT_EQ(a.below_count, b.below_count);
  EXPECT_NEAR(a.below_percent, b.below_percent, 1e-12);
  EXPECT_EQ(a.min_dihedral, b.min_dihedral);
  EXPECT_EQ(a.max_dihedral, b.max_dihedral);
  EXPECT_EQ(a.dihedrals.counts, b.dihedrals.counts);
  EXPECT_EQ(a.junction_edges, b.junction_edges);
  ASSERT_EQ(a.interfaces.size(), b.interfaces.size());
  for (const auto& [pair, interface] : b.interfaces) {
    ASSERT_EQ(a.interfaces.count(pair), 1u) << pair_name(pair);
    EXPECT_EQ(a.interfaces.at(pair).triangles, interface.triangles) << pair_name(pair);
    EXPECT_NEAR(a.interfaces.at(pair).area, interface.area, 1e-12 * interface.area) << pair_name(pair);
  }
  EXPECT_TRUE(a.sheets.empty());
}

void expect_whole(const TetMesh& whole, std::vector<BrickPart> parts) {
  const MeshStatistics statistics = mesh_statistics(whole);
  const GatheredMesh gathered = gather(parts, whole.material_names);
  EXPECT_EQ(gathered.mesh.points.size(), whole.points.size());
  EXPECT_TRUE(plain_tets(gathered.mesh) == plain_tets(whole));
  EXPECT_TRUE(plain_faces(gathered.mesh) == plain_faces(whole));
  TetMesh without_patches = gathered.mesh;
  for (InterfaceTriangle& t : without_patches.interfaces) t.patch = 0;
  EXPECT_EQ(without_patches.interfaces, find_interfaces(gathered.mesh));
  EXPECT_EQ(gathered.mesh.material_names, whole.material_names);
  for (const MeshFinding& finding : check_mesh(gathered.mesh)) ADD_FAILURE() << mesh_finding_line(finding);

  const OriginalMesh& original = gathered.original;
  EXPECT_TRUE(plain_faces(original.surface) == plain_faces(whole));
  EXPECT_TRUE(original.surface.tets.empty());
  std::set<Corner> used, points;
  for (const InterfaceTriangle& t : whole.interfaces)
    for (const Index p : t.ids) used.insert(corner(whole.points[p]));
  for (const Vec3& p : original.surface.points) points.insert(corner(p));
  EXPECT_EQ(original.surface.points.size(), points.size());
  EXPECT_TRUE(points == used);
  EXPECT_EQ(original.tets, whole.tets.size());
  ASSERT_EQ(original.volumes.size(), statistics.materials.size());
  for (const auto& [tag, material] : statistics.materials)
    EXPECT_NEAR(original.volumes.at(tag), material.volume, 1e-12 * material.volume) << tag;

  expect_equal(gathered.dense, statistics);
}

/// The octant that contains a point; its lowest bit is the half along the first axis.
std::size_t octant(const Vec3& p) {
  return static_cast<std::size_t>(p.x() > cells / 2.0) + 2 * static_cast<std::size_t>(p.y() > cells / 2.0) +
         4 * static_cast<std::size_t>(p.z() > cells / 2.0);
}

TEST(GatheredMesh, OnePartIsTheWhole) {
  const TetMesh whole = whole_mesh();
  const std::vector<BrickPart> parts = cut(whole, 1, [](std::size_t, const Vec3&) { return 0u; });
  EXPECT_TRUE(parts[0].cut_faces.empty());
  expect_whole(whole, parts);
}

TEST(GatheredMesh, HalvesAndOctantsGiveTheWhole) {
  const TetMesh whole = whole_mesh();
  const std::vector<BrickPart> halves =
      cut(whole, 2, [](std::size_t, const Vec3& p) { return octant(p) & 1; });
  // They touch each other within materials and at interfaces.
  EXPECT_GT(halves[0].cut_faces.size(), 0u);
  EXPECT_EQ(halves[0].cut_faces.size(), halves[1].cut_faces.size());
  expect_whole(whole, halves);
  expect_whole(whole, cut(whole, 8, [](std::size_t, const Vec3& p) { return octant(p); }));
}

// A brick may have no tets, and its neighbours may end where it begins.
TEST(GatheredMesh, PartsMayBeEmptyOrWithoutNeighbours) {
  const TetMesh whole = whole_mesh();
  expect_whole(whole, cut(whole, 20, [](std::size_t, const Vec3& p) { return 2 * octant(p) + 3; }));
  std::vector<BrickPart> empty(3);
  const GatheredMesh none = gather(empty, {});
  EXPECT_TRUE(none.mesh.tets.empty());
  EXPECT_TRUE(none.mesh.interfaces.empty());
  EXPECT_TRUE(none.original.surface.interfaces.empty());
  EXPECT_EQ(none.dense.tets, 0u);
  EXPECT_EQ(none.dense.points, 0u);
}

// Cuts along every face: between equal materials, different ones and at edges of the boundary.
TEST(GatheredMesh, AnyPartitionOfTheTetsGivesTheWhole) {
  const TetMesh whole = whole_mesh();
  Random random(6);
  for (const std::size_t parts : {2, 7, 60}) {
    std::vector<std::size_t> part;
    for (std::size_t t = 0; t < whole.tets.size(); ++t)
      part.push_back(random.below(static_cast<std::uint32_t>(parts)));
    expect_whole(whole, cut(whole, parts, [&](std::size_t t, const Vec3&) { return part[t]; }));
  }
}

TEST(GatheredMesh, MaterialsMayEndAtTheCut) {
  TetMesh whole = grid_mesh({4, 2, 2}, [](int x, int y, int) -> Tag { return x < 2 ? 1 + y : 2 - y; });
  jitter(whole, 3, 0.2);
  whole.interfaces = find_interfaces(whole);
  const std::vector<BrickPart> parts = cut(whole, 2, [](std::size_t t, const Vec3&) { return t % 24 / 12; });
  expect_whole(whole, parts);
}

TEST(GatheredMesh, GivesTheSameBytesForAnyNumberOfThreads) {
  const TetMesh whole = whole_mesh();
  const auto with_threads_of = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    std::vector<BrickPart> parts = cut(whole, 8, [](std::size_t, const Vec3& p) { return octant(p); });
    return gather(parts, {});
  };
  const GatheredMesh a = with_threads_of(1), b = with_threads_of(3);
  EXPECT_EQ(a.mesh.points, b.mesh.points);
  EXPECT_EQ(a.mesh.tets, b.mesh.tets);
  EXPECT_EQ(a.mesh.interfaces, b.mesh.interfaces);
  EXPECT_EQ(a.original.surface.points, b.original.surface.points);
  EXPECT_EQ(a.original.surface.interfaces, b.original.surface.interfaces);
  EXPECT_EQ(a.original.volumes, b.original.volumes);
}

}  // namespace
}  // namespace tetwright::gathered_mesh_test
