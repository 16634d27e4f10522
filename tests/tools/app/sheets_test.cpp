// SPDX-License-Identifier: Apache-2.0

// Tests sheets, from file to file.
#include "tetwright/sheets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/simplify/meshes.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::sheets_test {
namespace {

constexpr int n = 12;

/// Writes a box with the sheet "baffle", the square [3, 9]^2 in the plane z = 6.
void write_box(const std::string& file) {
  TetMesh mesh = grid_mesh(n);
  mesh.interfaces = find_interfaces(mesh);
  std::vector<InterfaceTriangle> sheet;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size()))
    if (std::all_of(f.ids.begin(), f.ids.end(), [&](Index v) {
          const Vec3& p = mesh.points[v];
          return p.z() == 6 && std::min(p.x(), p.y()) >= 3 && std::max(p.x(), p.y()) <= 9;
        }))
      sheet.push_back({f.ids, 1, 1});
  mesh.patch_groups[{{1, 1}, 0}] = {5, "baffle"};
  append_sheets(mesh.interfaces, std::move(sheet));
  write_tet_mesh({mesh, nullptr}, file);
}

nlohmann::json checked(const std::string& file) {
  const Answer a = run("check " + file + " --json --quiet");
  EXPECT_EQ(a.status, 0) << a.out;
  return nlohmann::json::parse(a.out);
}

TEST(Sheets, AreKeptFromFileToFile) {
  const TemporaryFolder f;
  write_box(f / "box.msh");
  for (const std::string file : {"a.vtu", "a.msh", "a.mesh", "a.vtk", "a.inp", "a.xdmf"}) {
    const Answer a = run("simplify " + (f / "box.msh") + " -o " + (f / file) + " --target-tets 800 --stats " +
                         (f / "s.json"));
    EXPECT_EQ(a.status, 0) << a.err;
    EXPECT_NE(a.out.find("sheet \"baffle\": "), std::string::npos) << a.out;
    const nlohmann::json stats = nlohmann::json::parse(contents(f / "s.json"));
    EXPECT_NEAR(stats.at("result").at("sheets").at(0).at("area"), 36, 1e-6);
    const nlohmann::json check = checked(f / file), sheet = check.at("mesh").at("sheets").at(0);
    EXPECT_EQ(sheet.at("name"), "baffle") << file;
    EXPECT_NEAR(sheet.at("area"), 36, 1e-6);
    EXPECT_NEAR(sheet.at("border_length"), 24, 1e-6);
    EXPECT_EQ(sheet.at("pieces"), 1);
    EXPECT_EQ(sheet.at("border_pieces"), 1);
    EXPECT_LT(sheet.at("triangles"), 72);
    EXPECT_EQ(check.at("topology").at("sheets").at(0).at("euler"), 1);
  }
}

TEST(Sheets, AreFollowedByTetsOfSecondOrder) {
  const TemporaryFolder f;
  write_box(f / "box.msh");
  EXPECT_EQ(
      run("simplify " + (f / "box.msh") + " -o " + (f / "a.vtu") + " --target-tets 800 --order 2").status, 0);
  EXPECT_NEAR(checked(f / "a.vtu").at("mesh").at("sheets").at(0).at("area"), 36, 1e-6);
}

TEST(Sheets, LeftOutByNoBoundaryAreNamed) {
  const TemporaryFolder f;
  write_box(f / "box.msh");
  const Answer a =
      run("simplify " + (f / "box.msh") + " -o " + (f / "a.vtu") + " --target-tets 800 --no-boundary");
  EXPECT_NE(a.err.find(" faces of sheets (not written, as --no-boundary asks)"), std::string::npos) << a.err;
  EXPECT_FALSE(checked(f / "a.vtu").at("mesh").contains("sheets"));
}

TEST(Sheets, LostInAnotherMeshAreADifferentTopology) {
  const TemporaryFolder f;
  write_box(f / "box.msh");
  run("simplify " + (f / "box.msh") + " -o " + (f / "a.vtu") + " --target-tets 800 --no-boundary");
  const Answer a = run("check " + (f / "a.vtu") + " --before " + (f / "box.msh"));
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.out.find("sheet baffle: before components 1, euler 1; after missing"), std::string::npos)
      << a.out;
}

constexpr const char* box_off =
    "OFF\n8 6 0\n0 0 0\n2 0 0\n2 1 0\n0 1 0\n0 0 1\n2 0 1\n2 1 1\n0 1 1\n"
    "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
constexpr const char* baffle_off =
    "OFF\n4 1 0\n0.8 0.2 0.2\n1.3 0.5 0.2\n1.3 0.5 0.7\n0.8 0.2 0.7\n4 0 1 2 3\n";

TEST(Sheets, AreMadeFromOpenSurfaces) {
  const TemporaryFolder f;
  put(f / "box.off", box_off);
  put(f / "baffle.off", baffle_off);
  const Answer a = run("prepare " + (f / "box.off") + " --sheet baffle=" + (f / "baffle.off") + " -o " +
                       (f / "a.vtu") + " --target-tets 1500 --strict");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.out.find("sheet \"baffle\": "), std::string::npos) << a.out;
  const nlohmann::json sheet = checked(f / "a.vtu").at("mesh").at("sheets").at(0);
  EXPECT_EQ(sheet.at("name"), "baffle");
  EXPECT_NEAR(sheet.at("area"), std::hypot(0.5, 0.3) * 0.5, 1e-6);
  EXPECT_NEAR(sheet.at("border_length"), 2 * (std::hypot(0.5, 0.3) + 0.5), 1e-6);
  EXPECT_EQ(sheet.at("pieces"), 1);
}

TEST(Sheets, AndPartitionsNeedSurfaces) {
  const TemporaryFolder f;
  put(f / "box.off", box_off);
  const std::string call = "mesh " + (f / "box.off") + " -o " + (f / "a.vtu");
  expect_refused(call + " --sheet baffle", 2, {"--sheet", "NAME=FILE"});
  expect_refused(call + " --sheet baffle=" + (f / "none.off"), 3, {"none.off"});
  expect_refused(call + " --partition level=" + (f / "none.off"), 3, {"none.off"});
}

TEST(Sheets, PartitionsMakeNamedMaterials) {
  const TemporaryFolder f;
  put(f / "box.off", box_off);
  put(f / "level.off", "OFF\n4 1 0\n-1 -1 0.4\n3 -1 0.6\n3 2 0.6\n-1 2 0.4\n4 0 1 2 3\n");
  const Answer a = run("prepare " + (f / "box.off") + " --partition level=" + (f / "level.off") +
                       " --region water@1,0.5,0.1 -o " + (f / "a.vtu") + " --target-tets 1500");
  EXPECT_EQ(a.status, 0) << a.err;
  const TetMesh mesh = read_tet_mesh(f / "a.vtu").mesh;
  ASSERT_EQ(mesh.material_names.size(), 2U);
  EXPECT_EQ(mesh.material_names.begin()->second, "box_1");
  EXPECT_EQ(mesh.material_names.rbegin()->second, "water");
}

TEST(Sheets, ShowOnTheReportPage) {
  const TemporaryFolder f;
  write_box(f / "box.msh");
  const Answer a = run("check " + (f / "box.msh") + " --report " + (f / "page.html"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_TRUE(f.has("page.html"));
}

}  // namespace
}  // namespace tetwright::sheets_test
