// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/nastran.h"

#include "tests/common/io/expect_error.h"
#include "tests/common/io/round_trip.h"
#include "tests/common/io/tricky_meshes.h"

namespace tetwright::nastran_test {
namespace {

const std::string grids = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,7,,0.,0.,1.\n";

TEST(Nastran, WhatIsWrittenIsReadWithItsNames) {
  const TetMesh mesh = mesh_with_surfaces();
  const ReadTetMesh back = read_nastran(text_of(write_nastran, mesh), "f");
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    EXPECT_NEAR((back.mesh.points[i] - mesh.points[i]).norm(), 0, 1e-12);
  EXPECT_EQ(back.mesh.tets, (std::vector<Tet>{mesh.tets[1], mesh.tets[0]}));
  EXPECT_EQ(back.mesh.materials, (std::vector<MaterialTag>{2, 1}));  // -7 cannot be the number of a property
  EXPECT_EQ(back.mesh.material_names, (std::map<MaterialTag, std::string>{{2, "skin"}, {1, "bone"}}));
  EXPECT_EQ(back.mesh.patch_groups,
            (std::map<InterfacePatch, SurfaceRegion>{{{{1, std::nullopt}, 1}, {5, "outlet"}}}));
  EXPECT_EQ(back.material_field, "PID");
}

TEST(Nastran, NumbersOfSurfacesFitTheirFields) {
  TetMesh mesh = mesh_with_surfaces();
  std::uint16_t patch = 0;
  for (InterfaceTriangle& t : mesh.interfaces)
    if (t.material == 1 && !t.other && patch < 2) {
      t.patch = ++patch;
      mesh.patch_groups[{t.pair(), patch}] = {123456780 + patch, patch == 1 ? "inlet" : "outlet"};
    }
  ASSERT_EQ(patch, 2);
  const std::string text = text_of(write_nastran, mesh);
  EXPECT_EQ(text.find("12345678"), std::string::npos) << text;
  std::vector<std::string> names;
  for (const auto& [of, group] : read_nastran(text, "f").mesh.patch_groups) names.push_back(group.name);
  EXPECT_EQ(names, (std::vector<std::string>{"inlet", "outlet"}));
}

TEST(Nastran, LinesAreOfFixedFields) {
  TetMesh mesh = tricky_tets();
  const MidsideNodes midside = straight_midside_nodes(mesh);
  const std::string text = text_of(write_nastran, {mesh, &midside});
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (text[begin] != '$') {
      EXPECT_LE(end - begin, 80u) << text.substr(begin, end - begin);
    }
    begin = end + 1;
  }
  // Ten points need a second line.
  EXPECT_NE(text.find("CTETRA  "), std::string::npos);
  EXPECT_NE(text.find("\n+       "), std::string::npos);
  const ReadTetMesh back = read_nastran(text, "f");
  EXPECT_EQ(back.mesh.tets.size(), mesh.tets.size());
  EXPECT_EQ(back.mesh.points.size(), mesh.points.size());
}

TEST(Nastran, FieldsOfEveryWidth) {
  const ReadTetMesh r = read_nastran(
      "SOL 101\nCEND\nBEGIN BULK\n$ a comment\nGRID           1              0.      0.      0.\n"
      "GRID*                  2                            1.+0              0.*A1\n*A1                  0.\n"
      "GRID,3,,0.,1.D0,0.\ngrid,7,0,0.,0.,1.\nGRID,8,,.1,.1,-1.\nCTETRA         1       4       1       2    "
      "   3       7\n"
      "CTETRA,2,5,1,3,2,8\nCQUAD4,3,1,1,2,3,7\nMAT1,1,1.,,.3\nENDDATA\nnonsense\n",
      "f");
  EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}, {0, 2, 1, 4}}));
  EXPECT_EQ(r.mesh.points[1], Vec3(1, 0, 0));
  EXPECT_EQ(r.mesh.points[2], Vec3(0, 1, 0));
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{4, 5}));
  EXPECT_EQ(r.dropped, (std::vector<Dropped>{{"elements CQUAD4", 1}}));
}

TEST(Nastran, BadInput) {
  const std::string tet = "CTETRA,1,4,1,2,3,7\n";
  expect_input_error(read_nastran, "", "empty");
  expect_input_error(read_nastran, grids, "no CTETRA");
  expect_input_error(read_nastran, grids + "CTETRA,1,4,1,2,3,8\n", "line 5", "point 8");
  expect_input_error(read_nastran, grids + "CTETRA,1,4,1,2,3\n", "line 5", "point of a tet");
  expect_input_error(read_nastran, grids + "CTETRA,1,3000000000,1,2,3,7\n", "line 5", "32 bits");
  expect_input_error(read_nastran, grids + tet + tet, "line 6", "twice");
  expect_input_error(read_nastran, grids + "GRID,1,,0.,0.,0.\n" + tet, "GRID 1", "twice");
  expect_input_error(read_nastran, "GRID,1,5,0.,0.,0.\n" + tet, "line 1", "coordinate system");
  expect_input_error(read_nastran, "GRID,1,,0.,zero,0.\n" + tet, "line 1", "\"ZERO\"");
  expect_input_error(read_nastran, grids + tet + "CHEXA,2,1,1,2,3,7,1,2,3,7\n", "line 6", "1 hexahedra");
  expect_input_error(read_nastran, "+       1       2\n", "line 1", "continues");
  expect_input_error(read_nastran, grids + tet + "INCLUDE 'a.bdf'\n", "line 6", "INCLUDE");
}

}  // namespace
}  // namespace tetwright::nastran_test
