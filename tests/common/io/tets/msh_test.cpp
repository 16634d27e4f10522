// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/msh.h"

#include <algorithm>
#include <limits>
#include <set>

#include "tests/common/io/expect_error.h"
#include "tests/common/io/same_values.h"
#include "tests/common/io/tricky_meshes.h"
#include "tests/common/small_meshes.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::msh_test {
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
  EXPECT_EQ(back.dropped, (std::vector<Dropped>{{"boundary and interface triangles of 3 groups", 7, true}}));
}

TEST(Msh, GroupsOfFacesComeBackWithTheirNamesAndNumbers) {
  TetMesh mesh = two_tets(-7);
  mesh.material_names = {{1, "bone"}};
  mesh.interfaces = find_interfaces(mesh);
  const MaterialPair outer{1, std::nullopt};
  for (InterfaceTriangle& t : mesh.interfaces)
    if (t.pair() == outer) t.patch = 5;
  std::find_if(mesh.interfaces.begin(), mesh.interfaces.end(), [&](const InterfaceTriangle& t) {
    return t.pair() == outer;
  })->patch = 6;
  mesh.patch_groups = {{{outer, 5}, {12, "inlet"}}, {{outer, 6}, {0, "outlet"}}};
  const std::string text = write_msh(mesh);
  EXPECT_NE(text.find("$PhysicalNames\n5\n2 1 \"-7|outside\"\n2 2 \"-7|bone\"\n2 3 \"outlet\"\n"
                      "2 12 \"inlet\"\n3 1 \"bone\"\n"),
            std::string::npos)
      << text;
  const ReadTetMesh back = read_msh(text, "f");
  EXPECT_EQ(back.dropped, (std::vector<Dropped>{{"boundary and interface triangles of 2 groups", 4, true}}));
  EXPECT_EQ(back.mesh.interfaces.size(), mesh.interfaces.size());
  std::set<SurfaceRegion> of_user;
  for (const auto& [patch, group] : back.mesh.patch_groups) of_user.insert(group);
  EXPECT_EQ(of_user, (std::set<SurfaceRegion>{{12, "inlet"}, {3, "outlet"}}));
  EXPECT_EQ(write_msh(back.mesh), text);
  std::string twice = text;
  twice.replace(twice.find("outlet"), 6, "inlet");
  expect_input_error(read_msh, twice, "line 9", "both called \"inlet\"");
  // The points of the last triangle do not belong to a common tet.
  std::string other = text;
  other.replace(other.find("$EndElements"), 0, "10 2 2 12 12 1 4 5\n");
  other.replace(other.find("$Elements\n9"), 11, "$Elements\n10");
  expect_input_error(read_msh, other, "\"inlet\"", "not a face of any tet");
}

TEST(Msh, NoTwoGroupsOfFacesHaveOneName) {
  TetMesh mesh = two_tets(2);
  mesh.interfaces = find_interfaces(mesh);
  const MaterialPair first{1, std::nullopt}, second{2, std::nullopt};
  for (InterfaceTriangle& t : mesh.interfaces)
    if (t.ids == Triangle{0, 1, 3} || t.ids == Triangle{0, 4, 1}) t.patch = 1;
  // Names that equal the pair's, the pair's with a suffix, and each other once written.
  mesh.patch_groups = {{{first, 1}, {7, "1|outside"}}, {{second, 1}, {8, "1|outside_2"}}};
  const std::string text = write_msh(mesh);
  EXPECT_NE(text.find("2 7 \"1|outside\"\n2 8 \"1|outside_2\"\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\"1|outside_3\"\n"), std::string::npos) << text;
  EXPECT_EQ(write_msh(read_msh(text, "f").mesh), text);
  EXPECT_EQ(read_msh(text, "f").mesh.patch_groups.size(), 2u);
  // A name that equals the pair's with a suffix.
  mesh.patch_groups = {{{first, 1}, {7, "1|outside_2"}}};
  const ReadTetMesh suffix = read_msh(write_msh(mesh), "f");
  EXPECT_EQ(suffix.mesh.patch_groups, mesh.patch_groups);
  EXPECT_EQ(write_msh(suffix.mesh), write_msh(mesh));
  mesh.patch_groups = {{{first, 1}, {7, "a\"b"}}, {{second, 1}, {8, "a_b"}}};
  EXPECT_NE(write_msh(mesh).find("2 7 \"a_b_2\"\n2 8 \"a_b\"\n"), std::string::npos);
  mesh.patch_groups = {{{first, 1}, {7, "same"}}, {{second, 1}, {8, "same"}}};
  EXPECT_NO_THROW(read_msh(write_msh(mesh), "f"));
  // Materials with equal names give pairs with equal names.
  mesh.patch_groups = {};
  mesh.material_names = {{1, "bone"}, {2, "bone"}};
  EXPECT_NO_THROW(read_msh(write_msh(mesh), "f"));
}

TEST(Msh, TrianglesThatAreListedWithoutTheirGroupToo) {
  TetMesh mesh = one_tet();
  mesh.interfaces = find_interfaces(mesh);
  mesh.interfaces[0].patch = 1;
  mesh.patch_groups = {{{{1, std::nullopt}, 1}, {12, "inlet"}}};
  const std::string text = write_msh(mesh);
  std::string other = text;
  other.replace(other.find("$Elements\n5\n"), 12, "$Elements\n6\n0 2 2 0 1 1 2 3\n");
  const ReadTetMesh back = read_msh(other, "f");
  EXPECT_EQ(back.mesh.patch_groups, mesh.patch_groups);
  EXPECT_EQ(write_msh(back.mesh), text);
  EXPECT_EQ(back.dropped, (std::vector<Dropped>{{"boundary and interface triangles of 1 group", 4, true}}));
}

TEST(Msh, NumbersThatCannotBeKeptAreNames) {
  TetMesh mesh = one_tet();
  mesh.interfaces = find_interfaces(mesh);
  mesh.interfaces[0].patch = 1;
  mesh.interfaces[1].patch = 2;
  const MaterialPair pair{1, std::nullopt};
  mesh.patch_groups = {{{pair, 1}, {-5, ""}}, {{pair, 2}, {1LL << 40, ""}}};
  const std::string text = write_msh(mesh);
  EXPECT_NE(text.find("2 1 \"1|outside\"\n2 2 \"-5\"\n2 3 \"1099511627776\"\n"), std::string::npos) << text;
  EXPECT_EQ(write_msh(read_msh(text, "f").mesh), text);
}

TEST(Msh, SurfacesWithGroups) {
  const std::string text = head + "$PhysicalNames\n1\n2 7 \"skin\"\n$EndPhysicalNames\n" + nodes +
                           elements("1 15 2 0 1 1\n2 2 2 7 1 1 2 3\n3 2 2 9 1 1 2 4\n4 2 2 7 1 2 3 4\n", "4");
  std::vector<Dropped> dropped;
  const TriangleMesh mesh = read_msh_surface(text, "f", &dropped);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}}));
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{7, "skin"}, {9, ""}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 1, 0}));
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"point elements", 1}}));
  expect_input_error(read_msh_surface, write_msh(two_tets(2)), "2 tets", "tetwright simplify");
  expect_input_error(read_msh_surface, head + nodes + elements("1 15 2 0 1 1\n", "1"), "no triangles");
}

TEST(Msh, QuadsAndTurnedFacesOfSurfaces) {
  const TriangleMesh mesh =
      read_msh_surface(head + "$PhysicalNames\n1\n2 7 \"skin\"\n$EndPhysicalNames\n" + nodes +
                           elements("1 3 2 7 1 1 2 3 4\n2 2 2 -7 1 1 2 3\n3 2 2 -9 1 1 2 3\n", "3"),
                       "f");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 1, 2}}));
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{7, "skin"}, {9, ""}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 0, 0, 1}));
  expect_input_error(read_msh_surface, head + nodes + elements("8 3 2 7 1 1 2 3 5\n"), "line 13",
                     "element 8 refers to node 5");
  expect_input_error(read_msh_surface, head + nodes + elements("8 2 2 -9223372036854775808 1 1 2 9\n"),
                     "element 8 refers to node 9");
}

TEST(Msh, WhatGmshWrites) {
  const ReadTetMesh r = read_msh(
      head +
          "$PhysicalNames\n2\n2 7 \"skin\"\n3 7 \"my bone\"\n$EndPhysicalNames\n"
          "$Nodes\n5\n10 0 0 0\n20 1 0 0\n7 0 1 0\n40 0 0 1\n3 1 1 1\n$EndNodes\n" +
          elements("1 15 2 0 1 10\n2 2 2 7 1 10 20 7\n5 4 2 7 1 10 20 7 40\n6 4 4 8 2 1 3 20 7 40 3\n", "4") +
          "$ElementNodeData\n1\n\"a\"\n$EndElementNodeData\n",
      "f");
  EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{7, 8}));
  EXPECT_EQ(r.mesh.material_names, (std::map<MaterialTag, std::string>{{7, "my bone"}}));
  EXPECT_EQ(r.mesh.patch_groups,
            (std::map<InterfacePatch, SurfaceRegion>{{{{7, std::nullopt}, 1}, {7, "skin"}}}));
  EXPECT_EQ(r.dropped, (std::vector<Dropped>{{"point elements", 1},
                                             {"tets with partition numbers", 1},
                                             {"sections (\"$ElementNodeData\")", 1}}));
}

TEST(Msh, OtherVolumeElementsAreRefusedByKindAndNumber) {
  expect_input_error(
      read_msh,
      head + nodes +
          elements("1 4 2 1 1 1 2 3 4\n2 5 2 1 1 1 2 3 4 1 2 3 4\n3 6 0 1 2 3 4 1 2\n4 5 0 1 2 3 4 1 2 3 4\n",
                   "4"),
      "line 14: 2 hexahedra and 1 prisms, the first of them element 2", "convert them to tets");
}

TEST(Msh, WhatIsDroppedIsNamed) {
  const ReadTetMesh r = read_msh(
      head + "$PhysicalNames\n3\n1 3 \"edge\"\n2 4 \"hole\"\n0 5 \"corner\"\n$EndPhysicalNames\n" + nodes +
          elements(
              "1 4 2 5 6 1 2 3 4\n2 4 2 5 7 1 2 3 4\n3 1 2 3 1 1 2\n4 3 2 4 1 1 2 3 4\n5 3 2 8 1 1 2 3 4\n",
              "5"),
      "f");
  EXPECT_EQ(r.dropped, (std::vector<Dropped>{
                           {"lines of physical groups (\"edge\")", 1},
                           {"quads of physical groups (\"hole\", \"8\")", 2},
                           {"physical groups of points, lines or faces, without elements (\"corner\")", 1},
                           {"numbers of volumes within the physical groups; --material-field "
                            "gmsh:geometrical uses them as materials",
                            2}}));
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
  mesh.material_names = {{0, "K\xf6rper"}};
  EXPECT_EQ(read_msh(write_msh(mesh), "f").mesh.material_names.at(0), "K\xef\xbf\xbdrper");
  // Names that differ stay different; equal ones stay equal.
  mesh.material_names = {{0, "a\"b"}, {1, "a_b"}, {2, "a\\b"}, {3, "a_b"}};
  EXPECT_EQ(read_msh(write_msh(mesh), "f").mesh.material_names,
            (std::map<MaterialTag, std::string>{{0, "a_b_2"}, {1, "a_b"}, {2, "a_b_3"}, {3, "a_b"}}));
}

TEST(Msh, FieldsComeBack) {
  TetMesh mesh = two_tets(2);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  mesh.point_fields = {{"speed", 3, false, {0.1, -0.0, 1e300, 1, 2, 3, 4, 5, 6, 7, 8, 9, nan, -nan, 1.0 / 3}},
                       {"two", 2, false, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}}};
  mesh.cell_fields = {{"a \"b\"", 1, true, {7, -8}}, {"ten", 10, false, std::vector<double>(20, 0.5)}};
  const std::string text = write_msh(mesh);
  EXPECT_EQ(text.find("-nan"), std::string::npos);
  const TetMesh back = read_msh(text, "f").mesh;
  ASSERT_EQ(back.point_fields.size(), 2u);
  EXPECT_EQ(back.point_fields[0].name, "speed");
  EXPECT_EQ(back.point_fields[0].components, 3);
  expect_same_values(back.point_fields[0].values, mesh.point_fields[0].values);
  // Padded to three components.
  EXPECT_EQ(back.point_fields[1].components, 3);
  EXPECT_EQ(back.point_fields[1].values, (std::vector<double>{1, 2, 0, 3, 4, 0, 5, 6, 0, 7, 8, 0, 9, 10, 0}));
  ASSERT_EQ(back.cell_fields.size(), 11u);
  EXPECT_EQ(back.cell_fields[0], (MeshField{"a _b_", 1, false, {7, -8}}));
  EXPECT_EQ(back.cell_fields[10], (MeshField{"ten_9", 1, false, {0.5, 0.5}}));
  EXPECT_EQ(back.materials, mesh.materials);
  // A file that was read is written unchanged.
  EXPECT_EQ(write_msh(read_msh(write_msh(back), "f").mesh), write_msh(back));
}

TEST(Msh, DataOfSomeNodesAndOfOtherElements) {
  const std::string mesh = head + nodes + elements("3 2 2 7 1 1 2 3\n9 4 2 5 1 1 2 3 4\n", "2");
  const TetMesh r = read_msh(
                        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$NodeData\n2\n\"p\"\n\"scheme\"\n1\n0.5\n"
                        "4\n0\n1\n1\n0\n3 2.5\n$EndNodeData\n" +
                            mesh.substr(head.size()) +
                            "$ElementData\n1\n\"e\"\n1\n0\n3\n0\n1\n2\n3 1\n9 4\n$EndElementData\n"
                            "$ElementData\n1\n\"faces\"\n1\n0\n3\n0\n1\n1\n3 1\n$EndElementData\n",
                        "f")
                        .mesh;
  ASSERT_EQ(r.point_fields.size(), 1u);
  EXPECT_EQ(r.point_fields[0].name, "p");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_same_values(r.point_fields[0].values, {nan, nan, 2.5, nan});
  EXPECT_EQ(r.cell_fields, (std::vector<MeshField>{{"e", 1, false, {4}}}));
  const std::vector<Dropped> dropped = read_msh(mesh +
                                                    "$ElementData\n1\n\"faces\"\n1\n0\n3\n0\n1\n1\n3 1\n"
                                                    "$EndElementData\n",
                                                "f")
                                           .dropped;
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"fields of elements other than tets (\"faces\")", 1}}));
}

TEST(Msh, WhatIsTakenForTheMaterial) {
  const std::string text = head + nodes + elements("1 4 2 5 6 1 2 3 4\n") +
                           "$ElementData\n1\n\"material\"\n1\n0\n3\n0\n1\n1\n1 9\n$EndElementData\n";
  // The physical group takes precedence over a field named "material".
  ReadTetMesh r = read_msh(text, "f");
  EXPECT_EQ(r.material_field, "gmsh:physical");
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{5}));
  EXPECT_EQ(r.mesh.cell_fields.size(), 1u);
  r = read_msh(text, "f", {.material_field = "material"});
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{9}));
  EXPECT_EQ(r.mesh.cell_fields, (std::vector<MeshField>{{"gmsh:physical", 1, true, {5}}}));
  r = read_msh(text, "f", {.material_field = "gmsh:geometrical"});
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{6}));
  EXPECT_EQ(r.material_field, "gmsh:geometrical");
  const std::string said =
      error_of<InputError>([&] { (void)read_msh(text, "f", {.material_field = "zone"}); });
  EXPECT_NE(said.find("\"zone\""), std::string::npos) << said;
  EXPECT_NE(said.find("there is \"gmsh:physical\", \"gmsh:geometrical\", \"material\""), std::string::npos)
      << said;
}

TEST(Msh, BadData) {
  const std::string mesh = head + nodes + elements("1 4 2 5 6 1 2 3 4\n");
  const auto data = [&](const std::string& tags, const std::string& rows) {
    return mesh + "$NodeData\n1\n\"p\"\n1\n0\n" + tags + rows + "$EndNodeData\n";
  };
  expect_input_error(read_msh, data("3\n0\n1\n1\n", "5 0\n"), "line 24", "node 5");
  expect_input_error(read_msh, data("3\n0\n1\n1\n", "1 x\n"), "line 24", "\"x\"");
  expect_input_error(read_msh, data("3\n0\n1\n2\n", "1 0\n"), "line 25", "\"$EndNodeData\"");
  expect_input_error(read_msh, data("3\n0\n10\n1\n", "1 0\n"), "line 22", "10 components");
  expect_input_error(read_msh, data("3\n0\n1\n4000000000\n", "1 0\n"), "line 23", "4000000000");
  expect_input_error(read_msh, data("2\n0\n1\n", "1 0\n"), "line 20", "2 integer tags");
  expect_input_error(read_msh, mesh + "$NodeData\n1\np\n", "\"$EndNodeData\"", "truncated");
  expect_input_error(read_msh, mesh + "$NodeData\n1\np\n$EndNodeData\n", "line 17", "in quotes");
  expect_input_error(read_msh,
                     head + nodes + elements("1 4 2 5 6 1 2 3 4\n1 4 2 5 6 1 2 3 4\n", "2") +
                         "$ElementData\n1\n\"e\"\n1\n0\n3\n0\n1\n1\n1 4\n$EndElementData\n",
                     "element 1", "twice");
  // Many short sections must not use unlimited memory.
  std::string many = head + "$Nodes\n100\n";
  for (int i = 1; i <= 100; ++i) many += std::to_string(i) + " 0 0 0\n";
  many += "$EndNodes\n" + elements("1 4 0 1 2 3 4\n");
  for (int i = 0; i < 200; ++i)
    many += "$NodeData\n1\n\"p\"\n1\n0\n3\n0\n9\n1\n1 0 0 0 0 0 0 0 0 0\n$EndNodeData\n";
  expect_input_error(read_msh, many, "mostly empty");
}

TEST(Msh, BadInput) {
  const std::string tet = "1 4 2 1 1 1 2 3 4\n";
  expect_input_error(read_msh, "", "empty");
  expect_input_error(read_msh, "hello", "\"hello\"");
  expect_input_error(read_msh, "$MeshFormat\n3 0 8\n$EndMeshFormat\n", "\"3\"", "msh41");
  expect_input_error(read_msh, "$MeshFormat\n2.2 1 4\n", "line 2", "numbers of 4 bytes");
  expect_input_error(read_msh, "$MeshFormat\n2.2 2 8\n", "line 2", "type of the file is 2");
  expect_input_error(read_msh, "$MeshFormat\n2.2 1 8\n\2\2\2\2\n", "four-byte number 1");
  expect_input_error(read_msh, head + nodes, "$Elements", "truncated");
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
  // Files with other volume elements are rejected.
  expect_input_error(read_msh, head + nodes + elements("7 5 2 1 1 1 2 3 4 1 2 3 4\n" + tet, "2"), "line 13",
                     "1 hexahedra, the first of them element 7 (type 5)");
  expect_input_error(read_msh, head + nodes + elements("1 12 2 1 1 1 2 3 4 1 2 3 4 1 2\n"), "line 13",
                     "1 quadratic hexahedra");
  expect_input_error(read_msh, head + nodes + elements("1 11 2 1 1 1 2 3 4 1 2 3 4 1 9\n"), "line 13",
                     "node 9");
  const std::string whole = head + nodes + "$Elements\n1\n" + tet + "$EndElements";
  for (std::size_t n = 0; n < whole.size(); ++n)
    (void)error_of<InputError>([&] { (void)read_msh(whole.substr(0, n), "f"); });
}

}  // namespace
}  // namespace tetwright::msh_test
