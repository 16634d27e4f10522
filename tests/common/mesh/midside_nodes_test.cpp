// SPDX-License-Identifier: Apache-2.0
#include "tetwright/tet_mesh.h"

#include <gtest/gtest.h>

#include "tests/common/small_meshes.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::midside_nodes_test {
namespace {

TEST(MidsideNodes, OneForEachEdgeHalfwayBetweenItsEnds) {
  TetMesh mesh = two_tets(2);
  mesh.interfaces = find_interfaces(mesh);
  const MidsideNodes nodes = straight_midside_nodes(mesh);
  EXPECT_EQ(nodes.edges.size(), 9u);  // six edges of each tet, three of which are shared
  EXPECT_EQ(nodes.points.size(), 9u);
  const auto expect_between = [&](Index node, Index a, Index b) {
    EXPECT_EQ(nodes.points[node], Vec3(0.5 * (mesh.points[a] + mesh.points[b])));
  };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e)
      expect_between(nodes.of_tets[t][e], mesh.tets[t][tet_midside_edges[e][0]],
                     mesh.tets[t][tet_midside_edges[e][1]]);
  ASSERT_EQ(nodes.of_faces.size(), mesh.interfaces.size());
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      expect_between(nodes.of_faces[i][k], mesh.interfaces[i].ids[k], mesh.interfaces[i].ids[(k + 1) % 3]);
}

TEST(MidsideNodes, FieldsAreMeansOfBothEnds) {
  TetMesh mesh = one_tet();
  mesh.point_fields = {{"t", 1, false, {0, 1, 2, 4}}, {"v", 2, true, {0, 0, 1, 3, 2, 6, 3, 9}}};
  const MidsideNodes nodes = straight_midside_nodes(mesh);
  const std::vector<MeshField> fields = fields_of_nodes(mesh.point_fields, nodes);
  // Edges 01 02 03 12 13 23.
  EXPECT_EQ(fields[0].values, (std::vector<double>{0, 1, 2, 4, 0.5, 1, 2, 1.5, 2.5, 3}));
  EXPECT_EQ(fields[1].values,
            (std::vector<double>{0, 0, 1, 3, 2, 6, 3, 9, 1, 2, 1, 3, 2, 5, 2, 5, 2, 6, 3, 8}));
}

}  // namespace
}  // namespace tetwright::midside_nodes_test
