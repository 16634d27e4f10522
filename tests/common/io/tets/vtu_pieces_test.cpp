// SPDX-License-Identifier: Apache-2.0

// Pieces of a .vtu file, as parallel solvers write them.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/io/tets/vtu.h"

namespace tetwright::vtu_pieces_test {
namespace {

/// Two tets with a common face, each in a separate piece with its own points, and a third piece with only a
/// triangle.
std::string two_pieces(const std::string& first_fields, const std::string& second_fields) {
  const auto piece = [](const std::string& points, const std::string& cells, int type,
                        const std::string& data) {
    const bool tet = type == 10;
    return std::string("<Piece NumberOfPoints=\"") + (tet ? "4" : "3") + "\" NumberOfCells=\"1\"><Points>" +
           "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" + points +
           "</DataArray></Points><Cells>" +
           "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" + cells + "</DataArray>" +
           "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" + (tet ? "4" : "3") +
           "</DataArray>" + "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">" +
           std::to_string(type) + "</DataArray></Cells>" + data + "</Piece>\n";
  };
  return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>\n" +
         piece("0 0 0  1 0 0  0 1 0  0 0 1", "0 1 2 3", 10, first_fields) +
         piece("0 0 -1  0 1 0  1 0 0  -0 0 0", "3 1 2 0", 10, second_fields) +
         piece("0 0 0  1 0 0  0 1 0", "0 1 2", 5, "") + "</UnstructuredGrid></VTKFile>\n";
}

std::string fields(const std::string& point_values, const std::string& material,
                   const std::string& more = "") {
  return "<PointData><DataArray type=\"Float64\" Name=\"t\" format=\"ascii\">" + point_values +
         "</DataArray></PointData><CellData><DataArray type=\"Int32\" Name=\"material\" format=\"ascii\">" +
         material + "</DataArray>" + more + "</CellData>";
}

TEST(VtuPieces, PiecesAreJoinedWhereTheyMeet) {
  std::string file = two_pieces(fields("1 2 3 4", "5"), fields("7 8 9 10", "6"));
  // The triangle's piece has points without fields, so no point field is in all pieces; it has no tets.
  const std::size_t triangle = file.rfind("<Piece");
  const ReadTetMesh all = read_vtu(file, "f");
  EXPECT_TRUE(all.mesh.point_fields.empty());
  EXPECT_EQ(all.mesh.materials, (std::vector<MaterialTag>{5, 6}));
  file.erase(triangle, file.find("</UnstructuredGrid>") - triangle);
  const ReadTetMesh r = read_vtu(file, "f");
  for (const TetMesh* mesh : {&all.mesh, &r.mesh}) {
    EXPECT_EQ(mesh->points.size(), 5u);
    EXPECT_EQ(mesh->tets, (std::vector<Tet>{{0, 1, 2, 3}, {0, 2, 1, 4}}));
  }
  EXPECT_EQ(r.mesh.points[4], Vec3(0, 0, -1));
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{5, 6}));
  ASSERT_EQ(r.mesh.point_fields.size(), 1u);
  EXPECT_EQ(r.mesh.point_fields[0].values, (std::vector<double>{1, 2, 3, 4, 7}));
  EXPECT_EQ(r.dropped, (std::vector<Dropped>{{"duplicate points shared between pieces", 3}}));
}

TEST(VtuPieces, EmptyPiecesHaveNoSay) {
  const std::string empty =
      "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"><Points><DataArray type=\"Float64\" "
      "NumberOfComponents=\"3\" format=\"ascii\"></DataArray></Points><Cells>"
      "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\"></DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\"></DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\"></DataArray></Cells></Piece>\n";
  std::string file = two_pieces(fields("1 2 3 4", "5"), fields("7 8 9 10", "6"));
  const std::size_t triangle = file.rfind("<Piece");
  file.replace(triangle, file.find("</UnstructuredGrid>") - triangle, empty);
  file.insert(file.find("<Piece"), empty);
  const ReadTetMesh r = read_vtu(file, "f");
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{5, 6}));
  ASSERT_EQ(r.mesh.point_fields.size(), 1u);
  EXPECT_EQ(r.mesh.point_fields[0].values, (std::vector<double>{1, 2, 3, 4, 7}));
}

TEST(VtuPieces, FieldsOfSomePiecesAndGhostCellsAreLeftOutAndSaid) {
  const std::string ghost = "<DataArray type=\"UInt8\" Name=\"vtkGhostType\" format=\"ascii\">1</DataArray>";
  const std::string no_ghost =
      "<DataArray type=\"UInt8\" Name=\"vtkGhostType\" format=\"ascii\">0</DataArray>";
  std::string file = two_pieces(fields("1 2 3 4", "5", no_ghost), fields("7 8 9 10", "6", ghost));
  const std::size_t triangle = file.rfind("<Piece");
  file.erase(triangle, file.find("</UnstructuredGrid>") - triangle);
  const ReadTetMesh r = read_vtu(file, "f");
  EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_TRUE(r.mesh.cell_fields.empty());  // the marks are not a field
  EXPECT_TRUE(std::any_of(r.dropped.begin(), r.dropped.end(),
                          [](const Dropped& d) { return d.what.find("vtkGhostType") != std::string::npos; }));
}

}  // namespace
}  // namespace tetwright::vtu_pieces_test
