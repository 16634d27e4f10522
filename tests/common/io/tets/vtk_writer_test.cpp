// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "common/io/tets/vtk.h"
#include "common/io/tets/vtu.h"
#include "tests/common/io/round_trip.h"
#include "tests/common/io/tricky_meshes.h"

namespace tetwright::vtk_writer_test {
namespace {

TEST(VtkWriter, RoundTripKeepsEveryBit) {
  TetMesh mesh = tricky_tets();
  const ReadTetMesh back = read_vtk(text_of(write_vtk, mesh), "f");
  EXPECT_TRUE(same_bits(back.mesh.points, mesh.points));
  EXPECT_EQ(back.mesh.tets, mesh.tets);
  EXPECT_EQ(back.mesh.materials, mesh.materials);
  mesh.material_names[-2147483647 - 1] = "material_-2147483648";
  EXPECT_EQ(back.mesh.material_names, mesh.material_names);
  EXPECT_TRUE(back.dropped.empty());
}

TEST(VtkWriter, SurfacesAndFields) {
  TetMesh mesh = mesh_with_surfaces();
  mesh.point_fields = {{"a b%", 1, false, {1, 2.5, std::nan(""), 4, 5}},
                       {"u", 3, true, std::vector<double>(15, 7)}};
  mesh.cell_fields = {{"id", 1, true, {10, 20}}, {"x", 2, false, {0.5, 1, 2, 3}}};
  const ReadTetMesh back = read_vtk(text_of(write_vtk, mesh), "f");
  EXPECT_EQ(back.mesh.patch_groups,
            (std::map<InterfacePatch, SurfaceRegion>{{{{1, std::nullopt}, 1}, {5, "outlet"}}}));
  EXPECT_EQ(back.mesh.cell_fields, mesh.cell_fields);
  EXPECT_EQ(back.mesh.point_fields[1], mesh.point_fields[1]);
  EXPECT_EQ(back.mesh.point_fields[0].name, "a b%");
  EXPECT_TRUE(std::isnan(back.mesh.point_fields[0].values[2]));
  EXPECT_EQ(text_of(write_vtk, read_vtk(text_of(write_vtk, back.mesh), "f").mesh),
            text_of(write_vtk, back.mesh));
}

TEST(VtkWriter, TenNodesInBothFormats) {
  TetMesh mesh = mesh_with_surfaces();
  mesh.point_fields = {{"t", 1, false, {1, 2, 3, 4, 5}}};
  const MidsideNodes midside = straight_midside_nodes(mesh);
  const std::string text = text_of(write_vtk, {mesh, &midside});
  EXPECT_NE(text.find("\n10 0 1 2 3 5 9 6 7 10 12\n"), std::string::npos) << text;
  for (const ReadTetMesh& back : {read_vtk(text, "f"), read_vtu(write_vtu({mesh, &midside}), "f")}) {
    EXPECT_EQ(back.mesh.points, mesh.points);
    EXPECT_EQ(back.mesh.tets, mesh.tets);
    EXPECT_EQ(back.mesh.point_fields, mesh.point_fields);
    ASSERT_FALSE(back.dropped.empty());
    EXPECT_EQ(back.dropped[0].count, 9u);
  }
  EXPECT_EQ(read_vtk(text, "f").mesh.patch_groups.size(), 1u);
}

}  // namespace
}  // namespace tetwright::vtk_writer_test
