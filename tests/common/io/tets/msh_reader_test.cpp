// SPDX-License-Identifier: Apache-2.0

// Tests of version 4.1 of the format; version 2 is in msh_test.cpp.
#include "common/io/tets/msh.h"
#include "tests/common/io/expect_error.h"

namespace tetwright::msh_reader_test {
namespace {

const std::string head = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const std::string names = "$PhysicalNames\n2\n2 7 \"skin\"\n3 7 \"my bone\"\n$EndPhysicalNames\n";
// A point, a curve, a surface and two volumes, the first of which is in two groups.
const std::string entities =
    "$Entities\n1 1 1 2\n1 0 0 0 0\n1 0 0 0 1 1 1 0 2 1 -1\n1 0 0 0 1 1 1 1 7 1 1\n"
    "3 0 0 0 1 1 1 2 7 8 1 1\n4 0 0 0 1 1 1 0 1 1\n$EndEntities\n";
// The numbers are neither dense nor sorted, and some nodes have parameters.
const std::string nodes =
    "$Nodes\n3 5 3 40\n0 1 0 1\n10\n0 0 0\n2 1 1 2\n20\n7\n1 0 0 0.5 0.25\n0 1 0 0.5 nan\n3 3 0 2\n40\n3\n"
    "0 0 1\n1 1 1\n$EndNodes\n";
const std::string elements =
    "$Elements\n4 5 1 9\n0 1 15 1\n1 10\n2 1 2 2\n2 10 20 7\n9 10 20 40\n3 3 4 1\n5 10 20 7 40\n3 4 4 1\n"
    "6 20 7 40 3\n$EndElements\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(MshReader, Version41) {
  const ReadTetMesh r = read_msh(head + names + entities + nodes + elements, "f");
  EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(r.mesh.points[2], Vec3(0, 1, 0));
  EXPECT_EQ(r.mesh.points[4], Vec3(1, 1, 1));
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{7, 0}));
  EXPECT_EQ(r.mesh.material_names, (std::map<MaterialTag, std::string>{{7, "my bone"}}));
  EXPECT_EQ(r.material_field, "gmsh:physical");
  EXPECT_TRUE(r.mesh.cell_fields.empty());
  EXPECT_EQ(r.mesh.patch_groups,
            (std::map<InterfacePatch, SurfaceRegion>{{{{7, std::nullopt}, 1}, {7, "skin"}}}));
  EXPECT_EQ(r.dropped, (std::vector<Dropped>{{"point elements", 1},
                                             {"further physical groups of entities (\"8\")", 1}}));
}

TEST(MshReader, SurfacesWithSeveralAndTurnedGroups) {
  const std::string text =
      head + "$PhysicalNames\n2\n2 7 \"skin\"\n2 9 \"extra\"\n$EndPhysicalNames\n" +
      "$Entities\n0 0 2 0\n1 0 0 0 1 1 1 2 -7 9 0\n-2 0 0 0 1 1 1 1 7 0\n$EndEntities\n" + nodes +
      "$Elements\n3 3 1 9\n2 1 2 1\n2 10 20 7\n2 2 2 1\n9 10 20 40\n2 5 3 1\n" +
      "3 10 20 7 40\n$EndElements\n";
  std::vector<Dropped> dropped;
  const TriangleMesh mesh = read_msh_surface(text, "f", &dropped);
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{7, "skin"}, {}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 0, 1, 1}));
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"further physical groups of entities (\"extra\")", 1}}));
}

TEST(MshReader, WithoutPhysicalGroupsTheVolumeIsTheMaterial) {
  for (const std::string& e : {std::string(), replaced(entities, "2 7 8 1 1", "0 1 1")}) {
    const ReadTetMesh r = read_msh(head + names + e + nodes + elements, "f");
    EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{3, 4}));
    EXPECT_EQ(r.material_field, "gmsh:geometrical");
    EXPECT_TRUE(r.mesh.material_names.empty());
  }
  const ReadTetMesh asked =
      read_msh(head + entities + nodes + elements, "f", {.material_field = "gmsh:geometrical"});
  EXPECT_EQ(asked.mesh.materials, (std::vector<MaterialTag>{3, 4}));
}

TEST(MshReader, DataAndUnknownSections) {
  const std::string data =
      "$Surface\n2\n1 2 3\n$EndSurface\n$NodeData\n1\n\"t\"\n1\n0\n3\n0\n1\n5\n3 5\n7 3\n10 1\n20 2\n40 4\n"
      "$EndNodeData\n$ElementData\n1\n\"e\"\n1\n0\n3\n0\n1\n2\n6 66\n5 55\n$EndElementData\n";
  const TetMesh mesh = read_msh(head + nodes + elements + data, "f").mesh;
  EXPECT_EQ(mesh.point_fields, (std::vector<MeshField>{{"t", 1, false, {1, 2, 3, 4, 5}}}));
  EXPECT_EQ(mesh.cell_fields, (std::vector<MeshField>{{"e", 1, false, {55, 66}}}));
}

TEST(MshReader, BadInput) {
  const std::string whole = head + entities + nodes + elements;
  expect_input_error(read_msh, replaced(whole, "4.1 0 8", "4.1 1 8"), "four-byte number 1", "damaged");
  expect_input_error(read_msh, replaced(whole, "4.1 0 8", "3.0 0 8"), "\"3.0\"", "4.0 or 4.1");
  expect_input_error(read_msh, head + "$PartitionedEntities\n1\n$EndPartitionedEntities\n", "line 4",
                     "partitioned");
  expect_input_error(read_msh, replaced(whole, "1 1 1 2\n", "4000000000 1 1 2\n"), "line 5", "4000000000");
  expect_input_error(read_msh, replaced(whole, "$Nodes\n3 5", "$Nodes\n3 4000000000"), "4000000000");
  expect_input_error(read_msh, replaced(whole, "$Nodes\n3 5", "$Nodes\n3 4"), "more nodes than the 4");
  expect_input_error(read_msh, replaced(whole, "$Nodes\n3 5", "$Nodes\n3 6"), "5 nodes, but 6");
  expect_input_error(read_msh, replaced(whole, "2 1 1 2\n", "2 1 7 2\n"), "parametric", "7");
  expect_input_error(read_msh, replaced(whole, "2 1 1 2\n", "4 1 1 2\n"), "dimension 4");
  expect_input_error(read_msh, replaced(whole, "20\n7\n", "20\n10\n"), "node 10", "twice");
  expect_input_error(read_msh, replaced(whole, "1 1 1\n$EndNodes", "1 inf 1\n$EndNodes"), "line 26",
                     "not finite");
  expect_input_error(read_msh, replaced(whole, "4 5 1 9", "4 4 1 9"), "more elements than the 4");
  expect_input_error(read_msh, replaced(whole, "4 5 1 9", "4 6 1 9"), "5 elements, but 6");
  expect_input_error(read_msh, replaced(whole, "6 20 7 40 3", "6 20 7 40 4"), "line 38", "node 4");
  expect_input_error(read_msh, replaced(whole, "3 4 4 1\n6 20 7 40 3", "3 4 7 1\n6 20 7 40 3 10"), "line 38",
                     "1 pyramids, the first of them element 6");
  expect_input_error(read_msh, replaced(whole, "3 3 4 1", "3 3 99 1"), "type 99");
  expect_input_error(read_msh, replaced(replaced(whole, "2 7 8 1 1", "0 1 1"), "3 4 4 1", "3 3000000000 4 1"),
                     "line 38", "32 bits");
  for (std::size_t n = 0; n + 1 < whole.size(); ++n)
    (void)error_of<InputError>([&] { (void)read_msh(whole.substr(0, n), "f"); });
}

}  // namespace
}  // namespace tetwright::msh_reader_test
