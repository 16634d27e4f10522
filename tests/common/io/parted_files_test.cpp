// SPDX-License-Identifier: Apache-2.0

// Parted interfaces in files: every format that holds names of faces reads back what it wrote.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "common/io/names/mesh_parts.h"
#include "common/io/tets/vtu.h"
#include "tests/common/temporary_folder.h"
#include "tests/simplify/meshes.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/parted_interfaces.h"
#include "tetwright/sheets.h"

namespace tetwright {
namespace {

/// Three materials, the third without a name, and a crack in the first one, in the plane x = 1.
TetMesh with_crack() {
  TetMesh mesh = grid_mesh({4, 3, 3}, [](int x, int y, int) {
    return std::optional<MaterialTag>(x < 2 ? 3 : y < 2 ? 8 : 20);
  });
  mesh.material_names = {{3, "hard bone"}, {8, "a:b"}};
  mesh.interfaces = find_interfaces(mesh);
  std::vector<InterfaceTriangle> crack;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size()))
    if (f.count == 2 &&
        std::all_of(f.ids.begin(), f.ids.end(), [&](Index p) { return mesh.points[p].x() == 1; }))
      crack.push_back({f.ids, 3, 3, 1});
  mesh.patch_groups[{{3, 3}, 1}] = {7, "crack 1"};
  append_sheets(mesh.interfaces, std::move(crack));
  MeshField field{"load", 1, false, {}};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) field.values.push_back(0.5 * static_cast<double>(t));
  mesh.cell_fields = {field};
  return mesh;
}

struct PartedFormat {
  const char* name;
  const char* file;
  const char* format;
  bool fields;
};
void PrintTo(const PartedFormat& f, std::ostream* out) { *out << f.name; }

class PartedFiles : public testing::TestWithParam<PartedFormat> {};
INSTANTIATE_TEST_SUITE_P(Formats, PartedFiles,
                         testing::Values(PartedFormat{"vtu", "m.vtu", "", true},
                                         PartedFormat{"msh22", "m.msh", "msh22", true},
                                         PartedFormat{"msh41", "m.msh", "msh41", true},
                                         PartedFormat{"msh41_binary", "m.msh", "msh41-binary", true},
                                         PartedFormat{"vtk", "m.vtk", "", true},
                                         PartedFormat{"abaqus", "m.inp", "", false},
                                         PartedFormat{"xdmf", "m.xdmf", "", true}),
                         [](const auto& f) { return f.param.name; });

/// Tets as they are in space.
std::multiset<std::array<std::array<double, 3>, 4>> in_space(const TetMesh& mesh) {
  std::multiset<std::array<std::array<double, 3>, 4>> out;
  for (const Tet& tet : mesh.tets) {
    std::array<std::array<double, 3>, 4> corners;
    for (std::size_t k = 0; k < 4; ++k)
      corners[k] = {mesh.points[tet[k]].x(), mesh.points[tet[k]].y(), mesh.points[tet[k]].z()};
    std::sort(corners.begin(), corners.end());
    out.insert(corners);
  }
  return out;
}

TEST_P(PartedFiles, ComeBackJoinedAsTheyWere) {
  const TetMesh whole = with_crack();
  TetMesh parted = whole;
  const auto sides = part_interfaces(
      parted, nullptr,
      std::vector{InterfaceToPart{std::pair(3, 8), {}, true}, InterfaceToPart{std::pair(8, 20), {}, false},
                  InterfaceToPart{{}, "crack 1", true}});
  ASSERT_EQ(sides.size(), 3u);
  const TemporaryFolder folder;
  const std::string path = folder / GetParam().file;
  write_tet_mesh(parted, path, nullptr, GetParam().format);
  ReadTetMesh read = read_tet_mesh(path);
  for (const Dropped& d : read.dropped) EXPECT_TRUE(d.restored) << d.what;
  EXPECT_EQ(read.mesh.points.size(), parted.points.size());
  EXPECT_EQ(read.mesh.wedges.size(), parted.wedges.size());
  // .inp lists the tets by material.
  EXPECT_EQ(std::multiset(read.mesh.materials.begin(), read.mesh.materials.end()),
            std::multiset(parted.materials.begin(), parted.materials.end()));
  for (const auto& [tag, name] : read.mesh.material_names)
    EXPECT_TRUE(tag == 3 || tag == 8 || tag == 20) << name;
  if (GetParam().fields) {
    ASSERT_EQ(read.mesh.cell_fields.size(), 1u);
    EXPECT_EQ(read.mesh.cell_fields[0].values, whole.cell_fields[0].values);
  }
  const JoinedInterfaces joined = join_parted_interfaces(read.mesh);
  EXPECT_EQ(joined.other_wedges, 0u);
  ASSERT_EQ(joined.parts.size(), 3u);
  EXPECT_EQ(read.mesh.points.size(), whole.points.size());
  EXPECT_EQ(in_space(read.mesh), in_space(whole));
  EXPECT_EQ(topology(read.mesh), topology(whole));
  for (const InterfaceToPart& part : joined.parts)
    EXPECT_EQ(part.cohesive, part.materials != std::pair(8, 20)) << part.group;
  // Written again, it is the same mesh.
  const auto again = part_interfaces(read.mesh, nullptr, joined.parts);
  ASSERT_EQ(again.size(), 3u);
  EXPECT_EQ(read.mesh.points.size(), parted.points.size());
  EXPECT_EQ(read.mesh.wedges.size(), parted.wedges.size());
}

/// A prism of volume is still refused.
TEST_P(PartedFiles, OtherPrismsAreRefused) {
  TetMesh mesh = with_crack();
  part_interfaces(mesh, nullptr, std::vector{InterfaceToPart{std::pair(3, 8), {}, true}});
  std::swap(mesh.wedges[0][4], mesh.wedges[0][5]);
  const TemporaryFolder folder;
  const std::string path = folder / GetParam().file;
  write_tet_mesh(mesh, path, nullptr, GetParam().format);
  try {
    (void)read_tet_mesh(path);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("only tets of 4 or 10 points can be read"), std::string::npos)
        << error.what();
  }
}

TEST(PartedFormats, TellWhetherTheyHoldWedges) {
  std::set<std::string> with;
  for (const TetFormatInfo& format : written_tet_formats())
    if (format.wedges) with.insert(format.extension);
  EXPECT_EQ(with, (std::set<std::string>{".vtu", ".msh", ".vtk", ".inp", ".xdmf"}));
}

// Names and numbers of cohesive elements differ from those of materials.
TEST(PartedFormats, CohesiveElementsHaveTheirOwnName) {
  TetMesh mesh = with_crack();
  part_interfaces(mesh, nullptr, std::vector{InterfaceToPart{std::pair(3, 8), {}, true}});
  mesh.material_names[20] = "hard bone|a:b";
  const MeshParts parts = mesh_parts(mesh, printable_names());
  const auto cohesive = cohesive_parts(mesh, parts.materials, printable_names());
  ASSERT_EQ(cohesive.size(), 1u);
  EXPECT_EQ(cohesive[0].name, "hard bone|a:b_2");
  EXPECT_EQ(cohesive[0].number, 21);
  EXPECT_EQ(cohesive[0].wedges.size(), mesh.wedges.size());
}

}  // namespace
}  // namespace tetwright
