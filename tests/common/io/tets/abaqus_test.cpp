// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/abaqus.h"

#include <sstream>

#include "tests/common/io/expect_error.h"
#include "tests/common/io/round_trip.h"
#include "tests/common/io/tricky_meshes.h"

namespace tetwright::abaqus_test {
namespace {

const std::string nodes = "*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n10, 0., 0., 1.e0\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Abaqus, WhatIsWrittenIsReadWithItsNames) {
  const TetMesh mesh = mesh_with_surfaces();
  const std::string text = text_of(write_abaqus, mesh);
  const ReadTetMesh back = read_abaqus(text, "f");
  EXPECT_EQ(back.mesh.points[0], mesh.points[0]);
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    EXPECT_NEAR((back.mesh.points[i] - mesh.points[i]).norm(), 0, 1e-15);
  // Elements are listed by material.
  EXPECT_EQ(back.mesh.tets, (std::vector<Tet>{mesh.tets[1], mesh.tets[0]}));
  EXPECT_EQ(back.mesh.materials, (std::vector<MaterialTag>{-7, 1}));
  EXPECT_EQ(back.mesh.material_names, mesh.material_names);
  EXPECT_EQ(back.mesh.patch_groups,
            (std::map<InterfacePatch, SurfaceRegion>{{{{1, std::nullopt}, 1}, {2, "outlet"}}}));
  EXPECT_EQ(text_of(write_abaqus, read_abaqus(text_of(write_abaqus, back.mesh), "f").mesh),
            text_of(write_abaqus, back.mesh));
}

TEST(Abaqus, SidesAreThoseOfTheProgram) {
  // According to its manual, face 1 has the nodes 1-2-3, face 2 1-4-2, face 3 2-4-3, face 4 3-4-1.
  TetMesh mesh = one_tet();
  mesh.interfaces = find_interfaces(mesh);
  const std::vector<std::array<Index, 3>> faces{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  for (int side = 1; side <= 4; ++side) {
    TetMesh one = mesh;
    std::erase_if(one.interfaces, [&](const InterfaceTriangle& t) {
      const auto& f = faces[static_cast<std::size_t>(side - 1)];
      return !std::is_permutation(f.begin(), f.end(), t.ids.begin());
    });
    ASSERT_EQ(one.interfaces.size(), 1u);
    const std::string text = text_of(write_abaqus, one);
    EXPECT_NE(text.find("\n1, S" + std::to_string(side) + "\n"), std::string::npos) << text;
  }
}

TEST(Abaqus, NumbersHaveAtMost20CharactersAndLines16OfThem) {
  TetMesh mesh = tricky_tets();
  std::istringstream lines(text_of(write_abaqus, mesh));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('*')) continue;
    std::istringstream fields(line);
    int count = 0;
    for (std::string field; std::getline(fields, field, ','); ++count)
      EXPECT_LE(field.substr(field.find_first_not_of(' ')).size(), 20u) << line;
    EXPECT_LE(count, 16);
  }
}

TEST(Abaqus, TenNodesAreReadByTheirCorners) {
  const TetMesh mesh = mesh_with_surfaces();
  const MidsideNodes midside = straight_midside_nodes(mesh);
  const std::string text = text_of(write_abaqus, {mesh, &midside});
  EXPECT_NE(text.find("TYPE=C3D10"), std::string::npos);
  const ReadTetMesh back = read_abaqus(text, "f");
  EXPECT_EQ(back.mesh.points.size(), mesh.points.size());
  EXPECT_EQ(back.mesh.tets, (std::vector<Tet>{mesh.tets[1], mesh.tets[0]}));
  ASSERT_FALSE(back.dropped.empty());
  EXPECT_EQ(back.dropped[0], (Dropped{"midside nodes; tets of ten nodes are reduced to their corners", 9}));
}

TEST(Abaqus, FilesOfOtherPrograms) {
  // Sections define the materials; sets contain sets and ranges; elements continue over several lines.
  const ReadTetMesh r =
      read_abaqus("*Heading\n a job\n** a comment\n*Part, name=P\n" + nodes +
                      "11, 0, 0, -1\n*Element, type=C3D4T\n5, 1, 2,\n3, 10\n6, 1, 3, 2, 11\n*Element, "
                      "type=S3, elset=shell\n"
                      "7, 1, 2, 3\n*Elset, elset=Top, generate\n5, 5, 1\n*Elset, elset=\"low er\"\n6\n"
                      "*Elset, elset=all\nTop, low er\n*Nset, nset=fixed\n1, 2, 3\n"
                      "*Surface, type=ELEMENT, name=Load\nTop, S2\n*Surface, type=NODE, name=points\n1\n"
                      "*Solid Section, elset=TOP, material=Steel\n,\n*Solid Section, elset=low er, "
                      "material=Bone\n,\n*End Part\n",
                  "f");
  EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}, {0, 2, 1, 4}}));
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{1, 2}));
  EXPECT_EQ(r.mesh.material_names, (std::map<MaterialTag, std::string>{{1, "Top"}, {2, "low er"}}));
  EXPECT_EQ(r.material_field, "SOLID SECTION");
  EXPECT_EQ(r.mesh.patch_groups,
            (std::map<InterfacePatch, SurfaceRegion>{{{{1, std::nullopt}, 1}, {1, "Load"}}}));
  EXPECT_EQ(r.dropped, (std::vector<Dropped>{{"elements of type S3", 1},
                                             {"node sets (\"fixed\")", 1},
                                             {"surfaces of nodes (\"points\")", 1}}));
}

TEST(Abaqus, BadInput) {
  const std::string tet = "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 10\n";
  expect_input_error(read_abaqus, "", "empty");
  expect_input_error(read_abaqus, "hello", "line 1", "asterisk");
  expect_input_error(read_abaqus, nodes, "no tets");
  expect_input_error(read_abaqus, nodes + "*ELEMENT\n1, 1, 2, 3, 10\n", "line 6", "TYPE");
  expect_input_error(read_abaqus, nodes + replaced(tet, "10", "4"), "line 7", "node 4");
  expect_input_error(read_abaqus, nodes + replaced(tet, ", 10", ""), "line 7", "3 nodes instead of 4");
  expect_input_error(read_abaqus, nodes + replaced(tet, "1, 1", "x, 1"), "line 7", "\"x\"");
  expect_input_error(read_abaqus, nodes + tet + "1, 1, 3, 2, 10\n", "element 1", "twice");
  expect_input_error(read_abaqus, replaced(nodes, "2, 1, 0, 0", "1, 1, 0, 0") + tet, "node 1", "twice");
  expect_input_error(read_abaqus, replaced(nodes, "0, 1, 0", "0, inf, 0") + tet, "line 4", "finite");
  expect_input_error(read_abaqus, replaced(nodes, "3, 0, 1, 0", "3, 0, 1") + tet, "line 4",
                     "three coordinates");
  expect_input_error(read_abaqus, nodes + tet + "*ELEMENT, TYPE=C3D8R\n2, 1, 2, 3, 10, 1, 2, 3, 10\n",
                     "line 8", "1 elements of type C3D8R");
  expect_input_error(read_abaqus, nodes + tet + "*SURFACE, NAME=s\n1, S5\n", "line 9", "S1 to S4");
  expect_input_error(read_abaqus, nodes + tet + "*SURFACE, NAME=s\nzzz, S1\n", "line 9", "\"ZZZ\"");
  expect_input_error(read_abaqus, nodes + tet + "*ELSET, ELSET=e, GENERATE\n1, 4000000000, 1\n", "line 9",
                     "more");
  expect_input_error(read_abaqus, nodes + tet + "*INCLUDE, INPUT=a.inp\n", "line 8", "INCLUDE");
  const std::string whole = nodes + "*ELEMENT, TYPE=C3D4, ELSET=a\n1, 1, 2, 3, 10";
  for (std::size_t n = 0; n + 3 < whole.size(); ++n)
    (void)error_of<InputError>([&] { (void)read_abaqus(whole.substr(0, n), "f"); });
}

}  // namespace
}  // namespace tetwright::abaqus_test
