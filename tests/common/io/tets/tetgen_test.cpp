// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/tetgen.h"

#include <cmath>
#include <map>

#include "tests/common/io/expect_error.h"

namespace tetwright::tetgen_test {
namespace {

const std::string node =
    "# made by hand\n\n5  3  2  1  # points\n1 0 0 0 0.5 7 1\n2 1 0 0 1.5 8 0\n3 0 1 0 nan 9 -1\n\n"
    "4 0 0 1 3.5 10 2 # the top\n5 1 1 1 4.5 11 0\n";
const std::string ele = "2 4 2\n1 1 2 3 4  3 0.25\n# between\n2 2 3 4 5  -4 2\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

ReadTetMesh read_pair(const std::string& points, const std::string& tets) {
  return read_tetgen({points, "n"}, {tets, "e"}, {});
}
ReadTetMesh read_with_faces(const std::string& face) {
  return read_tetgen({node, "n"}, {ele, "e"}, NamedBytes{face, "f"});
}

TEST(TetGen, PointsTetsAndTheirNumbers) {
  const ReadTetMesh r = read_pair(node, ele);
  EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(r.mesh.points[3], Vec3(0, 0, 1));
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{3, -4}));
  EXPECT_EQ(r.material_field, "attribute");
  ASSERT_EQ(r.mesh.point_fields.size(), 3u);
  EXPECT_EQ(r.mesh.point_fields[0].name, "attribute1");
  EXPECT_EQ(r.mesh.point_fields[0].values[1], 1.5);
  EXPECT_TRUE(std::isnan(r.mesh.point_fields[0].values[2]));
  EXPECT_EQ(r.mesh.point_fields[1], (MeshField{"attribute2", 1, false, {7, 8, 9, 10, 11}}));
  EXPECT_EQ(r.mesh.point_fields[2], (MeshField{"boundary_marker", 1, true, {1, 0, -1, 2, 0}}));
  EXPECT_EQ(r.mesh.cell_fields, (std::vector<MeshField>{{"attribute2", 1, false, {0.25, 2}}}));
}

TEST(TetGen, NumbersFromZeroAndShortHeads) {
  const ReadTetMesh r = read_pair("4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1 99\n", "1 4\n0 0 1 2 3\n");
  EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{1}));
  EXPECT_EQ(r.material_field, "");
  EXPECT_TRUE(r.mesh.point_fields.empty());
}

TEST(TetGen, AnAttributeThatIsNotWholeIsAField) {
  const ReadTetMesh r = read_pair(node, "1 4 1\n1 1 2 3 4 0.5\n");
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{1}));
  EXPECT_EQ(r.mesh.cell_fields, (std::vector<MeshField>{{"attribute", 1, false, {0.5}}}));
}

TEST(TetGen, QuadraticTetsByTheirCorners) {
  std::string nodes = "10 3\n";
  for (int i = 0; i < 10; ++i) nodes += std::to_string(i) + " " + std::to_string(i * i) + " 0 1\n";
  const ReadTetMesh r = read_pair(nodes, "1 10\n0 4 9 1 2 0 3 5 6 7 8\n");
  EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{2, 3, 0, 1}}));
  EXPECT_EQ(r.mesh.points.size(), 4u);
  EXPECT_EQ(r.mesh.points[3], Vec3(81, 0, 1));
  EXPECT_EQ(r.dropped,
            (std::vector<Dropped>{{"midside nodes; tets of ten nodes are reduced to their corners", 6}}));
}

TEST(TetGen, BadInput) {
  const auto expect = [](const std::string& n, const std::string& e, const std::string& first,
                         const std::string& second = "") {
    const std::string message = error_of<InputError>([&] { (void)read_pair(n, e); });
    EXPECT_EQ(message.find(first), 0u) << message;
    EXPECT_NE(message.find(second), std::string::npos) << message;
  };
  expect("", ele, "n: line 1:", "empty");
  expect(node, " \n#\n", "e: line", "empty");
  expect(replaced(node, "5  3", "5  2"), ele, "n: line 3:", "dimension 2");
  expect(replaced(node, "5  3", "4000000000  3"), ele, "n: line", "4000000000");
  expect(replaced(node, "5  3", "-5  3"), ele, "n: line", "-5");
  expect(replaced(node, "3  2  1", "3  -2  1"), ele, "n: line 3:", "-2");
  expect(replaced(node, "3  2  1", "3  2000000000  1"), ele, "n: line 3:", "2000000000");
  expect(replaced(node, "5  3", "0  3"), ele, "n: line", "no points");
  expect(replaced(node, "1 0 0 0 0.5", "2 0 0 0 0.5"), ele, "n: line 4:", "number 2");
  expect(replaced(node, "4 0 0 1 3.5", "5 0 0 1 3.5"), ele, "n: line 8:", "found point 5 instead of point 4");
  expect(replaced(node, "1 0 0 1.5", "1 0 inf 1.5"), ele, "n: line 5:", "not finite");
  expect(replaced(node, "1 0 0 1.5", "1 0 zero 1.5"), ele, "n: line 5:", "\"zero\"");
  expect(replaced(node, "1.5 8 0", "1.5"), ele, "n: line 5:", "the line ends where a attribute");
  expect(replaced(node, "5 1 1 1 4.5 11 0\n", ""), ele, "n: line", "truncated");
  expect(node, replaced(ele, "2 4 2", "2 3 2"), "e: line 1:", "tets of 3 points");
  expect(node, replaced(ele, "2 4 2", "4000000000 4 2"), "e: line", "4000000000");
  expect(node, replaced(ele, "2 4 2", "0 4 2"), "e: line", "no tets");
  expect(node, replaced(ele, "2 3 4 5", "2 3 4 6"),
         "e: line 4:", "point 6, but the .node file has points 1 to 5");
  expect(node, replaced(ele, "2 3 4 5", "0 3 4 5"), "e: line 4:", "point 0");
  expect(node, replaced(ele, "2 4 2", "3 4 2"), "e: line", "truncated");
  for (std::size_t n = 0; n + 12 < ele.size(); ++n)
    (void)error_of<InputError>([&] { (void)read_pair(node, ele.substr(0, n)); });
}

TEST(TetGen, MarkedFacesArePatches) {
  const ReadTetMesh r = read_with_faces("# of TetGen\n4 1\n1 1 2 3 7\n2 1 2 4 -3\n3 1 3 4 7\n4 2 3 4 0\n");
  ASSERT_EQ(r.mesh.patch_groups.size(), 2u);
  std::map<std::int64_t, int> faces;
  for (const InterfaceTriangle& t : r.mesh.interfaces)
    if (const auto group = r.mesh.patch_groups.find({t.pair(), t.patch}); group != r.mesh.patch_groups.end())
      ++faces[group->second.number];
  EXPECT_EQ(faces, (std::map<std::int64_t, int>{{-3, 1}, {7, 2}}));
  EXPECT_TRUE(read_with_faces("4 0\n1 1 2 3\n2 1 2 4\n3 1 3 4\n4 2 3 4\n").mesh.patch_groups.empty());
}

TEST(TetGen, NamesOfOurOwnFilesComeBack) {
  TetMesh mesh = read_with_faces("2 1\n1 1 2 3 7\n2 1 2 4 8\n").mesh;
  mesh.material_names = {{3, "bone"}, {-4, "grey matter"}};
  ASSERT_EQ(mesh.patch_groups.size(), 2u);
  mesh.patch_groups.begin()->second.name = "inlet: left";
  const auto written = [&](auto write) {
    std::string text;
    write(mesh, [&](std::string_view bytes) { text += bytes; });
    return text;
  };
  const std::string node_again = written(write_tetgen_node), ele_again = written(write_tetgen_ele),
                    face_again = written(write_tetgen_face);
  const TetMesh back = read_tetgen({node_again, "n"}, {ele_again, "e"}, NamedBytes{face_again, "f"}).mesh;
  EXPECT_EQ(back.material_names, mesh.material_names);
  ASSERT_EQ(back.patch_groups.size(), 2u);
  EXPECT_EQ(back.patch_groups.begin()->second.name, "inlet: left");
  EXPECT_EQ(back.tets, mesh.tets);
}

TEST(TetGen, FacesOfQuadraticTetsHaveMoreNodes) {
  std::string nodes = "10 3\n";
  for (int i = 0; i < 10; ++i)
    nodes += std::to_string(i) + " " + std::to_string(i * i) + " " + std::to_string(i % 3) + " " +
             std::to_string(i % 2) + "\n";
  const ReadTetMesh r = read_tetgen({nodes, "n"}, {"1 10\n0 4 9 1 2 0 3 5 6 7 8\n", "e"},
                                    NamedBytes{"2 1\n0 4 9 1 5 6 7 1\n1 4 9 2 5 6 7 2\n", "f"});
  ASSERT_EQ(r.mesh.patch_groups.size(), 2u);
  EXPECT_EQ(r.mesh.patch_groups.begin()->second.number, 1);
}

TEST(TetGen, BadFaces) {
  const auto refused = [](const std::string& face, const std::string& said) {
    const std::string message = error_of<InputError>([&] { (void)read_with_faces(face); });
    EXPECT_NE(message.find(said), std::string::npos) << message;
    EXPECT_EQ(message.rfind("f", 0), 0u) << message;
  };
  refused("", "empty");
  refused("2 1\n1 1 2 3 7\n", "truncated");
  refused("1 1\n1 1 2 9 7\n", "refers to point 9");
  refused("1 1\n1 1 2 3 x\n", "\"x\"");
  refused("1 2\n1 1 2 3 7\n", "2");
  refused("1 1\n1 1 2 5 7\n", "not a face of any tet");
}

}  // namespace
}  // namespace tetwright::tetgen_test
