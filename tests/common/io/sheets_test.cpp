// SPDX-License-Identifier: Apache-2.0

// Sheets in files: every format reads back the sheets that it wrote.
#include "tetwright/sheets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "common/io/names/mesh_parts.h"
#include "tests/common/temporary_folder.h"
#include "tests/simplify/meshes.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {
namespace {

constexpr int n = 4;

/// Two materials that meet at x = 2. A named sheet in the plane z = 2 lies in both; another one, at y = 1,
/// only in the second.
TetMesh with_sheets() {
  TetMesh mesh =
      grid_mesh({n, n, n}, [](int x, int, int) { return std::optional<MaterialTag>(x < 2 ? 3 : 8); });
  mesh.material_names = {{3, "water"}, {8, "air"}};
  mesh.interfaces = find_interfaces(mesh);
  std::vector<InterfaceTriangle> sheets;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size())) {
    if (f.count != 2 || mesh.materials[f.first] != mesh.materials[f.second]) continue;
    const MaterialTag tag = mesh.materials[f.first];
    const auto all = [&](int axis, double at) {
      return std::all_of(f.ids.begin(), f.ids.end(), [&](Index p) { return mesh.points[p][axis] == at; });
    };
    if (all(2, 2)) {
      sheets.push_back({f.ids, tag, tag, 1});
      mesh.patch_groups[{{tag, tag}, 1}] = {7, "baffle"};
    } else if (tag == 8 && all(1, 1)) {
      sheets.push_back({f.ids, tag, tag, 2});
      mesh.patch_groups[{{tag, tag}, 2}] = {9, "gauze"};
    }
  }
  append_sheets(mesh.interfaces, std::move(sheets));
  return mesh;
}

/// The corners of each sheet's triangles, by name and material, independent of the order of points.
using Corners = std::array<std::array<double, 3>, 3>;
std::map<std::string, std::set<Corners>> sheets_by_name(const TetMesh& mesh) {
  std::map<std::string, std::set<Corners>> out;
  for (const InterfaceTriangle& t : sheets_of(mesh)) {
    Corners corners;
    for (int k = 0; k < 3; ++k)
      for (int a = 0; a < 3; ++a) corners[k][a] = mesh.points[t.ids[k]][a];
    std::sort(corners.begin(), corners.end());
    out[mesh.patch_groups.at({t.pair(), t.patch}).name].insert(corners);
  }
  return out;
}

struct Format {
  const char* name;
  const char* file;
  const char* format;
};
void PrintTo(const Format& f, std::ostream* out) { *out << f.name; }

class SheetFiles : public testing::TestWithParam<Format> {};
INSTANTIATE_TEST_SUITE_P(Formats, SheetFiles,
                         testing::Values(Format{"vtu", "m.vtu", ""}, Format{"msh22", "m.msh", "msh22"},
                                         Format{"msh41", "m.msh", "msh41"},
                                         Format{"msh41_binary", "m.msh", "msh41-binary"},
                                         Format{"medit", "m.mesh", ""}, Format{"medit_binary", "m.meshb", ""},
                                         Format{"vtk", "m.vtk", ""}, Format{"abaqus", "m.inp", ""},
                                         Format{"nastran", "m.bdf", ""}, Format{"xdmf", "m.xdmf", ""},
                                         Format{"tetgen", "m.ele", ""}),
                         [](const auto& f) { return f.param.name; });

TEST_P(SheetFiles, AreReadBack) {
  const TetMesh mesh = with_sheets();
  for (const bool second_order : {false, true}) {
    const TemporaryFolder folder;
    if (second_order && !written_tet_format(folder / GetParam().file, GetParam().format).second_order) break;
    const MidsideNodes nodes = straight_midside_nodes(mesh);
    write_tet_mesh({mesh, second_order ? &nodes : nullptr}, folder / GetParam().file, nullptr,
                   GetParam().format);
    const TetMesh read = read_tet_mesh(folder / GetParam().file).mesh;
    EXPECT_TRUE(misplaced_sheet_faces(read).empty());
    const auto expected = sheets_by_name(mesh), found = sheets_by_name(read);
    const std::string name = GetParam().name;
    if (name == "medit_binary") {
      // The format has no names.
      EXPECT_EQ(sheets_of(read).size(), sheets_of(mesh).size());
    } else {
      EXPECT_EQ(found, expected);
    }
    // Written and read again, the file is the same.
    const TemporaryFolder again;
    write_tet_mesh({read, nullptr}, again / GetParam().file, nullptr, GetParam().format);
    EXPECT_EQ(sheets_of(read_tet_mesh(again / GetParam().file).mesh), sheets_of(read));
  }
}

TEST_P(SheetFiles, WithoutANameAreReadBack) {
  TetMesh mesh = with_sheets();
  mesh.patch_groups.clear();
  const TemporaryFolder folder;
  write_tet_mesh({mesh, nullptr}, folder / GetParam().file, nullptr, GetParam().format);
  EXPECT_EQ(sheets_of(read_tet_mesh(folder / GetParam().file).mesh).size(), sheets_of(mesh).size());
}

TEST(SheetFiles, ElementFacesOfASheetLieOnOneSide) {
  const TetMesh mesh = with_sheets();
  const std::vector<TetFace> faces = faces_of_tets(mesh);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Triangle& ids = mesh.interfaces[f].ids;
    const Vec3 &a = mesh.points[ids[0]], &b = mesh.points[ids[1]], &c = mesh.points[ids[2]];
    const Vec3& apex = mesh.points[mesh.tets[faces[f].tet][faces[f].face]];
    EXPECT_LT((b - a).cross(c - a).dot(apex - a), 0) << f;
  }
}

TEST(SheetFiles, GroupsOfAllFacesOfTetsAreNoSheets) {
  const TetMesh mesh = with_sheets();
  ReadTetMesh read;
  read.mesh = mesh;
  read.mesh.interfaces.clear();
  read.mesh.patch_groups.clear();
  FileTriangles listed;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size()))
    listed.add(f.ids, f.count == 1 ? 1 : mesh.materials[f.first] == mesh.materials[f.second] ? 2 : 3);
  take_triangles(listed, "reference", "m.mesh", read);
  EXPECT_TRUE(sheets_of(read.mesh).empty());
  ASSERT_FALSE(read.dropped.empty());
  const auto inside = std::find_if(read.dropped.begin(), read.dropped.end(), [](const Dropped& d) {
    return d.what == "triangles of references inside a material";
  });
  ASSERT_NE(inside, read.dropped.end());
  EXPECT_EQ(inside->count,
            static_cast<std::size_t>(std::count(listed.groups.begin(), listed.groups.end(), 2)));
}

TEST(SheetFiles, InnerTrianglesOfAGroupOfTheBoundaryAreDropped) {
  const TetMesh mesh = with_sheets();
  ReadTetMesh read;
  read.mesh = mesh;
  read.mesh.interfaces.clear();
  read.mesh.patch_groups.clear();
  FileTriangles listed;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (!t.other || t.patch == 1) listed.add(t.ids, 4);
  take_triangles(listed, "reference", "m.mesh", read);
  EXPECT_TRUE(sheets_of(read.mesh).empty());
  EXPECT_TRUE(std::any_of(read.dropped.begin(), read.dropped.end(), [](const Dropped& d) {
    return d.what == "triangles of references inside a material" && d.count == 2u * n * n;
  }));
}

TEST(SheetFiles, VtuWithoutSheetsHasOnlyTets) {
  TetMesh mesh = with_sheets();
  std::erase_if(mesh.interfaces, [](const InterfaceTriangle& t) { return t.is_sheet(); });
  TetMesh bare = mesh;
  bare.interfaces.clear();
  bare.patch_groups.clear();
  const TemporaryFolder folder;
  write_tet_mesh({mesh, nullptr}, folder / "a.vtu");
  write_tet_mesh({bare, nullptr}, folder / "b.vtu");
  EXPECT_EQ(contents(folder / "a.vtu"), contents(folder / "b.vtu"));
}

}  // namespace
}  // namespace tetwright
