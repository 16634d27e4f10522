// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/stl.h"

#include <cstring>

#include "common/samples/samples.h"
#include "tests/common/io/expect_error.h"
#include "tests/common/io/tricky_meshes.h"

namespace tetwright::stl_test {
namespace {

std::string binary(const std::string& title, const std::vector<std::array<float, 9>>& triangles) {
  std::string out = title;
  out.resize(80, ' ');
  const auto n = static_cast<std::uint32_t>(triangles.size());
  out.append(reinterpret_cast<const char*>(&n), 4);
  for (const auto& t : triangles) {
    out.append(12, '\0');
    out.append(reinterpret_cast<const char*>(t.data()), 36);
    out.append(2, '\0');
  }
  return out;
}

const std::string facet =
    "facet normal nan nan nan\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

TEST(Stl, RoundTripKeepsEveryBitAndMergesEqualPoints) {
  const TriangleMesh mesh = std::get<TriangleMesh>(make_sample("torus"));
  const TriangleMesh back = read_stl(write_stl(mesh), "f");
  ASSERT_EQ(back.points.size(), mesh.points.size());
  ASSERT_EQ(back.triangles.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(back.points[back.triangles[t][k]], mesh.points[mesh.triangles[t][k]]);
}

TEST(Stl, Binary) {
  const TriangleMesh mesh =
      read_stl(binary("made by", {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0, -0.0f, 1, 0}}), "f");
  EXPECT_EQ(mesh.points.size(), 4u);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
}

TEST(Stl, BinaryThatBeginsWithSolid) {
  const std::string bytes = binary("solid made by", {{0, 0, 0, 1, 0, 0, 0, 1, 0}});
  EXPECT_EQ(read_stl(bytes, "f").triangles.size(), 1u);
  EXPECT_EQ(read_stl(bytes + "more", "f").triangles.size(), 1u);
  expect_input_error(read_stl, bytes.substr(0, bytes.size() - 1), "byte 80", "truncated");
}

TEST(Stl, WhatIsDroppedIsNamed) {
  std::vector<Dropped> dropped;
  std::string bytes = binary("", {{0, 0, 0, 1, 0, 0, 0, 1, 0}});
  bytes.back() = 1;
  (void)read_stl(bytes + "more", "f", &dropped);
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"triangles with attribute bytes", 1},
                                           {"bytes after the last triangle", 4}}));
}

TEST(Stl, SolidsAreGroups) {
  const auto solid = [](const std::string& name) { return "solid" + name + "\n" + facet + "endsolid\n"; };
  const TriangleMesh mesh = read_stl(solid(" a b ") + solid("") + solid(" c"), "f");
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{0, "a b"}, {2, ""}, {0, "c"}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_TRUE(read_stl(solid(" a"), "f").groups.empty());  // a single solid
  expect_input_error(read_stl, solid(" a") + solid(" b") + solid(" a"), "\"a\"", "another name");
}

TEST(Stl, SeveralSolidsInAnyCase) {
  EXPECT_EQ(
      read_stl("solid a facet of it\n" + facet + "endsolid a facet of it\nSOLID\n" + facet + "ENDSOLID", "f")
          .triangles.size(),
      2u);
}

TEST(Stl, BadInput) {
  expect_input_error(read_stl, "", "empty");
  expect_input_error(read_stl, "nothing", "7 bytes", "truncated");
  expect_input_error(read_stl, "solid a\n" + facet, "line 9", "truncated");
  expect_input_error(read_stl, "solid a\n" + facet.substr(0, 60), "line 5", "truncated");
  expect_input_error(read_stl, "solid a\nendsolid a\n", "no triangles");
  expect_input_error(read_stl, "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf\n", "line 4",
                     "not finite");
  expect_input_error(read_stl, "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n", "line 4", "\"x\"");
  expect_input_error(read_stl, "solid a\nfacet normal 0 0 1\nouter loop\nendloop\n", "line 4", "\"vertex\"");
  expect_input_error(read_stl, binary("", {}), "no triangles");
  std::string promise = binary("", {});
  std::memset(promise.data() + 80, 0xff, 4);
  expect_input_error(read_stl, promise, "byte 80", "4294967295 triangles");
  expect_input_error(read_stl, binary("", {{0, 0, 0, 1, 0, NAN, 0, 1, 0}}), "byte 108", "not finite");
}

}  // namespace
}  // namespace tetwright::stl_test
