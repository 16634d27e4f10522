// SPDX-License-Identifier: Apache-2.0
#include "tetwright/sheets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/simplify/meshes.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {
namespace {

constexpr int n = 4;

/// The cube [0, 4]^3 with the faces in the plane z = 2 whose centroids satisfy `on`.
template <class On>
TetMesh cube_with(const On& on) {
  TetMesh mesh = grid_mesh(n);
  mesh.interfaces = find_interfaces(mesh);
  std::vector<InterfaceTriangle> sheet;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size())) {
    if (f.count != 2) continue;
    const Vec3 centre = (mesh.points[f.ids[0]] + mesh.points[f.ids[1]] + mesh.points[f.ids[2]]) / 3;
    const bool flat =
        std::all_of(f.ids.begin(), f.ids.end(), [&](Index p) { return mesh.points[p].z() == 2; });
    if (flat && on(centre)) sheet.push_back({f.ids, 1, 1});
  }
  append_sheets(mesh.interfaces, std::move(sheet));
  return mesh;
}

TetMesh cube_with_plane() {
  return cube_with([](const Vec3&) { return true; });
}

TEST(Sheets, AreNotFoundByFindInterfaces) {
  const TetMesh mesh = cube_with_plane();
  EXPECT_EQ(sheets_of(mesh).size(), 2u * n * n);
  EXPECT_EQ(find_interfaces(mesh).size() + 2 * n * n, mesh.interfaces.size());
  EXPECT_EQ(interfaces_with_sheets(mesh), mesh.interfaces);
}

TEST(Sheets, AreOrientedAlikeWhateverTheOrder) {
  const TetMesh mesh = cube_with_plane();
  std::vector<InterfaceTriangle> turned = sheets_of(mesh);
  std::reverse(turned.begin(), turned.end());
  for (std::size_t i = 0; i < turned.size(); i += 3) std::swap(turned[i].ids[0], turned[i].ids[2]);
  std::vector<InterfaceTriangle> again;
  append_sheets(again, turned);
  EXPECT_EQ(again, sheets_of(mesh));
  std::set<bool> up;
  for (const InterfaceTriangle& t : again)
    up.insert((mesh.points[t.ids[1]] - mesh.points[t.ids[0]])
                  .cross(mesh.points[t.ids[2]] - mesh.points[t.ids[0]])
                  .z() > 0);
  EXPECT_EQ(up.size(), 1u);
}

TEST(Sheets, HaveAreaPiecesAndBorders) {
  // A square with a hole, and a square that touches it in a point.
  TetMesh mesh = cube_with([](const Vec3& c) {
    const bool ring = c.x() < 3 && c.y() < 3 && !(c.x() > 1 && c.x() < 2 && c.y() > 1 && c.y() < 2);
    return ring || (c.x() > 3 && c.y() > 3);
  });
  mesh.patch_groups[{{1, 1}, 0}] = {4, "gauze"};
  const std::vector<SheetStatistics> all = sheet_statistics(mesh);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].name, "gauze");
  EXPECT_EQ(all[0].triangles, 18u);
  EXPECT_DOUBLE_EQ(all[0].area, 9);
  EXPECT_EQ(all[0].pieces, 2u);
  EXPECT_EQ(all[0].euler, 0);
  EXPECT_DOUBLE_EQ(all[0].border_length, 12 + 4 + 4);
  EXPECT_EQ(all[0].border_pieces, 2u);
}

TEST(Sheets, WithoutANameAreCalledByTheirMaterial) {
  TetMesh mesh = cube_with_plane();
  EXPECT_EQ(sheet_statistics(mesh).at(0).name, "1|1");
  mesh.material_names[1] = "water";
  EXPECT_EQ(sheet_statistics(mesh).at(0).name, "water|water");
  mesh.patch_groups[{{1, 1}, 0}] = {12, ""};
  EXPECT_EQ(sheet_statistics(mesh).at(0).name, "12");
}

TEST(Sheets, CountInStatisticsAndTopologyApartFromInterfaces) {
  const TetMesh mesh = cube_with_plane();
  const MeshStatistics statistics = mesh_statistics(mesh);
  ASSERT_EQ(statistics.interfaces.size(), 1u);
  EXPECT_FALSE(statistics.interfaces.begin()->first.second);
  ASSERT_EQ(statistics.sheets.size(), 1u);
  EXPECT_EQ(statistics.junction_edges, 4u * n);
  const Topology with = topology(mesh);
  EXPECT_EQ(with.sheets.at("1|1").euler, 1);
  TetMesh without = mesh;
  without.interfaces = find_interfaces(without);
  EXPECT_EQ(topology_differences(with, topology(without)),
            std::vector<std::string>{"sheet 1|1: before components 1, euler 1; after missing"});
}

TEST(Sheets, OutsideTheirMaterialAreFound) {
  TetMesh mesh = cube_with_plane();
  EXPECT_TRUE(misplaced_sheet_faces(mesh).empty());
  EXPECT_TRUE(check_mesh(mesh).empty());
  const std::size_t first = mesh.interfaces.size();
  InterfaceTriangle on_boundary = mesh.interfaces.front();
  on_boundary.other = on_boundary.material;
  mesh.interfaces.push_back(on_boundary);
  mesh.interfaces.push_back(mesh.interfaces[first - 1]);  // listed twice
  mesh.interfaces.push_back({{0, 1, 0xffffff}, 1, 1});    // no such point
  InterfaceTriangle of_other = sheets_of(mesh).front();
  of_other.material = 2;
  of_other.other = 2;
  mesh.interfaces.push_back(of_other);
  EXPECT_EQ(misplaced_sheet_faces(mesh), (std::vector<std::size_t>{first, first + 1, first + 2, first + 3}));
  const std::vector<MeshFinding> findings = check_mesh(mesh);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, DiagnosticCode::sheet_faces_misplaced);
  EXPECT_EQ(findings[0].count, 4u);
  EXPECT_TRUE(findings[0].places.at(0).at);
}

TEST(Sheets, SurviveTheRepairOfOtherProgramsMeshes) {
  TetMesh mesh = cube_with_plane();
  mesh.patch_groups[{{1, 1}, 0}] = {4, "gauze"};
  const std::vector<InterfaceTriangle> before = sheets_of(mesh);
  std::swap(mesh.tets[5][0], mesh.tets[5][1]);
  const ImportCleanupReport report = make_coherent(mesh);
  EXPECT_EQ(report.turned_tets, 1u);
  EXPECT_EQ(report.lost_faces, 0u);
  EXPECT_EQ(sheets_of(mesh), before);
  EXPECT_EQ(sheet_statistics(mesh).at(0).name, "gauze");
}

TEST(Sheets, KeepTheirNamesWhenPatchesAreFound) {
  TetMesh mesh = cube_with_plane();
  mesh.patch_groups[{{1, 1}, 0}] = {4, "gauze"};
  find_mesh_patches(mesh, {}, "mesh");
  ASSERT_EQ(sheet_statistics(mesh).size(), 1u);
  EXPECT_EQ(sheet_statistics(mesh)[0].name, "gauze");
  EXPECT_EQ(sheet_statistics(mesh)[0].triangles, 2u * n * n);
}

}  // namespace
}  // namespace tetwright
