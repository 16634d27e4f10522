// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/vtp.h"

#include <cmath>
#include <cstring>

#include "common/io/encodings/base64.h"
#include "common/io/encodings/vtu_arrays.h"
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

/// Text as VTK stores it: each text ends with a zero byte.
std::string zero_terminated(const std::vector<std::string>& texts) {
  std::string bytes;
  for (const std::string& text : texts) bytes += text + '\0';
  return bytes;
}

std::string text_array(const std::string& format, const std::string& content,
                       const std::string& name = "Names") {
  return "<Array type=\"String\" Name=\"" + name + "\" format=\"" + format + "\">" + content + "</Array>";
}

/// Texts as ascii: a number for each byte.
std::string ascii_texts(const std::vector<std::string>& texts, const std::string& name = "Names") {
  std::string numbers;
  for (const char c : zero_terminated(texts)) numbers += std::to_string(static_cast<int>(c)) + " ";
  return text_array("ascii", numbers, name);
}

std::string with_size(const std::string& bytes) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  std::string all(sizeof size, ' ');
  std::memcpy(all.data(), &size, sizeof size);
  return all + bytes;
}

std::string with_base64(const std::string& bytes) {
  std::string text;
  append_base64(text, with_size(bytes));
  return file(text_array("binary", text));
}

std::string with_appended(const std::string& bytes) {
  std::string text = file("<Array type=\"String\" Name=\"Names\" format=\"appended\" offset=\"0\"/>");
  return text.replace(text.find("</VTKFile>"), 0,
                      "<AppendedData encoding=\"raw\">_" + with_size(bytes) + "</AppendedData>");
}

std::string with_zlib(const std::string& bytes) {
  std::string packed;
  write_vtu_array(
      bytes.size(), [&](std::size_t begin, std::span<char> to) { bytes.copy(to.data(), to.size(), begin); },
      [&](std::string_view part) { packed += part; });
  std::string text = file(text_array("binary", packed));
  return text.replace(text.find("version=\"0.1\""), 0, "compressor=\"vtkZLibDataCompressor\" ");
}

TEST(Vtp, PolygonsAndTheirLabels) {
  std::vector<Dropped> dropped;
  const TriangleMesh mesh = read_vtp(file(labels("RegionId", "Int32")), "f", &dropped);
  EXPECT_EQ(mesh.points.size(), 5u);
  EXPECT_EQ(mesh.points[2], Vec3(1, 1, 0));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 4}}));
  // The first label belongs to the line.
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

TEST(Vtp, TextsOfCellsNameTheirGroups) {
  // The first label belongs to the line.
  const std::vector<std::string> names{"a line", "liver & gall",
                                       "h\xc3\xbc"
                                       "fte"};
  const std::string bytes = zero_terminated(names);
  for (const std::string& text :
       {file(ascii_texts(names)), with_base64(bytes), with_appended(bytes), with_zlib(bytes)}) {
    std::vector<Dropped> dropped;
    const TriangleMesh mesh = read_vtp(text, "f", &dropped);
    EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{0, names[1]}, {0, names[2]}})) << text;
    EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 0, 1}));
    EXPECT_EQ(dropped, (std::vector<Dropped>{{"lines", 1}}));
  }
}

TEST(Vtp, AnEmptyTextIsNoGroup) {
  const TriangleMesh mesh = read_vtp(file(ascii_texts({"", "", "bone"})), "f");
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{}, {0, "bone"}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 0, 1}));
  // With the same label for all cells there are no groups.
  EXPECT_TRUE(read_vtp(file(ascii_texts({"", "bone", "bone"})), "f").groups.empty());
}

TEST(Vtp, TheFirstOfSeveralLabelsCounts) {
  const std::string numbers = labels("RegionId", "Int32"), texts = ascii_texts({"a", "b", "c"}),
                    more = ascii_texts({"d", "e", "f"}, "more");
  std::vector<Dropped> dropped;
  EXPECT_EQ(read_vtp(file(numbers + texts), "f", &dropped).groups,
            (std::vector<SurfaceRegion>{{2, ""}, {5, ""}}));
  EXPECT_EQ(dropped.back(), (Dropped{"fields of cells (\"Names\")", 1}));
  dropped.clear();
  EXPECT_EQ(read_vtp(file(texts + numbers + more), "f", &dropped).groups,
            (std::vector<SurfaceRegion>{{0, "b"}, {0, "c"}}));
  EXPECT_EQ(dropped.back(), (Dropped{"fields of cells (\"RegionId\", \"more\")", 2}));
}

TEST(Vtp, TextsThatDoNotFit) {
  const auto expect_refused = [](const std::vector<std::string>& texts, const std::string& said) {
    const std::string bytes = zero_terminated(texts);
    for (const std::string& text :
         {file(ascii_texts(texts)), with_base64(bytes), with_appended(bytes), with_zlib(bytes)})
      expect_input_error(read_vtp, text, "Array \"Names\": ", said);
  };
  expect_refused({"a", "b"}, "2 values, but 3 were expected");
  expect_refused({"a", "b", "c", ""}, "more than the 3 strings expected");
  expect_refused({"a", std::string(1001, 'b'), "c"}, "string 1 (counted from 0) has more than 1000 bytes");
  EXPECT_EQ(read_vtp(file(ascii_texts({"a", std::string(1000, 'b'), "c"})), "f").groups.size(), 2u);
  expect_input_error(read_vtp, with_base64(std::string("a\0b\0c", 5)), "its last string does not end");
  expect_input_error(read_vtp, with_base64(std::string(4000, 'a')), "4000 bytes, but 3003 were expected");
  expect_input_error(read_vtp, with_zlib(std::string(4000, '\0')), "4000 bytes, but 3003 were expected");
  expect_input_error(read_vtp, file(text_array("ascii", "97 0 300 0")),
                     "expected a character code, found \"300\"");
  expect_input_error(read_vtp, file(text_array("ascii", "liver bone")), "found \"liver\"");
  // Two texts for each cell are not a label.
  std::string two = ascii_texts({"a", "b"});
  two.replace(two.find("Name="), 0, "NumberOfComponents=\"2\" ");
  EXPECT_TRUE(read_vtp(file(two), "f").groups.empty());
}

TEST(Vtp, NamedGroupsAreWrittenAndRead) {
  TriangleMesh mesh = read_vtp(file(ascii_texts({"", "liver", "bone"})), "f");
  std::string text;
  write_vtp(mesh, [&](std::string_view part) { text += part; });
  const TriangleMesh back = read_vtp(text, "f");
  ASSERT_EQ(back.groups.size(), 2u);
  EXPECT_EQ(back.groups[0].name, "liver");
  EXPECT_EQ(back.groups[1].name, "bone");
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
  // A caller that requests no fields can read the file nevertheless.
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
