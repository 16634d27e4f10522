// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/vtk.h"

#include <algorithm>
#include <cmath>

#include "tests/common/io/expect_error.h"

namespace tetwright::vtk_test {
namespace {

/// Builds a file, ASCII or binary.
class File {
 public:
  explicit File(bool binary, const char* version = "3.0", const char* dataset = "UNSTRUCTURED_GRID")
      : binary_(binary) {
    text_ = std::string("# vtk DataFile Version ") + version + "\na title\n" + (binary ? "BINARY" : "ASCII") +
            "\nDATASET " + dataset + "\n";
  }
  File& line(const std::string& words) {
    text_ += words + "\n";
    return *this;
  }
  template <class Number>
  File& numbers(const std::vector<Number>& values) {
    for (Number v : values) {
      if (binary_) {
        std::string bytes(reinterpret_cast<const char*>(&v), sizeof(v));
        std::reverse(bytes.begin(), bytes.end());
        text_ += bytes;
      } else {
        text_ += std::to_string(v) + " ";
      }
    }
    text_ += "\n";
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  bool binary_;
  std::string text_;
};

/// A file with a triangle and a tet.
File small(bool binary, const char* version = "3.0") {
  File f(binary, version);
  f.line("POINTS 4 float").numbers<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  if (version[0] == '5') {
    f.line("CELLS 3 7").line("OFFSETS vtktypeint64").numbers<std::int64_t>({0, 3, 7});
    f.line("CONNECTIVITY vtktypeint64").numbers<std::int64_t>({0, 1, 2, 0, 1, 2, 3});
  } else {
    f.line("CELLS 2 9").numbers<std::int32_t>({3, 0, 1, 2, 4, 0, 1, 2, 3});
  }
  f.line("CELL_TYPES 2").numbers<std::int32_t>({5, 10});
  return f;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Vtk, TetsOfEveryVersionAndEncoding) {
  for (const char* version : {"1.0", "2.0", "3.0", "4.2", "5.1"})
    for (const bool binary : {false, true}) {
      SCOPED_TRACE(version);
      const ReadTetMesh r = read_vtk(small(binary, version).text(), "f");
      EXPECT_EQ(r.mesh.points.size(), 4u);
      EXPECT_EQ(r.mesh.points[3], Vec3(0, 0, 1));
      EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
      EXPECT_EQ(r.dropped, (std::vector<Dropped>{{"triangles", 1}}));
      EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{1}));
      EXPECT_EQ(r.material_field, "");
    }
}

TEST(Vtk, EveryKindOfData) {
  for (const bool binary : {false, true}) {
    SCOPED_TRACE(binary);
    File f = small(binary);
    f.line("CELL_DATA 2");
    f.line("SCALARS MaterialID int").line("LOOKUP_TABLE default").numbers<std::int32_t>({9, -7});
    f.line("SCALARS two double 2").line("LOOKUP_TABLE mine").numbers<double>({1, 2, 3, 4});
    f.line("LOOKUP_TABLE mine 1");
    f.numbers<std::uint8_t>({255, 0, 0, 255});
    f.line("Vectors a%20b float").numbers<float>({1, 2, 3, 4, 5, 6});
    f.line("METADATA").line("INFORMATION 1").line("NAME x LOCATION y").line("DATA 1 2").line("");
    f.line("FIELD FieldData 3").line("few 1 2 short").numbers<std::int16_t>({1, 2});
    f.line("METADATA").line("COMPONENT_NAMES").line("X").line("");
    f.line("wide 1 2 vtktypeint64").numbers<std::int64_t>({1, 1LL << 40});
    f.line("text 1 2 string");
    // In binary files the length precedes the text, in one or four bytes.
    f.line(binary ? "\xc3"
                    "abc" +
                        std::string("\x40\0\0\1z", 5)
                  : "abc\nz");
    f.line("POINT_DATA 4");
    f.line("NORMALS n float").numbers<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1});
    f.line("TENSORS t double").numbers<double>(std::vector<double>(36, 2.5));
    f.line("TEXTURE_COORDINATES uv 2 float").numbers<float>({1, 2, 3, 4, 5, 6, 7, 8});
    f.line("SCALARS plain unsigned_char 1")
        .line("LOOKUP_TABLE default")
        .numbers<std::uint8_t>({1, 2, 3, 255});
    const ReadTetMesh r = read_vtk(f.text(), "f");
    EXPECT_EQ(r.material_field, "MaterialID");
    EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{-7}));
    EXPECT_EQ(r.mesh.cell_fields, (std::vector<MeshField>{{"two", 2, false, {3, 4}},
                                                          {"a b", 3, false, {4, 5, 6}},
                                                          {"few", 1, true, {2}},
                                                          {"wide", 1, true, {0x1p40}}}));
    ASSERT_EQ(r.mesh.point_fields.size(), 4u);
    EXPECT_EQ(r.mesh.point_fields[0].components, 3);
    EXPECT_EQ(r.mesh.point_fields[1], (MeshField{"t", 9, false, std::vector<double>(36, 2.5)}));
    EXPECT_EQ(r.mesh.point_fields[2], (MeshField{"uv", 2, false, {1, 2, 3, 4, 5, 6, 7, 8}}));
    EXPECT_EQ(r.mesh.point_fields[3], (MeshField{"plain", 1, true, {1, 2, 3, 255}}));
    EXPECT_EQ(r.dropped,
              (std::vector<Dropped>{
                  {"triangles", 1}, {"arrays of text (\"text\")", 1}, {"arrays of colours (\"mine\")", 1}}));
  }
}

TEST(Vtk, DataOfTheFileAndKeywordsInSmallLetters) {
  File f = small(false);
  std::string text = replaced(f.text(), "POINTS", "FIELD FieldData 1\nTIME 1 1 double\n0.5\npoints");
  text = replaced(text, "CELL_TYPES", "cell_types") + "cell_data 2\nfield f 1\nZones 1 2 int\n3 4\n";
  const ReadTetMesh r = read_vtk(text, "f");
  EXPECT_EQ(r.material_field, "Zones");
  EXPECT_EQ(r.dropped,
            (std::vector<Dropped>{{"triangles", 1}, {"arrays of the whole dataset (\"TIME\")", 1}}));
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{4}));
  EXPECT_TRUE(r.mesh.cell_fields.empty());
}

TEST(Vtk, OtherVolumeCellsAreRefusedByKindAndNumber) {
  const std::string head =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
      "0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 4 20\n4 0 1 2 3\n4 0 1 2 3\n4 0 1 2 3\n4 0 1 2 3\nCELL_TYPES 4\n";
  expect_input_error(read_vtk, head + "10\n12\n12\n14\n",
                     "line 14: 2 hexahedra and 1 pyramids, the first of them cell 1", "convert them to tets");
  expect_input_error(read_vtk, head + "10\n25\n10\n10\n", "line 14: 1 quadratic hexahedra", "Tetrahedralize");
  expect_input_error(read_vtk, head + "10\n999\n10\n10\n", "1 cells of the unknown type 999");
}

TEST(Vtk, NanInFieldsAndBits) {
  for (const bool binary : {false, true}) {
    File f = small(binary);
    f.line("POINT_DATA 4").line("SCALARS x double").line("LOOKUP_TABLE default");
    f.numbers<double>({1, std::nan(""), 3, 4});
    f.line("SCALARS b bit").line("LOOKUP_TABLE default");
    if (binary)
      f.numbers<std::uint8_t>({0xa0});
    else
      f.line("1 0 1 0");
    const ReadTetMesh r = read_vtk(f.text(), "f");
    EXPECT_TRUE(std::isnan(r.mesh.point_fields[0].values[1]));
    EXPECT_EQ(r.mesh.point_fields[1], (MeshField{"b", 1, true, {1, 0, 1, 0}}));
  }
}

TEST(Vtk, BadInput) {
  const std::string good = small(false).text();
  expect_input_error(read_vtk, "", "empty");
  expect_input_error(read_vtk, "hello\n", "line 1", "\"hello\"");
  expect_input_error(read_vtk, replaced(good, "3.0", "6.0"), "line 1", "\"6.0\"");
  expect_input_error(read_vtk, replaced(good, "ASCII", "TEXT"), "line 3", "\"TEXT\"");
  expect_input_error(read_vtk, replaced(good, "UNSTRUCTURED_GRID", "POLYDATA"), "line 4", "\"POLYDATA\"");
  expect_input_error(read_vtk, replaced(good, "CELL_TYPES", "CELL_KINDS"), "line 9", "\"CELL_KINDS\"");
  expect_input_error(read_vtk, replaced(good, "POINTS 4 float", "POINTS 4000000000 float"), "4000000000");
  expect_input_error(read_vtk, replaced(good, "POINTS 4 float", "POINTS -4 float"), "line 5", "-4");
  expect_input_error(read_vtk, replaced(good, "0.000000", "nan"), "line 6", "not finite");
  expect_input_error(read_vtk, replaced(good, "CELLS 2 9", "CELLS 2 10"), "expected a whole number");
  expect_input_error(read_vtk, replaced(good, "CELLS 2 9", "CELLS 1 9"), "use 4 numbers, but CELLS gives 9");
  expect_input_error(read_vtk, replaced(good, "3 0 1 2 4", "3 0 1 2 5"), "line 8", "cell 1");
  expect_input_error(read_vtk, replaced(good, "3 0 1 2 4 0 1 2 3", "4 0 1 2 0 3 0 1 2"), "line 8",
                     "tet of 3 points");
  expect_input_error(read_vtk, replaced(good, "4 0 1 2 3", "4 0 1 2 4"), "line 8", "point 4 of 4");
  expect_input_error(read_vtk, replaced(good, "4 0 1 2 3", "4 0 1 2 -3"), "line 8", "point -3");
  expect_input_error(read_vtk, replaced(good, "5 10", "5 12"), "line 10",
                     "1 hexahedra, the first of them cell 1 (counted from 0, type 12)");
  expect_input_error(read_vtk, replaced(good, "5 10", "5 24"), "line 8", "is a tet of 4 points");
  expect_input_error(read_vtk, replaced(good, "5 10", "5 5"), "no tets");
  expect_input_error(read_vtk, replaced(good, "CELL_TYPES 2\n5 ", "CELL_TYPES 1\n"), "1 types for 2 cells");
  const auto data = [&](const std::string& more) { return good + more; };
  expect_input_error(read_vtk, data("CELL_DATA 3\n"), "line 11", "data of 3 cells, but there are 2");
  expect_input_error(read_vtk, data("POINT_DATA 3\n"), "line 11", "data of 3 points, but there are 4");
  expect_input_error(read_vtk, data("CELL_DATA 2\nSCALARS a int\n1\n"), "line 14", "truncated");
  expect_input_error(read_vtk, data("CELL_DATA 2\nSCALARS a float\nLOOKUP_TABLE default\n1 x\n"), "line 14",
                     "\"x\"");
  expect_input_error(read_vtk, data("CELL_DATA 2\nSCALARS a what\nLOOKUP_TABLE default\n1 2\n"), "\"what\"");
  expect_input_error(read_vtk, data("CELL_DATA 2\nSCALARS a int 0\n1 2\n"), "line 12", "0 components");
  expect_input_error(read_vtk, data("CELL_DATA 2\nFIELD f 1\na 1 3 int\n1 2 3\n"), "line 13",
                     "3 values, but there are 2 cells");
  expect_input_error(read_vtk, data("FIELD f 1\na 4000000000 4000000000 int\n1\n"), "4000000000");
  expect_input_error(read_vtk,
                     "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINT_DATA 0\n",
                     "before the points");
  const std::string offsets = small(false, "5.1").text();
  expect_input_error(read_vtk, replaced(offsets, "0 3 7", "0 8 7"), "offset", "8");
  expect_input_error(read_vtk, replaced(offsets, "0 3 7", "1 3 7"), "first offset is 1");
  expect_input_error(read_vtk, replaced(offsets, "CONNECTIVITY", "CONNECTION"), "\"CONNECTION\"");
  // Indices of points and materials have 32 bits.
  expect_input_error(read_vtk, data("CELL_DATA 2\nSCALARS m long\nLOOKUP_TABLE default\n1 3000000000\n"),
                     "3000000000", "32 bits");
}

TEST(Vtk, CutShort) {
  for (const char* version : {"3.0", "5.1"})
    for (const bool binary : {false, true}) {
      File f = small(binary, version);
      const std::string& good = f.text();
      for (std::size_t n = 0; n + 2 < good.size(); ++n)
        (void)error_of<InputError>([&] { (void)read_vtk(good.substr(0, n), "f"); });
    }
}

/// A tetrahedron whose last faces are a strip, together with a quad, a line and a vertex.
std::string surface_file(bool binary, bool offsets) {
  File f(binary, offsets ? "5.1" : "3.0", "POLYDATA");
  f.line("POINTS 5 float").numbers<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 2, 2, 2});
  const auto list = [&](const std::string& keyword, const std::vector<std::vector<std::int64_t>>& cells) {
    std::vector<std::int64_t> ends{0}, points;
    std::vector<std::int32_t> old;
    for (const auto& cell : cells) {
      old.push_back(static_cast<std::int32_t>(cell.size()));
      for (const std::int64_t p : cell) {
        points.push_back(p);
        old.push_back(static_cast<std::int32_t>(p));
      }
      ends.push_back(static_cast<std::int64_t>(points.size()));
    }
    if (offsets) {
      f.line(keyword + " " + std::to_string(ends.size()) + " " + std::to_string(points.size()));
      f.line("OFFSETS vtktypeint64").numbers(ends).line("CONNECTIVITY vtktypeint64").numbers(points);
    } else {
      f.line(keyword + " " + std::to_string(cells.size()) + " " + std::to_string(old.size())).numbers(old);
    }
  };
  list("VERTICES", {{0}});
  list("LINES", {{0, 1}});
  list("POLYGONS", {{0, 2, 1}, {0, 1, 3}, {1, 2, 4, 3}});
  list("TRIANGLE_STRIPS", {{0, 3, 2, 1}});
  f.line("CELL_DATA 6").line("SCALARS patch_id int 1").line("LOOKUP_TABLE default");
  f.numbers<std::int32_t>({9, 9, 4, 4, 5, 6});
  f.line("POINT_DATA 5").line("SCALARS t float").line("LOOKUP_TABLE default");
  f.numbers<float>({1, 2, 3, 4, 5});
  return f.text();
}

TEST(VtkSurface, PolygonsStripsAndGroups) {
  for (const bool binary : {false, true})
    for (const bool offsets : {false, true}) {
      std::vector<Dropped> dropped;
      const TriangleMesh s = read_vtk_surface(surface_file(binary, offsets), "f", &dropped);
      EXPECT_EQ(s.points.size(), 5u);
      // The quad becomes two triangles, the strip two consistently oriented ones.
      EXPECT_EQ(s.triangles,
                (std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {1, 2, 4}, {1, 4, 3}, {0, 3, 2}, {2, 3, 1}}));
      ASSERT_EQ(s.triangle_groups.size(), 6u);
      std::vector<std::int64_t> numbers;
      for (const auto g : s.triangle_groups) numbers.push_back(s.groups[g].number);
      EXPECT_EQ(numbers, (std::vector<std::int64_t>{4, 4, 5, 5, 6, 6}));
      EXPECT_EQ(dropped.size(), 3u);  // vertices, lines, the point field
      const auto fields = read_vtk_surface_with_fields(surface_file(binary, offsets), "f");
      ASSERT_TRUE(fields);
      ASSERT_EQ(fields->point_fields.size(), 1u);
      EXPECT_EQ(fields->point_fields[0].values, (std::vector<double>{1, 2, 3, 4, 5}));
    }
}

TEST(VtkSurface, FlatCellsOfAGrid) {
  const std::string grid = File(false)
                               .line("POINTS 5 float")
                               .numbers<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1})
                               .line("CELLS 3 14")
                               .numbers<std::int32_t>({4, 0, 1, 2, 3, 3, 0, 1, 4, 4, 0, 1, 3, 2})
                               .line("CELL_TYPES 3")
                               .numbers<std::int32_t>({8, 5, 9})
                               .text();
  // The points of a pixel are in row order.
  EXPECT_EQ(read_vtk_surface(grid, "f", nullptr).triangles,
            (std::vector<Triangle>{{0, 1, 3}, {0, 3, 2}, {0, 1, 4}, {0, 1, 3}, {0, 3, 2}}));
}

TEST(VtkSurface, OfSomethingElse) {
  const auto surface = [](std::string_view bytes, const std::string& name) {
    return read_vtk_surface(bytes, name, nullptr);
  };
  const std::string tets = File(false)
                               .line("POINTS 4 float")
                               .numbers<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1})
                               .line("CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10")
                               .text();
  expect_input_error(surface, tets, "1 tets", "simplify");
  EXPECT_FALSE(read_vtk_surface_with_fields(tets, "f"));
  expect_input_error(surface, replaced(tets, "\n10", "\n12"), "hexahedr");
  expect_input_error(surface, replaced(tets, "UNSTRUCTURED_GRID", "RECTILINEAR_GRID"), "POLYDATA");
  const std::string good = surface_file(false, false);
  expect_input_error(surface, replaced(good, "3 0 2 1", "3 0 2 7"), "point 7 of 5");
  for (std::size_t n = 0; n + 40 < good.size(); n += 3) try {
      EXPECT_FALSE(surface(good.substr(0, n), "f").triangles.empty());  // an entire section may be missing
    } catch (const InputError&) {
    }
}

}  // namespace
}  // namespace tetwright::vtk_test
