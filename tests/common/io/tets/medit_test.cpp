// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/medit.h"

#include "tests/common/io/expect_error.h"
#include "tests/common/io/tricky_meshes.h"
#include "tests/common/small_meshes.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::medit_test {
namespace {

const std::string head = "MeshVersionFormatted 2\nDimension\n3\n";
const std::string vertices = "Vertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 7\n0 0 1 0\n";

TEST(Medit, RoundTripKeepsEveryBit) {
  const TetMesh mesh = tricky_tets();
  const ReadTetMesh back = read_medit(write_medit(mesh), "f");
  EXPECT_TRUE(same_bits(back.mesh.points, mesh.points));
  EXPECT_EQ(back.mesh.tets, mesh.tets);
  EXPECT_EQ(back.mesh.materials, mesh.materials);
  EXPECT_EQ(back.material_field, "medit:ref");
}

TEST(Medit, InterfaceTrianglesAreASectionOfTheirOwn) {
  TetMesh mesh = two_tets(-7);
  mesh.material_names = {{1, "End"}};
  const std::string without = write_medit(mesh);
  EXPECT_EQ(without.find("Triangles"), std::string::npos);
  mesh.interfaces = find_interfaces(mesh);
  const std::string text = write_medit(mesh);
  EXPECT_NE(text.find("# reference 1: -7|outside\n# reference 2: -7|1\n# reference 3: 1|outside\n"
                      "Triangles\n7\n1 2 3 2\n1 2 4 3\n"),
            std::string::npos)
      << text;
  const ReadTetMesh back = read_medit(text, "f");
  EXPECT_EQ(back.mesh.tets, mesh.tets);
  EXPECT_EQ(back.mesh.materials, mesh.materials);
  EXPECT_TRUE(back.mesh.material_names.empty());
  EXPECT_TRUE(back.mesh.interfaces.empty());
  EXPECT_EQ(write_medit(back.mesh), without);
}

TEST(Medit, OtherSectionsAndCommentsAreSkippedInAnyOrder) {
  const ReadTetMesh r =
      read_medit(head + "# a comment\nTriangles\n1\n1 2 3 4\nTetrahedra 1\n1 2 3 4 -5\nRidges\n1\n1\n" +
                     vertices + "RequiredVertices\n1\n1\nEnd\n",
                 "f");
  EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{-5}));
  EXPECT_EQ(r.dropped,
            (std::vector<Dropped>{
                {"ridges", 1}, {"required vertices", 1}, {"points with a reference other than 0", 1}}));
}

TEST(Medit, OtherVolumeCellsAreRefusedByKindAndNumber) {
  const std::string tets = "Tetrahedra\n1\n1 2 3 4 1\n";
  expect_input_error(read_medit,
                     head + vertices + tets + "Hexahedra\n2\n1 2 3 4 1 2 3 4 0\n1 2 3 4 1 2 3 4 0\n" +
                         "Pyramids\n1\n1 2 3 4 1 0\nEnd\n",
                     "line 13: 2 hexahedra and 1 pyramids", "convert them to tets");
  expect_input_error(read_medit, head + vertices + tets + "Prisms\n3\nEnd\n", "line 13: 3 prisms");
  expect_input_error(read_medit, head + vertices + "TetrahedraP2\n3\nEnd\n", "3 quadratic tets", "-order 1");
  // A file with an empty section is not rejected.
  EXPECT_EQ(read_medit(head + vertices + tets + "Hexahedra\n0\nEnd\n", "f").dropped,
            (std::vector<Dropped>{{"points with a reference other than 0", 1}}));
}

TEST(Medit, InterfaceTrianglesAreFoundAgain) {
  TetMesh mesh = two_tets(-7);
  mesh.interfaces = find_interfaces(mesh);
  const std::string text = write_medit(mesh);
  const auto dropped = [](const std::string& from) { return read_medit(from, "f").dropped; };
  EXPECT_EQ(dropped(text), (std::vector<Dropped>{{"boundary and interface triangles of 3 groups", 7, true}}));
  // A group with another number may be a boundary condition.
  std::string other = text;
  other.replace(other.find("1 2 3 2\n"), 8, "1 2 3 9\n");
  EXPECT_EQ(dropped(other),
            (std::vector<Dropped>{{"boundary and interface triangles of 2 groups", 6, true}}));
  const TetMesh back = read_medit(other, "f").mesh;
  EXPECT_EQ(back.patch_groups, (std::map<InterfacePatch, SurfaceRegion>{{{{-7, 1}, 1}, {9, ""}}}));
  const std::string again = write_medit(back);
  EXPECT_NE(again.find("# reference 1: -7|outside\n# reference 2: 1|outside\n# reference 9: 9\n"),
            std::string::npos)
      << again;
  EXPECT_EQ(write_medit(read_medit(again, "f").mesh), again);
  // Without comments the others may also be regions of the input.
  const auto without_comments = [](std::string from) {
    for (std::size_t at; (at = from.find("# ref")) != std::string::npos;)
      from.erase(at, from.find('\n', at) + 1 - at);
    return from;
  };
  EXPECT_EQ(read_medit(without_comments(other), "f").mesh.patch_groups.size(), 3u);
  EXPECT_EQ(dropped(without_comments(text)), dropped(text));
  // A comment with different content, and a group that leaves faces out.
  std::string named = text;
  named.replace(named.find("# reference 2: -7|1"), 19, "# reference 2: \"in\"");
  EXPECT_EQ(read_medit(named, "f").mesh.patch_groups.size(), 1u);
  std::string partial = text;
  partial.replace(partial.find("1 2 4 3\n"), 8, "1 2 4 0\n");
  EXPECT_EQ(read_medit(partial, "f").mesh.patch_groups,
            (std::map<InterfacePatch, SurfaceRegion>{{{{1, std::nullopt}, 1}, {3, ""}}}));
}

TEST(Medit, NamesAndNumbersThatCannotBeKeptAreComments) {
  TetMesh mesh = one_tet();
  mesh.interfaces = find_interfaces(mesh);
  mesh.interfaces[0].patch = 1;
  mesh.interfaces[1].patch = 2;
  const MaterialPair pair{1, std::nullopt};
  mesh.patch_groups = {{{pair, 1}, {-5, ""}}, {{pair, 2}, {9, "K\xf6rper A"}}};
  const std::string text = write_medit(mesh);
  EXPECT_NE(
      text.find("# reference 1: 1|outside\n# reference 2: -5\n# reference 9: \"K\xef\xbf\xbdrper_A\"\n"),
      std::string::npos)
      << text;
  EXPECT_EQ(read_medit(text, "f").mesh.patch_groups,
            (std::map<InterfacePatch, SurfaceRegion>{{{pair, 1}, {2, ""}},
                                                     {{pair, 2}, {9, "K\xef\xbf\xbdrper_A"}}}));
}

TEST(Medit, Surfaces) {
  const std::string text = head + vertices + "Triangles\n2\n1 2 3 4\n1 2 4 5\nRidges\n1\n1\nEnd\n";
  std::vector<Dropped> dropped;
  const TriangleMesh mesh = read_medit_surface(text, "f", &dropped);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}}));
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{4, ""}, {5, ""}}));
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"ridges", 1}, {"points with a reference other than 0", 1}}));
  expect_input_error(read_medit_surface, write_medit(two_tets(2)), "2 tets", "tetwright simplify");
  expect_input_error(read_medit_surface, head + vertices + "Triangles\n1\n1 2 9 4\n", "line 12",
                     "point 9 of 4 (counted from 1)");
  expect_input_error(read_medit_surface, head + vertices + "Triangles\n1\n1 0 2 4\n", "line 12",
                     "point 0 of 4");
  expect_input_error(read_medit_surface, head + "Triangles\n2\n1 2 9 4\n1 2 3 4\n" + vertices, "line 6",
                     "point 9 of 4");
}

TEST(Medit, QuadsOfSurfacesAreCut) {
  const TriangleMesh mesh =
      read_medit_surface(head + vertices + "Quadrilaterals\n1\n1 2 3 4 7\nTriangles\n1\n1 2 3 5\nEnd\n", "f");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{7, ""}, {5, ""}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 0, 1}));
  expect_input_error(read_medit_surface, head + vertices + "Quadrilaterals\n1\n1 2 3 5 7\n", "line 12",
                     "point 5 of 4");
  // In a file with tets they are not faces.
  EXPECT_EQ(read_medit(head + vertices + "Tetrahedra\n1\n1 2 3 4 1\nQuadrilaterals\n1\n1 2 3 4 7\n", "f")
                .dropped[0],
            (Dropped{"quads", 1}));
}

TEST(Medit, BadInput) {
  expect_input_error(read_medit, "", "empty");
  expect_input_error(read_medit, "MFEM mesh v1.0", "\"MFEM\"");
  expect_input_error(read_medit, "MeshVersionFormatted 2\nDimension 2\n", "line 2", "dimension 2");
  expect_input_error(read_medit, head + vertices, "no tets");
  expect_input_error(read_medit, head + "Tetrahedra\n1\n1 2 3 4 1\n", "Vertices");
  expect_input_error(read_medit, head + "Vertices\n4000000000\n0 0 0 0\n", "line 5", "4000000000");
  expect_input_error(read_medit, head + vertices + "Tetrahedra\n4000000000\n1 2 3 4 1\n", "line 11",
                     "4000000000");
  expect_input_error(read_medit, head + vertices + "Tetrahedra\n1\n1 2 3 5 1\n", "line 12", "point 5");
  expect_input_error(read_medit, head + vertices + "Tetrahedra\n1\n1 2 3 0 1\n", "line 12", "point 0");
  expect_input_error(read_medit, head + "Tetrahedra\n1\n1 2 3 5 1\n" + vertices, "tet 1", "point 5");
  expect_input_error(read_medit, head + vertices + "Tetrahedra\n1\n1 2 3 4 5000000000\n", "line 12",
                     "32 bits");
  expect_input_error(read_medit, head + vertices + "Tetrahedra\n1\n1 2 3 4 x\n", "line 12", "\"x\"");
  expect_input_error(read_medit, head + vertices + "Tetrahedra\n1\n1 2 3    \n\n\n\n", "truncated");
  expect_input_error(read_medit, head + "Vertices\n2\n0 0 0 0\n1 NaN 0 0\n", "line 7", "not finite");
}

}  // namespace
}  // namespace tetwright::medit_test
