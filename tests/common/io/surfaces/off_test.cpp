// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/off.h"

#include "tests/common/io/expect_error.h"
#include "tests/common/io/tricky_meshes.h"

namespace tetwright::off_test {
namespace {

const char* const plain = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 2 3\n";

TEST(Off, RoundTripKeepsEveryBit) {
  const TriangleMesh mesh = tricky_surface();
  const TriangleMesh back = read_off(write_off(mesh), "f");
  EXPECT_TRUE(same_bits(back.points, mesh.points));
  EXPECT_EQ(back.triangles, mesh.triangles);
}

TEST(Off, Plain) {
  const TriangleMesh mesh = read_off(plain, "f");
  EXPECT_EQ(mesh.points.size(), 4u);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Off, CommentsWindowsLineEndsAndColoursOfFaces) {
  const TriangleMesh mesh = read_off(
      "# made by\r\nOFF # keyword\r\n4 1 0\r\n\r\n0 0 0\r\n1 0 0 # here\r\n1 1 0\r\n0 1 0\r\n4 0 1 2 3 255 0 "
      "0\r\n",
      "f");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Off, ColoursAndNormalsOfPointsAreSkipped) {
  for (const char* keyword : {"COFF", "NOFF", "STOFF", "CNOFF"}) {
    const TriangleMesh mesh = read_off(
        std::string(keyword) + "\n3 1 0\n0 0 0 9 9 9 9\n1 0 0 9 9 9 9\n0 1 0 9 9 9 9\n3 0 1 2\n", "f");
    EXPECT_EQ(mesh.points[1], Vec3(1, 0, 0));
  }
}

TEST(Off, CountsBesideOrWithoutTheKeyword) {
  EXPECT_EQ(read_off("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "f").triangles.size(), 1u);
  EXPECT_EQ(read_off("3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2", "f").triangles.size(), 1u);
}

TEST(Off, WhatIsDroppedIsNamed) {
  std::vector<Dropped> dropped;
  EXPECT_EQ(read_off("COFF\n3 2 0\n0 0 0 9\n1 0 0 9\n0 1 0 9\n2 0 1\n3 0 1 2 255 0 0\n", "f", &dropped)
                .triangles.size(),
            1u);
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"points with colours, normals or texture coordinates", 3},
                                           {"faces of fewer than three vertices", 1},
                                           {"faces with colours", 1}}));
}

TEST(Off, BadInput) {
  expect_input_error(read_off, "", "line 1", "empty");
  expect_input_error(read_off, "solid x", "\"solid\"", "OFF");
  expect_input_error(read_off, "4OFF\n1 1 0\n", "\"4OFF\"", "three-dimensional");
  expect_input_error(read_off, "OFF BINARY\n", "binary", "ASCII");
  expect_input_error(read_off, "OFF\n4000000000 2 0\n0 0 0\n", "4000000000", "bytes follow");
  expect_input_error(read_off, "OFF\n3 4000000000 0\n0 0 0\n", "line 2", "4000000000");
  expect_input_error(read_off, "OFF\n-3 1 0\n", "line 2", "\"-3\"");
  expect_input_error(read_off, "OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "line 4", "not finite");
  expect_input_error(read_off, "OFF\n3 1 0\n0 0 0\n1 0 1e999\n0 1 0\n3 0 1 2\n", "line 4", "not finite");
  expect_input_error(read_off, "OFF\n3 1 0\n0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n", "line 4", "\"x\"");
  expect_input_error(read_off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "line 6", "point 3");
  expect_input_error(read_off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "line 6", "point -1");
  expect_input_error(read_off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "truncated");
  expect_input_error(read_off, "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "no triangles");
}

TEST(Off, WhatIsQuotedIsTamed) {
  expect_input_error(read_off, "OFF\n1 1 0\n0 0 \x1b[31m\n", "\"?[31m\"");
  expect_input_error(read_off, "OFF\n1 1 0\n0 0 " + std::string(5000, 'x') + "\n",
                     std::string(40, 'x') + "...");
}

TEST(Off, EveryCutIsAnErrorOrASurface) {
  const std::string text = plain;
  for (std::size_t n = 0; n < text.size() - 4; ++n)
    (void)error_of<InputError>([&] { (void)read_off(text.substr(0, n), "f"); });
}

}  // namespace
}  // namespace tetwright::off_test
