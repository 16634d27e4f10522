// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/obj.h"

#include "tests/common/io/expect_error.h"
#include "tests/common/io/tricky_meshes.h"

namespace tetwright::obj_test {
namespace {

const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, RoundTripKeepsEveryBit) {
  const TriangleMesh mesh = tricky_surface();
  const TriangleMesh back = read_obj(write_obj(mesh), "f");
  EXPECT_TRUE(same_bits(back.points, mesh.points));
  EXPECT_EQ(back.triangles, mesh.triangles);
}

TEST(Obj, AllFormsOfFaces) {
  const TriangleMesh mesh = read_obj("# Blender\nmtllib a.mtl\no Thing\n" + points +
                                         "vt 0 0\nvn 0 0 1\ns off\nusemtl Red\nf 1 2 3\nf 1/1 2/1 3/1\n"
                                         "f 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1\nf -4 -3 -2\nf 1 2 3 4\n",
                                     "f");
  const std::vector<Triangle> expected{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2},
                                       {0, 1, 2}, {0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(mesh.triangles, expected);
}

TEST(Obj, ColoursContinuedLinesAndOtherLineEnds) {
  const TriangleMesh mesh =
      read_obj("v 0 0 0 1 0.5 0\r\nv 1 0 0 1\rv 0 \\\r\n 1 0\nf 1 \\\n2 3\ng a b\nl 1 2\n", "f");
  EXPECT_EQ(mesh.points[2], Vec3(0, 1, 0));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Obj, WhatIsDroppedIsNamed) {
  std::vector<Dropped> dropped;
  (void)read_obj(
      "mtllib a.mtl\ns 1\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\ng a\nf 1 2 3\nl 1 \\\n2\nzap 3\n",
      "f", &dropped);
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"points with a weight or a colour", 1},
                                           {"texture coordinates", 2},
                                           {"lines", 1},
                                           {"statements \"zap\"", 1}}));
}

TEST(Obj, ObjectsGroupsAndMaterialsThatDifferAreGroups) {
  const std::string face = "f 1 2 3\n";
  const auto groups = [&](const std::string& text) { return read_obj(points + text, "f").groups; };
  EXPECT_TRUE(groups("o a\ng b\nusemtl c\n" + face + face).empty());
  EXPECT_EQ(groups("o a\ng b\n" + face + "g c d\n" + face),
            (std::vector<SurfaceRegion>{{0, "b"}, {0, "c d"}}));
  EXPECT_EQ(groups("o a\ng b\nusemtl m\n" + face + "o c\nusemtl n\n" + face),
            (std::vector<SurfaceRegion>{{0, "a:m"}, {0, "c:n"}}));
  // Different combinations may give the same joined name.
  expect_input_error(read_obj, points + "o A:b\ng c\n" + face + "o A\ng b:c\n" + face,
                     "o \"A:b\", g \"c\" and those of o \"A\", g \"b:c\"", "\"A:b:c\"");
  expect_input_error(read_obj, points + "g a\n" + face + "o a\ng\n" + face, "g \"a\" and those of o \"a\"");
  const TriangleMesh mesh = read_obj(points + face + "g a\n" + face + "g b\n" + face + "g a\n" + face, "f");
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{}, {0, "a"}, {0, "b"}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 1, 2, 1}));
}

TEST(Obj, FacesMayComeBeforeTheirPoints) {
  EXPECT_EQ(read_obj("f 1 2 3\n" + points, "f").triangles.size(), 1u);
}

TEST(Obj, BadInput) {
  expect_input_error(read_obj, "", "empty");
  expect_input_error(read_obj, points, "no triangles");
  expect_input_error(read_obj, points + "f 1 2 5\n", "line 5", "point 5");
  expect_input_error(read_obj, points + "f 1 2 0\n", "line 5", "counts from 1");
  expect_input_error(read_obj, points + "f 1 2 -5\n", "line 5", "point -5");
  expect_input_error(read_obj, points + "f 1 2 x/3\n", "line 5", "\"x/3\"");
  expect_input_error(read_obj, points + "f 1 2 99999999999999999999\n", "line 5", "99999");
  expect_input_error(read_obj, points + "f 1 2 4294967295\n", "line 5", "4294967295");
  expect_input_error(read_obj, points + "f 1 2\n", "line 5", "2 vertices");
  expect_input_error(read_obj, "v 0 0\n", "line 1", "fewer than three");
  expect_input_error(read_obj, "v 0 0 zero\n", "line 1", "\"zero\"");
  expect_input_error(read_obj, "v 0 0 0\nv 0 inf 0\n", "line 2", "not finite");
}

}  // namespace
}  // namespace tetwright::obj_test
