// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/vtu.h"

#include <lz4.h>
#include <lzma.h>
#include <zlib.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "common/io/encodings/base64.h"
#include "tests/common/io/expect_error.h"
#include "tests/common/io/same_values.h"
#include "tests/common/io/tricky_meshes.h"
#include "tetwright/resources.h"

namespace tetwright::vtu_test {
namespace {

// Builds a file with a triangle and a tet in any encoding of VTK.
struct Encoding {
  std::string format = "binary";  ///< ascii, binary, base64 or raw (the last two are appended)
  std::string compressor = {};    ///< "ZLib", "LZ4", "LZMA"; empty: none
  bool wide = false;
  bool big = false;
};

struct Array {
  std::string type, name, more, ascii, bytes;
};

template <class Number>
Array array(const std::string& type, const std::string& name, const std::vector<Number>& values, bool big,
            const std::string& more = "") {
  Array a{type, name, more, "", ""};
  for (Number v : values) {
    a.ascii += std::to_string(v) + " ";
    std::string bytes(reinterpret_cast<const char*>(&v), sizeof(v));
    if (big) std::reverse(bytes.begin(), bytes.end());
    a.bytes += bytes;
  }
  return a;
}

std::string packed_block(const std::string& bytes, const std::string& compressor) {
  std::string packed(1000, '\0');
  std::size_t size = 0;
  if (compressor == "ZLib") {
    uLongf n = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &n, reinterpret_cast<const Bytef*>(bytes.data()),
             bytes.size());
    size = n;
  } else if (compressor == "LZ4") {
    size = static_cast<std::size_t>(LZ4_compress_default(
        bytes.data(), packed.data(), static_cast<int>(bytes.size()), static_cast<int>(packed.size())));
  } else {
    lzma_easy_buffer_encode(1, LZMA_CHECK_CRC32, nullptr, reinterpret_cast<const std::uint8_t*>(bytes.data()),
                            bytes.size(), reinterpret_cast<std::uint8_t*>(packed.data()), &size,
                            packed.size());
  }
  return packed.substr(0, size);
}

std::string encoded(const std::string& bytes, const Encoding& e) {
  const auto size = [&](std::uint64_t n) {
    std::string s(reinterpret_cast<const char*>(&n), e.wide ? 8 : 4);
    if (e.big) std::reverse(s.begin(), s.end());
    return s;
  };
  std::string header, data;
  if (!e.compressor.empty()) {
    constexpr std::size_t block = 13;  // several blocks, the last one partial; numbers cross them
    std::string sizes;
    std::size_t blocks = 0;
    for (std::size_t at = 0; at < bytes.size(); at += block, ++blocks) {
      const std::string packed = packed_block(bytes.substr(at, block), e.compressor);
      sizes += size(packed.size());
      data += packed;
    }
    header = size(blocks) + size(block) + size(bytes.size() % block) + sizes;
  } else {
    header = size(bytes.size());
    data = bytes;
  }
  if (e.format == "raw") return header + data;
  std::string out;
  if (!e.compressor.empty()) {
    append_base64(out, header);
    append_base64(out, data);
  } else {
    append_base64(out, header + data);
  }
  return out;
}

std::string file(const Encoding& e, const std::vector<Array>& points, const std::vector<Array>& cells,
                 const std::vector<Array>& cell_data) {
  std::string out =
      std::string(
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"") +
      (e.big ? "Big" : "Little") + "Endian\"" + (e.wide ? " header_type=\"UInt64\"" : "") +
      (e.compressor.empty() ? "" : " compressor=\"vtk" + e.compressor + "DataCompressor\"") +
      ">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"4\" NumberOfCells=\"2\">\n";
  std::string appended;
  const auto add = [&](const std::string& element, const std::vector<Array>& arrays) {
    out += "<" + element + ">\n";
    for (const Array& a : arrays) {
      out += "<DataArray type=\"" + a.type + "\" Name=\"" + a.name + "\" " + a.more + " format=\"";
      if (e.format == "ascii") {
        out += "ascii\">\n" + a.ascii + "\n</DataArray>\n";
      } else if (e.format == "binary") {
        out += "binary\">\n  " + encoded(a.bytes, e) + "\n</DataArray>\n";
      } else {
        out += "appended\" offset=\"" + std::to_string(appended.size()) + "\"/>\n";
        appended += encoded(a.bytes, e);
      }
    }
    out += "</" + element + ">\n";
  };
  add("PointData", {});
  add("CellData", cell_data);
  add("Points", points);
  add("Cells", cells);
  out += "</Piece>\n</UnstructuredGrid>\n";
  if (e.format == "base64" || e.format == "raw")
    out += "<AppendedData encoding=\"" + e.format + "\">\n _" + appended + "\n</AppendedData>\n";
  return out + "</VTKFile>\n";
}

std::vector<Array> some_points(bool big, const std::vector<float>& more = {}) {
  std::vector<float> xyz{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  xyz.insert(xyz.end(), more.begin(), more.end());
  return {array<float>("Float32", "Points", xyz, big, "NumberOfComponents=\"3\"")};
}
std::vector<Array> some_cells(bool big, std::int64_t last_point = 3, std::int32_t last_offset = 7) {
  return {array<std::int64_t>("Int64", "connectivity", {0, 1, 2, 0, 1, 2, last_point}, big),
          array<std::int32_t>("Int32", "offsets", {3, last_offset}, big),
          array<std::uint8_t>("UInt8", "types", {5, 10}, big)};
}
Array field(const std::string& name, std::int32_t value, bool big = false) {
  return array<std::int32_t>("Int32", name, {99, value}, big);
}

const Encoding ascii{.format = "ascii"};
std::string ascii_file(const std::vector<Array>& cell_data) {
  return file(ascii, some_points(false), some_cells(false), cell_data);
}
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST(Vtu, RoundTripKeepsEveryBitAndTheNames) {
  const TetMesh mesh = tricky_tets();
  const ReadTetMesh back = read_vtu(write_vtu(mesh), "f");
  EXPECT_TRUE(same_bits(back.mesh.points, mesh.points));
  EXPECT_EQ(back.mesh.tets, mesh.tets);
  EXPECT_EQ(back.mesh.materials, mesh.materials);
  EXPECT_EQ(back.mesh.material_names, mesh.material_names);
  EXPECT_EQ(back.material_field, "material");
}

TEST(Vtu, HasNoPlaceForInterfaceTriangles) {
  TetMesh mesh = tricky_tets();
  const std::string without = write_vtu(mesh);
  mesh.interfaces = {{{0, 1, 2}, 0, std::nullopt}};
  EXPECT_EQ(write_vtu(mesh), without);
}

/// A mesh whose arrays have several blocks.
TetMesh large_mesh() {
  TetMesh mesh;
  for (int i = 0; i < 40000; ++i) mesh.points.push_back(Vec3(i, 0.1 * i, 1.0 / (i + 1)));
  for (Index i = 0; i + 3 < 40000; ++i) {
    mesh.tets.push_back({i, i + 1, i + 2, i + 3});
    mesh.materials.push_back(static_cast<MaterialTag>(i % 5));
  }
  return mesh;
}

void expect_large_mesh(const std::string& bytes) {
  const TetMesh back = read_vtu(bytes, "f").mesh, mesh = large_mesh();
  EXPECT_TRUE(same_bits(back.points, mesh.points));
  EXPECT_EQ(back.tets, mesh.tets);
  EXPECT_EQ(back.materials, mesh.materials);
}

TEST(Vtu, LargeEnoughForSeveralBlocks) {
  std::string first;
  for (const unsigned threads : {1u, 3u}) {
    const ThreadLimit limit(threads);
    const std::string bytes = write_vtu(large_mesh());
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first);
    expect_large_mesh(bytes);
  }
}

TEST(Vtu, BlocksMayHaveLineBreaksAndDamageIsNamed) {
  const std::string good = write_vtu(large_mesh());
  const std::size_t cells = good.find("Name=\"connectivity\""), begin = good.find('\n', cells) + 1,
                    end = good.find('\n', begin);
  std::string broken = good;
  for (std::size_t at = end; at > begin + 200; at -= 200) broken.insert(at - 100, "\n  ");
  std::string damaged = good;
  damaged.replace(begin + (end - begin) / 2, 8, "AAAAAAAA");
  std::string first;
  for (const unsigned threads : {1u, 3u}) {
    const ThreadLimit limit(threads);
    expect_large_mesh(broken);
    const std::string error = error_of<InputError>([&] { (void)read_vtu(damaged, "f"); });
    EXPECT_NE(error.find("is damaged"), std::string::npos) << error;
    if (first.empty()) first = error;
    EXPECT_EQ(error, first);
  }
}

TEST(Vtu, ANumberOutOfRangeInALaterBlockIsNamed) {
  TetMesh mesh = large_mesh();
  mesh.tets[39990][2] = 50000;
  expect_input_error(read_vtu, write_vtu(mesh), "cell 39990 refers to point 50000 of 40000");
}

TEST(Vtu, ABlockThatIsShorterThanItsHeaderSaysIsDamaged) {
  const Encoding e{.compressor = "ZLib"};
  const Array points = some_points(false)[0];
  const std::string good = file(e, {points}, some_cells(false), {field("MaterialID", -7)});
  // One block of 36 bytes instead of 48; blocks of 36 and 0 bytes, of which the last may be larger.
  const std::string packed = packed_block(points.bytes.substr(0, 36), e.compressor);
  for (const std::uint32_t block_size : {36u, 0u}) {
    std::string header, payload;
    for (const std::uint32_t n : {1u, block_size, 48u, static_cast<std::uint32_t>(packed.size())})
      header.append(reinterpret_cast<const char*>(&n), sizeof n);
    append_base64(payload, header);
    append_base64(payload, packed);
    const std::string bad = replaced(good, encoded(points.bytes, e), payload);
    for (const unsigned threads : {1u, 3u}) {
      const ThreadLimit limit(threads);
      expect_input_error(read_vtu, bad, "block 0 of its compressed data is damaged");
    }
  }
}

TEST(Vtu, EveryEncoding) {
  for (const char* format : {"ascii", "binary", "base64", "raw"})
    for (const char* compressor : {"", "ZLib", "LZ4", "LZMA"})
      for (bool wide : {false, true})
        for (bool big : {false, true}) {
          const Encoding e{format, compressor, wide, big};
          const ReadTetMesh r =
              read_vtu(file(e, some_points(big), some_cells(big), {field("MaterialID", -7, big)}), "f");
          EXPECT_EQ(r.mesh.points[3], Vec3(0, 0, 1));
          EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}})) << format;
          EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{-7}));
          EXPECT_EQ(r.material_field, "MaterialID");
          EXPECT_EQ(r.dropped, (std::vector<Dropped>{{"triangles", 1}}));
        }
}

TEST(Vtu, WholeNumbersMayBeStoredAsFloats) {
  for (const char* format : {"ascii", "binary", "raw"}) {
    std::vector<Array> cells = some_cells(false);
    cells[2] = array<double>("Float64", "types", {5, 10}, false);
    const ReadTetMesh r = read_vtu(file({.format = format}, some_points(false), cells, {}), "f");
    EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}})) << format;
    cells[2] = array<double>("Float64", "types", {5, 10.5}, false);
    expect_input_error(read_vtu, file({.format = format}, some_points(false), cells, {}), "whole numbers",
                       "10.5");
  }
}

TEST(Vtu, OtherVolumeCellsAreRefusedByKindAndNumber) {
  for (const char* format : {"ascii", "binary", "raw"}) {
    const auto with_first = [&](std::uint8_t type) {
      std::vector<Array> cells = some_cells(false);
      cells[2] = array<std::uint8_t>("UInt8", "types", {type, 10}, false);
      return file({.format = format}, some_points(false), cells, {});
    };
    expect_input_error(read_vtu, with_first(12), "1 hexahedra, the first of them cell 0",
                       "convert them to tets");
    expect_input_error(read_vtu, with_first(13), "byte", "1 prisms");
    expect_input_error(read_vtu, with_first(24), "cell 0 is a tet of", "damaged");
    expect_input_error(read_vtu, with_first(26), "1 quadratic prisms", "Tetrahedralize");
    expect_input_error(read_vtu, with_first(200), "1 cells of the unknown type 200");
  }
}

TEST(Vtu, WhatIsDroppedIsNamed) {
  const std::string text =
      replaced(replaced(ascii_file({field("material", 3)}), "<Piece",
                        "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" "
                        "format=\"ascii\">1</DataArray></FieldData>\n<Piece"),
               "<CellData>", "<CellData><Array type=\"String\" Name=\"notes\" format=\"ascii\">1 2</Array>");
  EXPECT_EQ(read_vtu(text, "f").dropped,
            (std::vector<Dropped>{{"triangles", 1},
                                  {"arrays of the whole dataset (\"TimeValue\")", 1},
                                  {"arrays of text (\"notes\")", 1}}));
  // The array with the names of materials is read.
  EXPECT_TRUE(read_vtu(write_vtu(tricky_tets()), "f").dropped.empty());
}

TEST(Vtu, WhichFieldIsTheMaterial) {
  const Array real = array<float>("Float32", "stress", {1, 2}, false);
  const auto read = [](const std::vector<Array>& fields) { return read_vtu(ascii_file(fields), "f"); };
  EXPECT_EQ(read({field("attribute", 2), field("material", 3)}).mesh.materials[0], 3);
  EXPECT_EQ(read({field("gmsh:physical", 2), field("medit:ref", 4), real}).material_field, "medit:ref");
  EXPECT_EQ(read({real, field("region", 5)}).material_field, "region");
  EXPECT_EQ(read({real, field("region", 5)}).mesh.materials[0], 5);
  EXPECT_EQ(read({field("one", 5), field("two", 6)}).material_field, "");
  EXPECT_EQ(read({field("one", 5), field("two", 6)}).mesh.materials[0], 1);
  EXPECT_EQ(read({}).mesh.materials[0], 1);
  // Some filters of ParaView convert integers to floats; whole numbers are accepted.
  EXPECT_EQ(read_vtu(file({}, some_points(false), some_cells(false),
                          {array<double>("Float64", "material", {1, 6}, false)}),
                     "f")
                .mesh.materials[0],
            6);
}

TEST(Vtu, FieldsComeBack) {
  TetMesh mesh = tricky_tets();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  mesh.point_fields = {
      {"a <b> & \"c\"\n", 3, false, {0.1, -0.0, nan, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 1e300}},
      {"id", 1, true, {1, -2, 3, 4, 5}}};
  mesh.cell_fields = {{"material", 1, false, {0.5, 1, 2}},
                      {"big", 1, true, {0x1p53 - 1, 1 - 0x1p53, 0}},
                      {"big", 1, true, {0.5, 1, 2}}};  // marked as integer, but not whole
  const TetMesh back = read_vtu(write_vtu(mesh), "f").mesh;
  ASSERT_EQ(back.point_fields.size(), 2u);
  EXPECT_EQ(back.point_fields[0].name, "a <b> & \"c\"_");
  EXPECT_EQ(back.point_fields[0].components, 3);
  expect_same_values(back.point_fields[0].values, mesh.point_fields[0].values);
  EXPECT_EQ(back.point_fields[1], mesh.point_fields[1]);
  EXPECT_EQ(back.cell_fields, (std::vector<MeshField>{{"material_2", 1, false, {0.5, 1, 2}},
                                                      {"big", 1, true, {0x1p53 - 1, 1 - 0x1p53, 0}},
                                                      {"big_2", 1, false, {0.5, 1, 2}}}));
  EXPECT_EQ(back.materials, mesh.materials);
  // Small whole numbers are written as Int32, which every reader knows.
  EXPECT_NE(write_vtu(mesh).find("<DataArray type=\"Int32\" Name=\"id\""), std::string::npos);
  EXPECT_EQ(write_vtu(read_vtu(write_vtu(back), "f").mesh), write_vtu(back));
}

TEST(Vtu, FieldsOfTetsAmongOtherCells) {
  const TetMesh mesh = read_vtu(ascii_file({field("material", 3),
                                            array<double>("Float32", "stress", {1, 2, 3, 4, 5, 6}, false,
                                                          "NumberOfComponents=\"3\""),
                                            {"String", "text", "", "a b", ""}}),
                                "f")
                           .mesh;
  EXPECT_EQ(mesh.cell_fields, (std::vector<MeshField>{{"stress", 3, false, {4, 5, 6}}}));
}

TEST(Vtu, IntegersThatDoublesCannotHoldAreSaid) {
  const auto dropped = [](std::int64_t value) {
    return read_vtu(
               ascii_file({field("material", 3), array<std::int64_t>("Int64", "id", {value, value}, false)}),
               "f")
        .dropped;
  };
  const auto said = [&](std::int64_t value) {
    const std::vector<Dropped> all = dropped(value);
    return std::find(all.begin(), all.end(),
                     Dropped{"exact values of integers from 2^53 on in the field \"id\"", 1}) != all.end();
  };
  EXPECT_TRUE(said((1LL << 60) + 1));
  EXPECT_TRUE(said((1LL << 53) + 1));  // as a double 2^53
  EXPECT_FALSE(said((1LL << 53) - 1));
}

TEST(Vtu, FieldsThatDoNotFit) {
  const auto stress = [](const std::vector<double>& values, const std::string& more = "") {
    return ascii_file({field("material", 3), array<double>("Float64", "stress", values, false, more)});
  };
  expect_input_error(read_vtu, stress({1}), "\"stress\": 1 values, but 2", "byte");
  expect_input_error(read_vtu, stress({1, 2, 3}), "\"stress\": more than the 2", "byte");
  expect_input_error(read_vtu, stress({1, 2}, "NumberOfComponents=\"0\""), "NumberOfComponents is \"0\"");
  expect_input_error(read_vtu, stress({1, 2}, "NumberOfComponents=\"4000000000\""), "\"4000000000\"");
  expect_input_error(read_vtu, replaced(stress({1, 7}), "7.000000", "x"), "\"x\"", "\"stress\"");
}

TEST(Vtu, BadInput) {
  const std::string good = ascii_file({field("material", 1)});
  expect_input_error(read_vtu, "", "empty");
  expect_input_error(read_vtu, "no xml", "not XML");
  expect_input_error(read_vtu, "<html></html>", "VTKFile");
  expect_input_error(read_vtu, "<VTKFile", "byte", "not XML");
  expect_input_error(read_vtu, "<VTKFile type=\"UnstructuredGrid\"></VTKFile>",
                     "no element UnstructuredGrid");
  expect_input_error(read_vtu, replaced(good, "\"UnstructuredGrid\"", "\"PolyData\""), "\"PolyData\"",
                     "UnstructuredGrid");
  expect_input_error(read_vtu,
                     replaced(good, "byte_order", "compressor=\"vtkZstdDataCompressor\" byte_order"), "Zstd",
                     "zlib");
  expect_input_error(read_vtu, replaced(good, "NumberOfPoints=\"4\"", "NumberOfPoints=\"4000000000\""),
                     "12000000000");
  expect_input_error(read_vtu, replaced(good, "NumberOfPoints=\"4\"", "NumberOfPoints=\"5000000000\""),
                     "split");
  expect_input_error(read_vtu, replaced(good, "NumberOfCells=\"2\"", "NumberOfCells=\"4000000000\""),
                     "4000000000");
  expect_input_error(read_vtu, replaced(good, "NumberOfCells=\"2\"", "NumberOfCells=\"x\""), "\"x\"");
  expect_input_error(read_vtu, replaced(good, "1.000000", "nan"), "byte", "not finite");
  expect_input_error(read_vtu, replaced(good, "1.000000", "one"), "\"one\"", "\"Points\"");
  expect_input_error(read_vtu, replaced(good, "Name=\"types\"", "Name=\"kinds\""), "\"types\"");
  expect_input_error(read_vtu, file(ascii, some_points(false), some_cells(false, 4), {}), "point 4",
                     "connectivity");
  expect_input_error(read_vtu, file(ascii, some_points(false), some_cells(false, -1), {}), "is -1",
                     "connectivity");
  expect_input_error(read_vtu, file(ascii, some_points(false), some_cells(false, 3, 6), {}),
                     "more than the 6");
  expect_input_error(read_vtu, file(ascii, some_points(false), some_cells(false, 3, 2), {}), "connectivity");
  expect_input_error(read_vtu, file(ascii, some_points(false, {1, 2, 3}), some_cells(false), {}),
                     "12 values");
  expect_input_error(read_vtu, replaced(good, "5 10", "5 5"), "no tets");
  expect_input_error(read_vtu, ascii_file({array<std::int64_t>("Int64", "material", {0, 1LL << 40}, false)}),
                     "32 bits");
  expect_input_error(read_vtu,
                     file({}, some_points(false), some_cells(false),
                          {array<double>("Float64", "material", {1, 6.5}, false)}),
                     "6.5");
}

TEST(Vtu, BinaryCutShortOrDamaged) {
  for (const char* format : {"binary", "base64", "raw"})
    for (const char* compressor : {"", "ZLib", "LZ4", "LZMA"}) {
      const Encoding e{.format = format, .compressor = compressor};
      const std::string good = file(e, some_points(false), some_cells(false), {field("material", 1)});
      const std::string end = format == std::string("binary") ? "</Piece>" : "</AppendedData>";
      const std::size_t whole = good.find(end) - (format == std::string("binary") ? 30 : 1);
      for (std::size_t n = 0; n < whole; n += 3)
        (void)error_of<InputError>([&] { (void)read_vtu(good.substr(0, n), "f"); });
      // The largest sizes that a header can claim.
      std::string promise = good;
      const std::size_t data =
          format == std::string("binary") ? promise.find("\">\n  ") + 5 : promise.find(" _") + 2;
      promise.replace(data, 8, format == std::string("raw") ? std::string(8, '\xff') : "////////");
      (void)error_of<InputError>([&] { (void)read_vtu(promise, "f"); });
    }
}

}  // namespace
}  // namespace tetwright::vtu_test
