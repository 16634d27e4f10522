// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/ply.h"

#include <algorithm>
#include <limits>

#include "tests/common/io/expect_error.h"
#include "tests/common/io/tricky_meshes.h"

namespace tetwright::ply_test {
namespace {

std::string header(const std::string& format, const std::string& points = "3",
                   const std::string& faces = "1") {
  return "ply\nformat " + format + " 1.0\ncomment c\nobj_info o\nelement vertex " + points +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}
const std::string body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

template <class Number>
void put(std::string& out, Number value, bool big) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof(value));
  if (big) std::reverse(bytes.begin(), bytes.end());
  out += bytes;
}

/// A file with further elements, properties and lists, which the reader must skip.
std::string rich_binary(bool big) {
  std::string out =
      std::string("ply\nformat binary_") + (big ? "big" : "little") +
      "_endian 1.0\nelement camera 1\nproperty double f\nproperty list uchar short s\n"
      "element vertex 4\nproperty uchar red\nproperty float y\nproperty double x\nproperty short z\n"
      "element face 2\nproperty list ushort uchar colours\nproperty list uchar uint vertex_index\n"
      "property int flags\nelement rest 7\nproperty int a\nend_header\n";
  put(out, 3.5, big);
  put(out, std::uint8_t{2}, big);
  put(out, std::int16_t{1}, big);
  put(out, std::int16_t{2}, big);
  for (int i = 0; i < 4; ++i) {
    put(out, std::uint8_t{255}, big);
    put(out, static_cast<float>(i), big);
    put(out, 0.1 * i, big);
    put(out, static_cast<std::int16_t>(-i), big);
  }
  for (std::uint32_t n : {3u, 4u}) {
    put(out, std::uint16_t{2}, big);
    out += "xy";
    put(out, static_cast<std::uint8_t>(n), big);
    for (std::uint32_t i = 0; i < n; ++i) put(out, i, big);
    put(out, std::int32_t{9}, big);
  }
  return out;
}

TEST(Ply, RoundTripKeepsEveryBit) {
  const TriangleMesh mesh = tricky_surface();
  const TriangleMesh back = read_ply(write_ply(mesh), "f");
  EXPECT_TRUE(same_bits(back.points, mesh.points));
  EXPECT_EQ(back.triangles, mesh.triangles);
}

TEST(Ply, Ascii) {
  const TriangleMesh mesh = read_ply(header("ascii") + body, "f");
  EXPECT_EQ(mesh.points[1], Vec3(1, 0, 0));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Ply, BinaryOfBothByteOrdersWithMoreInIt) {
  for (bool big : {false, true}) {
    const TriangleMesh mesh = read_ply(rich_binary(big), "f");
    EXPECT_EQ(mesh.points[3], Vec3(0.1 * 3, 3, -3));
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}}));
  }
}

TEST(Ply, PropertiesOfPointsAreFields) {
  for (bool big : {false, true}) {
    const SurfaceWithFields read = read_ply_with_fields(rich_binary(big), "f");
    EXPECT_EQ(read.surface.points[3], Vec3(0.1 * 3, 3, -3));
    EXPECT_EQ(read.point_fields, (std::vector<MeshField>{{"red", 1, true, {255, 255, 255, 255}}}));
  }
  const std::string lists = "property float z\nproperty list uchar int l\nproperty double d\nproperty int i";
  std::string text = header("ascii") + "0 0 0 2 7 8 inf -3\n1 0 0 0 0.1 4\n0 1 0 1 9 1e400 5\n3 0 1 2\n";
  text.replace(text.find("property float z"), 16, lists);
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(read_ply_with_fields(text, "f").point_fields,
            (std::vector<MeshField>{{"d", 1, false, {inf, 0.1, inf}}, {"i", 1, true, {-3, 4, 5}}}));
  const auto read = [](std::string_view bytes, const char* name) { read_ply_with_fields(bytes, name); };
  text.replace(text.find("0.1"), 3, "0,1");
  expect_input_error(read, text, "line 16", "\"0,1\"");
  const std::string bytes = rich_binary(false);
  for (std::size_t n = 0; n < bytes.size(); ++n)
    (void)error_of<InputError>([&] { (void)read_ply_with_fields(bytes.substr(0, n), "f"); });
}

TEST(Ply, WhatIsDroppedIsNamed) {
  std::vector<Dropped> dropped;
  (void)read_ply(rich_binary(false), "f", &dropped);
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"items of element \"camera\"", 1},
                                           {"properties of element \"vertex\" (\"red\")", 1},
                                           {"properties of element \"face\" (\"colours\", \"flags\")", 2},
                                           {"items of element \"rest\"", 7}}));
  dropped.clear();
  (void)read_ply(header("ascii", "3", "2") + body + "2 0 1\n", "f", &dropped);
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"faces of fewer than three vertices", 1}}));
}

TEST(Ply, EveryCutIsAnError) {
  const std::string text = header("ascii") + body, bytes = rich_binary(false);
  for (std::size_t n = 0; n < text.size() - 2; ++n)
    (void)error_of<InputError>([&] { (void)read_ply(text.substr(0, n), "f"); });
  for (std::size_t n = 0; n < bytes.size(); ++n)
    (void)error_of<InputError>([&] { (void)read_ply(bytes.substr(0, n), "f"); });
}

TEST(Ply, BadInput) {
  expect_input_error(read_ply, "", "empty");
  expect_input_error(read_ply, "OFF\n", "line 1", "\"OFF\"");
  expect_input_error(read_ply, header("binary_mixed"), "line 2", "\"binary_mixed\"");
  expect_input_error(read_ply, header("ascii", "4000000000") + body, "4000000000", "bytes follow");
  expect_input_error(read_ply, header("ascii", "3", "4000000000") + body, "4000000000", "bytes follow");
  expect_input_error(read_ply, header("binary_little_endian", "18446744073709551615") + body, "line 5");
  expect_input_error(read_ply, header("binary_little_endian", "9223372036854775807") + body,
                     "9223372036854775807");
  expect_input_error(read_ply, header("ascii") + "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "line 13", "not finite");
  expect_input_error(read_ply, header("ascii") + "0 0 0\n1 0 q\n0 1 0\n3 0 1 2\n", "line 13", "\"q\"");
  expect_input_error(read_ply, header("ascii") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "line 15", "point 3");
  expect_input_error(read_ply, header("ascii") + "0 0 0\n1 0 0\n0 1 0\n999999 0 1 2\n", "999999",
                     "bytes follow");
  expect_input_error(read_ply, header("ascii", "3", "0") + body, "no triangles");
  expect_input_error(read_ply, "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n",
                     "line 3", "x, y or z");
  expect_input_error(read_ply, "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n", "line 4",
                     "\"quad\"");
  expect_input_error(
      read_ply,
      "ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n",
      "line 3", "strips");
  // Elements without properties take no bytes, whatever their count.
  expect_input_error(read_ply,
                     "ply\nformat ascii 1.0\nelement a 9000000000000000000\nelement vertex 0\nproperty float "
                     "x\nproperty float y\n"
                     "property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n",
                     "no triangles");
}

TEST(Ply, LabelsOfFacesAreGroups) {
  const auto text = [](const std::string& property, const std::string& second) {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 3\n" +
           property +
           "\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 4 0 1 2 3\n" +
           second + " 3 0 1 3\n3 3 1 2 3\n";
  };
  const TriangleMesh mesh = read_ply(text("property int patch_id", "7"), "f");
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{3, ""}, {7, ""}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 0, 1, 0}));
  EXPECT_TRUE(read_ply(text("property int patch_id", "3"), "f").groups.empty());
  for (const std::string& other :
       {std::string("property float patch_id"), std::string("property int flags")}) {
    std::vector<Dropped> dropped;
    EXPECT_TRUE(read_ply(text(other, "7"), "f", &dropped).groups.empty());
    ASSERT_EQ(dropped.size(), 1u);
  }
  expect_input_error(read_ply, text("property int label", "x"), "label of a face", "\"x\"");
  // Names are in comments, as written by write_ply(); two groups must not get the same name.
  const std::string named = "comment surface 7: in: let\ncomment surface 3: in: let\ncomment surface x: a\n";
  EXPECT_EQ(read_ply(text(named + "comment\nproperty int surface", "7"), "f").groups,
            (std::vector<SurfaceRegion>{{3, ""}, {7, "in: let"}}));
  EXPECT_EQ(read_ply(text(named + "property int patch_id", "7"), "f").groups,
            (std::vector<SurfaceRegion>{{3, ""}, {7, ""}}));
  const TriangleMesh back = read_ply(write_ply(mesh), "f");
  EXPECT_EQ(back.groups, (std::vector<SurfaceRegion>{{3, "3"}, {7, "7"}}));
}

}  // namespace
}  // namespace tetwright::ply_test
