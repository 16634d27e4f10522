// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/gathered_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "tests/simplify/meshes.h"
#include "tetwright/resources.h"

namespace tetwright::gathered_mesh_test {
namespace {

using Corner = std::array<double, 3>;
using Tag = std::optional<MaterialTag>;

Corner corner(const Vec3& p) { return {p[0], p[1], p[2]}; }

Triangle ascending_ids(Triangle ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

constexpr int cells = 6;

/// A mesh of three materials with a cavity, whose faces on two sides of its box are patches.
TetMesh whole_mesh() {
  TetMesh mesh = grid_mesh({cells, cells, cells}, [](int x, int y, int z) -> Tag {
    if (x == 4 && y == 4 && z == 4) return {};
    return z < 2 ? -9 : x + y < cells ? 3 : 8;
  });
  std::vector<std::array<bool, 2>> on_side;
  for (const Vec3& p : mesh.points) on_side.push_back({p.x() == 0, p.z() == 0});
  jitter(mesh, 8, 0.3);
  mesh.interfaces = find_interfaces(mesh);
  for (InterfaceTriangle& t : mesh.interfaces)
    for (std::size_t side = 0; side < 2; ++side)
      if (std::all_of(t.ids.begin(), t.ids.end(), [&](Index p) { return on_side[p][side]; }))
        t.patch = static_cast<std::uint16_t>(side + 1);
  mesh.material_names = {{-9, "base"}, {8, "right"}};
  return mesh;
}

/// Cuts a mesh into parts as make_brick_part() does, but coarsens none.
/// \param part_of the part of a tet, by its number and its centroid
std::vector<BrickPart> cut(const TetMesh& whole, std::size_t parts,
                           const std::function<std::size_t(std::size_t, const Vec3&)>& part_of) {
  std::vector<std::size_t> part(whole.tets.size());
  std::vector<std::set<std::size_t>> parts_of_point(whole.points.size());
  for (std::size_t t = 0; t < whole.tets.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (const Index p : whole.tets[t]) centre += whole.points[p] / 4;
    part[t] = part_of(t, centre);
    for (const Index p : whole.tets[t]) parts_of_point[p].insert(part[t]);
  }
  std::map<Triangle, std::uint16_t> patches;
  for (const InterfaceTriangle& t : whole.interfaces)
    if (t.patch > 0) patches[ascending_ids(t.ids)] = t.patch;

  std::vector<BrickPart> cut(parts);
  for (std::size_t b = 0; b < parts; ++b) {
    TetMesh& mesh = cut[b].mesh;
    std::vector<Index> number(whole.points.size(), no_index), global;
    std::vector<std::uint8_t> shared;
    for (std::size_t t = 0; t < whole.tets.size(); ++t) {
      if (part[t] != b) continue;
      Tet tet = whole.tets[t];
      for (Index& p : tet) {
        if (number[p] == no_index) {
          number[p] = static_cast<Index>(global.size());
          global.push_back(p);
          mesh.points.push_back(whole.points[p]);
          shared.push_back(parts_of_point[p].size() > 1);
        }
        p = number[p];
      }
      mesh.tets.push_back(tet);
      mesh.materials.push_back(whole.materials[t]);
    }
    cut[b].dense = mesh_statistics(mesh);
    cut[b].dense.points -= static_cast<std::size_t>(std::count(shared.begin(), shared.end(), 1));

    cut[b].flags.assign(shared.begin(), shared.end());
    cut[b].surface.points = mesh.points;
    cut[b].surface_shared = shared;
    for (InterfaceTriangle t : find_interfaces(mesh)) {
      const auto patch = patches.find(ascending_ids({global[t.ids[0]], global[t.ids[1]], global[t.ids[2]]}));
      if (patch != patches.end()) t.patch = patch->second;
      for (const Index p : t.ids) cut[b].flags[p] |= BrickPart::on_interface;
      const bool cut_off = !t.other && t.patch == 0 &&
                           std::all_of(t.ids.begin(), t.ids.end(), [&](Index p) { return shared[p] != 0; });
      (cut_off ? cut[b].cut_faces : cut[b].surface.interfaces).push_back(t);
      if (t.patch > 0) mesh.interfaces.push_back(t);
    }
  }
  return cut;
}

using PlainTet = std::pair<MaterialTag, std::array<Corner, 4>>;
std::vector<PlainTet> plain_tets(const TetMesh& mesh) {
  std::vector<PlainTet> tets;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    PlainTet& tet = tets.emplace_back();
    tet.first = mesh.materials[t];
    for (std::size_t k = 0; k < 4; ++k) tet.second[k] = corner(mesh.points[mesh.tets[t][k]]);
    std::sort(tet.second.begin(), tet.second.end());
  }
  std::sort(tets.begin(), tets.end());
  return tets;
}

/// Faces by their coordinates, each beginning at the smallest one, with their orientation.
using PlainFace = std::tuple<std::array<Corner, 3>, MaterialTag, Tag, std::uint16_t>;
std::vector<PlainFace> plain_faces(const TetMesh& mesh) {
  std::vector<PlainFace> faces;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    std::array<Corner, 3> face;
    for (std::size_t k = 0; k < 3; ++k) face[k] = corner(mesh.points[t.ids[k]]);
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    faces.emplace_back(face, t.material, t.other, t.patch);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

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
