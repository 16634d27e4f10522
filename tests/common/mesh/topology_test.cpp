// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <gtest/gtest.h>

#include "common/samples/samples.h"
#include "tests/common/small_meshes.h"

namespace tetwright::topology_test {
namespace {

TetMesh sample(const char* name) { return std::get<TetMesh>(make_sample(name)); }

/// The sample of 4 x 4 x 4 cubes with six tets each, reduced to 3 x 3 x 3 and without some of its cells.
TetMesh box_without(const std::vector<int>& cells) {
  TetMesh box = sample("tet_cube");  // 4 x 4 x 4
  TetMesh out{box.points, {}, {}, {}};
  for (std::size_t t = 0; t < box.tets.size(); ++t) {
    const int cell = static_cast<int>(t / 6), x = cell % 4, y = cell / 4 % 4, z = cell / 16;
    if (x == 3 || y == 3 || z == 3) continue;
    if (std::find(cells.begin(), cells.end(), x + 3 * y + 9 * z) == cells.end()) {
      out.tets.push_back(box.tets[t]);
      out.materials.push_back(1);
    }
  }
  return out;
}

TEST(Topology, ABallACavityAndAHandle) {
  EXPECT_EQ(topology(box_without({})).domain, (Topology::Solid{1, 1, 1, 2}));
  EXPECT_EQ(topology(box_without({13})).domain, (Topology::Solid{1, 2, 2, 4}));
  EXPECT_EQ(topology(box_without({4, 13, 22})).domain, (Topology::Solid{1, 0, 1, 0}));
}

TEST(Topology, ComponentsAreChainedByFaces) {
  EXPECT_EQ(topology(two_tets()).domain.components, 1);
  EXPECT_EQ(topology(edge_bridge()).domain.components, 2);
  EXPECT_EQ(topology(point_bridge()).domain.components, 2);
}

TEST(Topology, OneMaterialSaysNothingMore) {
  const Topology t = topology(sample("tet_cube"));
  EXPECT_TRUE(t.materials.empty());
  EXPECT_TRUE(t.interfaces.empty());
  EXPECT_FALSE(t.touching_fans);
  EXPECT_FALSE(t.junction_curves);
}

TEST(Topology, TwoHalvesOfABox) {
  const Topology t = topology(sample("two_materials"));
  EXPECT_EQ(t.domain, (Topology::Solid{1, 1, 1, 2}));
  EXPECT_EQ(t.materials.at(1), (Topology::Solid{1, 1, 1, 2}));
  EXPECT_EQ(t.interfaces.at({1, 2}), (Topology::Surface{1, 1}));
  EXPECT_EQ(t.interfaces.at({1, std::nullopt}), (Topology::Surface{1, 1}));
  EXPECT_EQ(t.touching_fans, 0);
  EXPECT_EQ(t.junction_curves, (Topology::Curves{1, 0, 0}));
}

TEST(Topology, LayersAndTheirLines) {
  const Topology t = topology(sample("layers"));
  EXPECT_EQ(t.interfaces.size(), 7u);
  EXPECT_EQ(t.junction_curves, (Topology::Curves{3, 0, 0}));
  const std::vector<std::string> lines = topology_lines(t);
  EXPECT_EQ(lines[0], "domain: components 1, euler 1, boundary components 1, boundary euler 2");
  EXPECT_NE(std::find(lines.begin(), lines.end(), "interface 2|3: components 1, euler 1"), lines.end());
  EXPECT_NE(std::find(lines.begin(), lines.end(), "junction curves: components 3, euler 0, branch points 0"),
            lines.end());
}

TEST(Topology, DifferencesAreNamed) {
  const TetMesh mesh = sample("two_materials");
  TetMesh other = mesh;
  EXPECT_TRUE(topology_differences(topology(mesh), topology(other)).empty());
  other.materials[0] = 2;
  EXPECT_FALSE(topology(mesh) == topology(other));
  const auto lines = topology_differences(topology(mesh), topology(other));
  EXPECT_NE(std::find(lines.begin(), lines.end(),
                      "interface 1|2: before components 1, euler 1; after components 2, euler 2"),
            lines.end());
  other = mesh;
  std::fill(other.materials.begin(), other.materials.end(), 1);
  const auto missing = topology_differences(topology(mesh), topology(other));
  EXPECT_NE(
      std::find(missing.begin(), missing.end(), "interface 1|2: before components 1, euler 1; after missing"),
      missing.end());
}

TEST(Topology, DoesNotDependOnNumbering) {
  const TetMesh mesh = sample("layers");
  TetMesh turned = mesh;
  const auto n = static_cast<Index>(mesh.points.size());
  for (Index i = 0; i < n; ++i) turned.points[n - 1 - i] = mesh.points[i];
  std::reverse(turned.tets.begin(), turned.tets.end());
  std::reverse(turned.materials.begin(), turned.materials.end());
  for (Tet& tet : turned.tets)
    for (Index& v : tet) v = n - 1 - v;
  EXPECT_EQ(topology(mesh), topology(turned));
}

}  // namespace
}  // namespace tetwright::topology_test
