// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/samples/samples.h"
#include "tests/common/small_meshes.h"
#include "tetwright/resources.h"

namespace tetwright::interfaces_test {
namespace {

TetMesh sample(const char* name) { return std::get<TetMesh>(make_sample(name)); }

TEST(Interfaces, TwoTets) {
  const std::vector<InterfaceTriangle> one = find_interfaces(two_tets());
  EXPECT_EQ(one.size(), 6u);
  for (const InterfaceTriangle& t : one) EXPECT_EQ(t.pair(), (MaterialPair{1, std::nullopt}));

  // The shared face lies below the first tet and above the second.
  const std::vector<InterfaceTriangle> two = find_interfaces(two_tets(2));
  ASSERT_EQ(two.size(), 7u);
  EXPECT_EQ(two[0], (InterfaceTriangle{{0, 2, 1}, 1, 2}));
  EXPECT_EQ(two[1], (InterfaceTriangle{{0, 1, 3}, 1, std::nullopt}));
  EXPECT_EQ(two[2], (InterfaceTriangle{{0, 4, 1}, 2, std::nullopt}));
  EXPECT_EQ(find_interfaces(two_tets(-5))[0], (InterfaceTriangle{{0, 1, 2}, -5, 1}));
}

TEST(Interfaces, CountsAgreeWithTheFacesAndPairsWithTheTopology) {
  for (const char* name : {"tet_cube", "two_materials", "layers"}) {
    const TetMesh mesh = sample(name);
    const std::vector<InterfaceTriangle> triangles = find_interfaces(mesh);
    const std::vector<Triangle> expected =
        boundary_and_interfaces(mesh, mesh_faces(mesh.tets, mesh.points.size()));
    ASSERT_EQ(triangles.size(), expected.size()) << name;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      Triangle ids = triangles[i].ids;
      EXPECT_EQ(ids[0], std::min({ids[0], ids[1], ids[2]}));
      std::sort(ids.begin(), ids.end());
      EXPECT_EQ(ids, expected[i]) << name;
    }
    std::vector<MaterialPair> pairs;
    for (const auto& [pair, surface] : topology(mesh).interfaces) pairs.push_back(pair);
    if (pairs.empty()) pairs = {{1, std::nullopt}};
    EXPECT_EQ(interface_groups(triangles), pairs) << name;
  }
}

TEST(Interfaces, EachMaterialIsEnclosedByNormalsThatPointOutOfIt) {
  // Divergence theorem: a material's triangles, reversed on their other side, enclose its volume.
  const TetMesh mesh = sample("layers");
  std::map<MaterialTag, double> expected, enclosed;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    expected[mesh.materials[t]] += (mesh.points[b] - mesh.points[a])
                                       .cross(mesh.points[c] - mesh.points[a])
                                       .dot(mesh.points[d] - mesh.points[a]);
  }
  for (const InterfaceTriangle& t : find_interfaces(mesh)) {
    const auto& [a, b, c] = t.ids;
    const double volume = mesh.points[a].cross(mesh.points[b]).dot(mesh.points[c]);
    enclosed[t.material] += volume;
    if (t.other) {
      EXPECT_LT(t.material, *t.other);
      enclosed[*t.other] -= volume;
    }
  }
  ASSERT_EQ(enclosed.size(), 4u);
  for (const auto& [tag, volume] : expected) EXPECT_NEAR(enclosed.at(tag), volume, 1e-9) << tag;
}

TEST(Interfaces, CandidatesGiveTheSame) {
  const TetMesh mesh = sample("layers");
  const std::vector<InterfaceTriangle> all = find_interfaces(mesh);
  std::vector<std::uint8_t> flagged(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : all)
    for (Index v : t.ids) flagged[v] = 1;
  ASSERT_GT(std::count(flagged.begin(), flagged.end(), 0), 0);
  EXPECT_EQ(find_interfaces(mesh, &flagged), all);

  // Without the flag of a point none of its triangles are found.
  const Index point = all[0].ids[0];
  flagged[point] = 0;
  std::vector<InterfaceTriangle> fewer = all;
  std::erase_if(fewer, [&](const InterfaceTriangle& t) {
    return std::find(t.ids.begin(), t.ids.end(), point) != t.ids.end();
  });
  ASSERT_LT(fewer.size(), all.size());
  EXPECT_EQ(find_interfaces(mesh, &flagged), fewer);
}

TEST(Interfaces, TheSameForAnyThreadsAndOrderOfTets) {
  // Many separate copies: enough for several tasks.
  const TetMesh one = sample("layers");
  const std::vector<InterfaceTriangle> of_one = find_interfaces(one);
  TetMesh mesh;
  std::vector<InterfaceTriangle> expected;
  for (Index copy = 0; copy < 10; ++copy) {
    const auto first = static_cast<Index>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), one.points.begin(), one.points.end());
    mesh.materials.insert(mesh.materials.end(), one.materials.begin(), one.materials.end());
    for (const Tet& t : one.tets)
      mesh.tets.push_back({first + t[0], first + t[1], first + t[2], first + t[3]});
    for (InterfaceTriangle t : of_one) {
      for (Index& v : t.ids) v += first;
      expected.push_back(t);
    }
  }
  EXPECT_EQ(find_interfaces(mesh), expected);
  std::reverse(mesh.tets.begin(), mesh.tets.end());
  std::reverse(mesh.materials.begin(), mesh.materials.end());
  for (unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(find_interfaces(mesh), expected);
  }
}

TEST(Interfaces, AFaceOfThreeTetsHasNoSides) {
  TetMesh mesh = two_tets(2);
  mesh.points.emplace_back(1, 1, 1);
  mesh.tets.push_back({0, 1, 2, 5});
  mesh.materials.push_back(3);
  for (const InterfaceTriangle& t : find_interfaces(mesh)) EXPECT_FALSE(t.other);
  EXPECT_EQ(find_interfaces(mesh).size(), 9u);
  EXPECT_TRUE(find_interfaces({}).empty());
}

TEST(Interfaces, GroupsAndTheirNames) {
  const std::vector<InterfaceTriangle> triangles{
      {{0, 1, 2}, 2, 7}, {{0, 1, 3}, -4, 2}, {{1, 2, 3}, 2, std::nullopt}, {{1, 2, 4}, 2, 7}};
  const std::vector<MaterialPair> groups = interface_groups(triangles);
  EXPECT_EQ(groups, (std::vector<MaterialPair>{{-4, 2}, {2, std::nullopt}, {2, 7}}));
  EXPECT_EQ(pair_name(groups[0]), "-4|2");
  EXPECT_EQ(pair_name(groups[1], {{2, "bone"}}), "bone|outside");
  EXPECT_EQ(pair_name(groups[2], {{2, "bone"}}), "bone|7");
}

}  // namespace
}  // namespace tetwright::interfaces_test
