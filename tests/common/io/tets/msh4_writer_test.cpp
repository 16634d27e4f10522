// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "common/io/tets/msh.h"
#include "common/samples/samples.h"
#include "tests/common/io/expect_error.h"
#include "tests/common/io/round_trip.h"
#include "tests/common/io/tricky_meshes.h"

namespace tetwright::msh4_writer_test {
namespace {

constexpr auto writers = {write_msh41, write_msh41_binary};

TEST(Msh4Writer, RoundTripKeepsEveryBitAndTheOrder) {
  for (const auto write : writers) {
    const TetMesh mesh = tricky_tets();
    const ReadTetMesh back = read_msh(text_of(write, mesh), "f");
    EXPECT_TRUE(same_bits(back.mesh.points, mesh.points));
    EXPECT_EQ(back.mesh.tets, mesh.tets);
    EXPECT_EQ(back.mesh.materials, mesh.materials);  // including those that cannot be group numbers
    EXPECT_EQ(back.mesh.material_names, mesh.material_names);
    EXPECT_EQ(back.material_field, "gmsh:physical");
    EXPECT_EQ(text_of(write, back.mesh), text_of(write, mesh));
  }
}

TEST(Msh4Writer, SurfacesAndFields) {
  for (const auto write : writers) {
    TetMesh mesh = mesh_with_surfaces();
    mesh.point_fields = {{"t", 1, false, {1, 2.5, 1e-300, 4, 5}},
                         {"u", 3, false, std::vector<double>(15, 0.1)}};
    mesh.cell_fields = {{"id", 1, false, {10, 20}}};
    const ReadTetMesh back = read_msh(text_of(write, mesh), "f");
    EXPECT_EQ(back.mesh.tets, mesh.tets);
    EXPECT_EQ(back.mesh.materials, mesh.materials);
    EXPECT_EQ(back.mesh.patch_groups,
              (std::map<InterfacePatch, SurfaceRegion>{{{{1, std::nullopt}, 1}, {5, "outlet"}}}));
    EXPECT_EQ(back.mesh.point_fields, mesh.point_fields);
    EXPECT_EQ(back.mesh.cell_fields, mesh.cell_fields);
    EXPECT_EQ(text_of(write, read_msh(text_of(write, back.mesh), "f").mesh), text_of(write, back.mesh));
  }
}

TEST(Msh4Writer, EntitiesAreBoundedByTheirSurfaces) {
  const std::string text = text_of(write_msh41, mesh_with_surfaces());
  // Two volumes; material -7 is group 2. The normals of the surface between them point out of it and into the
  // other one.
  EXPECT_NE(text.find("$Comments\ntetwright material: 2 -7\n$EndComments\n"), std::string::npos) << text;
  EXPECT_NE(text.find("$Entities\n0 0 4 2\n"), std::string::npos) << text;
  EXPECT_NE(text.find(" 1 1 3 -2 3 5\n"), std::string::npos) << text;
  EXPECT_NE(text.find(" 1 2 2 1 2\n"), std::string::npos) << text;
}

TEST(Msh4Writer, TenNodes) {
  const TetMesh mesh = mesh_with_surfaces();
  const MidsideNodes midside = straight_midside_nodes(mesh);
  for (const auto write : writers) {
    const ReadTetMesh back = read_msh(text_of(write, {mesh, &midside}), "f");
    EXPECT_EQ(back.mesh.points, mesh.points);
    EXPECT_EQ(back.mesh.tets, mesh.tets);
    EXPECT_EQ(back.mesh.patch_groups.size(), 1u);
  }
  // Gmsh's order: edges 01 12 02 03 23 13.
  EXPECT_NE(text_of(write_msh41, {mesh, &midside}).find("\n1 1 2 3 4 6 10 7 8 13 11\n"), std::string::npos);
  EXPECT_NE(write_msh({mesh, &midside}).find("\n1 11 2 1 2 1 2 3 4 6 10 7 8 13 11\n"), std::string::npos);
  EXPECT_EQ(read_msh(write_msh({mesh, &midside}), "f").mesh.tets, mesh.tets);
}

TEST(Msh4Writer, CutBinaryFilesAreErrors) {
  TetMesh mesh = mesh_with_surfaces();
  mesh.point_fields = {{"t", 1, false, {1, 2, 3, 4, 5}}};
  const std::string whole = text_of(write_msh41_binary, mesh);
  for (std::size_t n = 0; n + 1 < whole.size(); ++n) {
    // The section that starts with $Elements may be missing entirely.
    if (whole.compare(0, n, whole, 0, n) == 0 && n == whole.find("$EndElements") + 12) continue;
    if (n == whole.find("$EndElements") + 13) continue;
    (void)error_of<InputError>([&] { (void)read_msh(whole.substr(0, n), "f"); });
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0xff);
    try {
      (void)read_msh(damaged, "f");
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace tetwright::msh4_writer_test
