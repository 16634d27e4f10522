#include "common/formats/msh.h"

#include "common/interfaces.h"
#include "tests/common/formats/expect_error.h"
#include "tests/common/formats/tricky_meshes.h"
#include "tests/common/small_meshes.h"

namespace tetwright {
namespace {

const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string nodes = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n";
std::string elements(const std::string& lines, const std::string& count = "1") {
  return "$Elements\n" + count + "\n" + lines + "$EndElements\n";
}

TEST(Msh, RoundTripKeepsEveryBitAndTheNames) {
  const TetMesh mesh = tricky_tets();
  const ReadTetMesh back = read_msh(write_msh(mesh), "f");
  EXPECT_TRUE(same_bits(back.mesh.points, mesh.points));
  EXPECT_EQ(back.mesh.tets, mesh.tets);
  EXPECT_EQ(back.mesh.materials, mesh.materials);
  EXPECT_EQ(back.mesh.material_names, mesh.material_names);
  EXPECT_EQ(back.material_field, "gmsh:physical");
}

TEST(Msh, InterfaceTrianglesFollowTheTets) {
  TetMesh mesh = two_tets(-7);
  mesh.material_names = {{1, "bone"}};
  const std::string without = write_msh(mesh);
  EXPECT_NE(without.find("$PhysicalNames\n1\n3 1 \"bone\"\n"), std::string::npos) << without;
  mesh.interfaces = find_interfaces(mesh);
  const std::string text = write_msh(mesh);
  EXPECT_NE(
      text.find(
          "$PhysicalNames\n4\n2 1 \"-7|outside\"\n2 2 \"-7|bone\"\n2 3 \"bone|outside\"\n3 1 \"bone\"\n"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("$Elements\n9\n1 4 2 1 2 1 2 3 4\n2 4 2 -7 1 1 3 2 5\n3 2 2 2 2 1 2 3\n"),
            std::string::npos)
      << text;
  const ReadTetMesh back = read_msh(text, "f");
  EXPECT_EQ(back.mesh.tets, mesh.tets);
  EXPECT_EQ(back.mesh.materials, mesh.materials);
  EXPECT_EQ(back.mesh.material_names, mesh.material_names);
  EXPECT_EQ(back.material_field, "gmsh:physical");
  EXPECT_TRUE(back.mesh.interfaces.empty());
  EXPECT_EQ(write_msh(back.mesh), without);
}

TEST(Msh, WhatGmshWrites) {
  const ReadTetMesh r = read_msh(
      head +
          "$PhysicalNames\n2\n2 7 \"skin\"\n3 7 \"my bone\"\n$EndPhysicalNames\n"
          "$Nodes\n5\n10 0 0 0\n20 1 0 0\n7 0 1 0\n40 0 0 1\n3 1 1 1\n$EndNodes\n" +
          elements("1 15 2 0 1 10\n2 2 2 7 1 10 20 7\n5 4 2 7 1 10 20 7 40\n6 4 4 8 2 1 3 20 7 40 3\n", "4") +
          "$NodeData\n1\n\"a\"\n$EndNodeData\n",
      "f");
  EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{7, 8}));
  EXPECT_EQ(r.mesh.material_names, (std::map<MaterialTag, std::string>{{7, "my bone"}}));
}

TEST(Msh, WithoutTagsThereIsOneMaterial) {
  const ReadTetMesh r = read_msh(head + nodes + elements("1 4 0 1 2 3 4\n"), "f");
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{1}));
  EXPECT_EQ(r.material_field, "");
}

TEST(Msh, QuotesInNamesDoNotBreakTheFile) {
  TetMesh mesh = tricky_tets();
  mesh.material_names = {{0, "a\"b\nc"}};
  EXPECT_EQ(read_msh(write_msh(mesh), "f").mesh.material_names.at(0), "a_b_c");
}

TEST(Msh, BadInput) {
  const std::string tet = "1 4 2 1 1 1 2 3 4\n";
  expect_input_error(read_msh, "", "empty");
  expect_input_error(read_msh, "hello", "\"hello\"");
  expect_input_error(read_msh, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "\"4.1\"", "msh22");
  expect_input_error(read_msh, "$MeshFormat\n2.2 1 8\n", "binary", "ASCII");
  expect_input_error(read_msh, head + nodes, "$Elements", "cut short");
  expect_input_error(read_msh, head + nodes + elements("1 2 2 1 1 1 2 3\n"), "no tets");
  expect_input_error(read_msh, head + "$Nodes\n4000000000\n1 0 0 0\n", "line 5", "4000000000");
  expect_input_error(read_msh, head + nodes + elements(tet, "4000000000"), "4000000000");
  expect_input_error(read_msh, head + nodes + elements("1 4 9000000000000000000 1 1 1 2 3 4\n"), "tag");
  expect_input_error(read_msh, head + nodes + elements("1 4 2 1 1 1 2 3 5\n"), "line 13", "node 5");
  expect_input_error(read_msh, head + nodes + elements("1 4 2 3000000000 1 1 2 3 4\n"), "line 13", "32 bits");
  expect_input_error(read_msh, head + nodes + elements("1 4 2 1 1 1 2 3 x\n"), "line 13", "\"x\"");
  expect_input_error(read_msh, head + "$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n", "node 1", "twice");
  expect_input_error(read_msh, head + "$Nodes\n1\n1 0 inf 0\n$EndNodes\n", "line 6", "not finite");
  expect_input_error(read_msh, head + elements(tet), "before the nodes");
  const std::string whole = head + nodes + "$Elements\n1\n" + tet + "$EndElements";
  for (std::size_t n = 0; n < whole.size(); ++n)
    (void)error_of<InputError>([&] { (void)read_msh(whole.substr(0, n), "f"); });
}

}  // namespace
}  // namespace tetwright
