// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/vtp.h"

#include <cmath>

#include "tests/common/io/expect_error.h"

namespace tetwright::vtp_test {
namespace {

std::string file(const std::string& cell_data, const std::string& connectivity = "0 1 2 3 0 1 4",
                 const std::string& counts = "NumberOfLines=\"1\" NumberOfPolys=\"2\"") {
  const auto array = [](const std::string& type, const std::string& name, const std::string& values) {
    return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\">" + values +
           "</DataArray>\n";
  };
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
         "byte_order=\"LittleEndian\"><PolyData>\n<Piece NumberOfPoints=\"5\" " +
         counts +
         ">\n<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 1 1 0 "
         "0 1 0 0 0 1</DataArray></Points>\n<CellData>" +
         cell_data + "</CellData><Lines>" + array("Int32", "connectivity", "0 1") +
         array("Int32", "offsets", "2") + "</Lines>\n<Polys>" + array("Int32", "connectivity", connectivity) +
         array("Int32", "offsets", "4 7") + "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::string labels(const std::string& name, const std::string& type) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\">9 2 5</DataArray>";
}

TEST(Vtp, PolygonsAndTheirLabels) {
  std::vector<Dropped> dropped;
  const TriangleMesh mesh = read_vtp(file(labels("RegionId", "Int32")), "f", &dropped);
  EXPECT_EQ(mesh.points.size(), 5u);
  EXPECT_EQ(mesh.points[2], Vec3(1, 1, 0));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 4}}));
  // The first label is that of the line.
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{2, ""}, {5, ""}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"lines", 1}}));
}

TEST(Vtp, OtherFieldsAreNamed) {
  for (const std::string& data : {labels("colour", "Int32"), labels("RegionId", "Float32")}) {
    std::vector<Dropped> dropped;
    EXPECT_TRUE(read_vtp(file(data), "f", &dropped).groups.empty());
    ASSERT_EQ(dropped.size(), 2u);
    EXPECT_EQ(dropped[1].what.substr(0, 15), "fields of cells");
  }
}

TEST(Vtp, ArraysOfPointsAreFields) {
  const auto with = [](const std::string& arrays) {
    std::string text = file("");
    return text.replace(text.find("<CellData>"), 0, "<PointData>" + arrays + "</PointData>");
  };
  const std::string arrays =
      "<DataArray type=\"Float32\" Name=\"a\" format=\"ascii\">1 2 0.5 nan 4</DataArray>"
      "<DataArray type=\"String\" Name=\"text\" format=\"ascii\">1 2 3 4 5</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"b\" NumberOfComponents=\"2\" format=\"ascii\">0 1 2 3 4 5 6 7 8 "
      "9</DataArray>";
  const SurfaceWithFields read = read_vtp_with_fields(with(arrays), "f");
  EXPECT_EQ(read.surface.triangles.size(), 3u);
  ASSERT_EQ(read.point_fields.size(), 2u);
  EXPECT_EQ(read.point_fields[0].name, "a");
  EXPECT_EQ(read.point_fields[0].values[2], 0.5);
  EXPECT_TRUE(std::isnan(read.point_fields[0].values[3]));
  EXPECT_EQ(read.point_fields[1], (MeshField{"b", 2, true, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}}));
  const auto read_all = [](std::string_view bytes, const char* name) { read_vtp_with_fields(bytes, name); };
  const std::string few = with("<DataArray type=\"Int8\" Name=\"c\" format=\"ascii\">1 2</DataArray>");
  expect_input_error(read_all, few, "\"c\"", "5 were expected");
  // A caller that requests no fields can read the file all the same.
  std::vector<Dropped> dropped;
  EXPECT_EQ(read_vtp(few, "f", &dropped).points.size(), 5u);
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"lines", 1}, {"fields of points (\"c\")", 1}}));
}

TEST(Vtp, BadInput) {
  expect_input_error(read_vtp, "", "");
  expect_input_error(read_vtp, "<VTKFile type=\"PolyData\"></VTKFile>", "no element PolyData");
  expect_input_error(read_vtp, "<VTKFile type=\"UnstructuredGrid\"/>", "PolyData", "UnstructuredGrid");
  expect_input_error(read_vtp, file("", "0 1 2 9 0 1 4"), "polygon 0", "point 9");
  expect_input_error(read_vtp, file("", "0 1 2 3 0 1"), "polygon 1", "damaged");
  expect_input_error(read_vtp, file("", "0 1 2 3 0 1 4", "NumberOfStrips=\"1\""), "triangle strips");
  expect_input_error(read_vtp, file("", "0 1 2 3 0 1 4", "NumberOfPolys=\"0\""), "no triangles");
  expect_input_error(read_vtp, file("", "0 1 2 3 0 1 4", "NumberOfPolys=\"3\""), "3 were expected");
}

}  // namespace
}  // namespace tetwright::vtp_test
