// SPDX-License-Identifier: Apache-2.0

// Tet meshes of other programs: their fields, materials and orientation.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "common/samples/samples.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::import_cleanup_test {
namespace {

/// The cube sample with two point fields (a linear one and the point numbers) and three cell fields; two of
/// these are integers and neither has a name that stands for the material.
TetMesh cube_with_fields() {
  TetMesh mesh = std::get<TetMesh>(make_sample("tet_cube"));
  mesh.point_fields = {{"linear", 2, false, {}}, {"number", 1, true, {}}};
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    mesh.point_fields[0].values.push_back(mesh.points[i].x());
    mesh.point_fields[0].values.push_back(1);
    mesh.point_fields[1].values.push_back(static_cast<double>(i));
  }
  mesh.cell_fields = {{"region", 1, true, {}}, {"other", 1, true, {}}, {"size", 1, false, {}}};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    mesh.cell_fields[0].values.push_back(mesh.points[mesh.tets[t][0]].x() < mesh.points[0].x() + 1e-9 ? 5
                                                                                                      : 6);
    mesh.cell_fields[1].values.push_back(static_cast<double>(t));
    mesh.cell_fields[2].values.push_back(0.5);
  }
  return mesh;
}

TEST(ImportCleanup, FieldsAreCarriedOver) {
  const TemporaryFolder f;
  const TetMesh mesh = cube_with_fields();
  write_tet_mesh(mesh, f / "in.vtu");
  for (const char* name : {"out.vtu", "out.msh"}) {
    ASSERT_LE(run("simplify " + (f / "in.vtu") + " -o " + (f / name) + " --target-tets 100").status, 1);
    const TetMesh out = read_tet_mesh(f / name).mesh;
    ASSERT_LT(out.tets.size(), mesh.tets.size());
    ASSERT_EQ(out.point_fields.size(), 2u);
    const auto n = static_cast<std::size_t>(out.point_fields[0].components);  // .msh pads to 1, 3 or 9
    for (std::size_t i = 0; i < out.points.size(); ++i) {
      // Points outside the cube have the value of its nearest point.
      EXPECT_NEAR(out.point_fields[0].values[n * i], std::clamp(out.points[i].x(), 0.0, 1.0), 1e-12);
      EXPECT_EQ(out.point_fields[0].values[n * i + 1], 1);
    }
    ASSERT_EQ(out.cell_fields.size(), 3u);
    EXPECT_EQ(out.cell_fields[2].values, std::vector<double>(out.tets.size(), 0.5));
  }
  // `improve` also keeps fields. A mesh without fields gets none.
  ASSERT_LE(run("improve " + (f / "in.vtu") + " -o " + (f / "better.vtu")).status, 1);
  EXPECT_EQ(read_tet_mesh(f / "better.vtu").mesh.point_fields.size(), 2u);
  ASSERT_EQ(run("sample tet_cube -o " + (f / "plain.vtu")).status, 0);
  ASSERT_LE(
      run("simplify " + (f / "plain.vtu") + " -o " + (f / "plain_out.vtu") + " --target-tets 100").status, 1);
  EXPECT_TRUE(read_tet_mesh(f / "plain_out.vtu").mesh.cell_fields.empty());
}

TEST(ImportCleanup, TheFieldOfTheMaterials) {
  const TemporaryFolder f;
  write_tet_mesh(cube_with_fields(), f / "in.vtu");
  const std::string simplify = "simplify " + (f / "in.vtu") + " -o " + (f / "out.vtu") + " --target-tets 200";
  ASSERT_LE(run(simplify + " --material-field region --stats " + (f / "s.json")).status, 1);
  const auto stats = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_EQ(stats["input"]["material_field"], "region");
  ASSERT_EQ(stats["result"]["materials"].size(), 2u);
  EXPECT_EQ(stats["result"]["materials"][0]["tag"], 5);
  // The result has the field as its material; `check` treats both in the same way.
  EXPECT_EQ(
      run("check " + (f / "out.vtu") + " --before " + (f / "in.vtu") + " --material-field region").status, 0);
  EXPECT_EQ(run("check " + (f / "out.vtu") + " --before " + (f / "in.vtu")).status, 1);
  const auto checked =
      nlohmann::json::parse(run("check " + (f / "in.vtu") + " --json --material-field region").out);
  EXPECT_EQ(checked["mesh"]["materials"].size(), 2u);
  for (const std::string& call :
       {simplify, "improve " + (f / "in.vtu") + " -o " + (f / "x.vtu"), "check " + (f / "in.vtu"),
        "check " + (f / "in.vtu") + " --before " + (f / "in.vtu")})
    expect_refused(call + " --material-field zone", 3,
                   {"no cell field \"zone\"", "\"material\"", "\"region\"", "\"other\""});
  expect_refused(simplify + " --material-field size", 3, {"\"size\"", "0.5"});
}

TEST(ImportCleanup, MeshesOfOtherProgramsAreMadeCoherent) {
  const TemporaryFolder f;
  TetMesh mesh = std::get<TetMesh>(make_sample("two_materials"));
  // A pair of TetGen files in which every second tet is inverted and each tet has separate points.
  std::string node = std::to_string(4 * mesh.tets.size()) + " 3 0 0\n";
  std::string ele = std::to_string(mesh.tets.size()) + " 4 1\n";
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (t % 2) std::swap(mesh.tets[t][0], mesh.tets[t][1]);
    ele += std::to_string(t);
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3& p = mesh.points[mesh.tets[t][k]];
      char text[100];
      std::snprintf(text, sizeof text, "%zu %.17g %.17g %.17g\n", 4 * t + k, p.x(), p.y(), p.z());
      node += text;
      ele += " " + std::to_string(4 * t + k);
    }
    ele += " " + std::to_string(mesh.materials[t]) + "\n";
  }
  put(f / "m.node", node);
  put(f / "m.ele", ele);
  // `check` does not repair the mesh.
  EXPECT_EQ(run("check " + (f / "m.node")).status, 1);
  const Answer a = run("improve " + (f / "m.ele") + " -o " + (f / "out.vtu") + " --stats " + (f / "s.json"));
  EXPECT_LE(a.status, 1) << a.err;
  EXPECT_NE(a.err.find("(corrected)"), std::string::npos) << a.err;
  std::map<std::string, std::size_t> counts;
  const auto stats = nlohmann::json::parse(contents(f / "s.json"));
  for (const auto& finding : stats["input"]["findings"]) counts[finding["what"]] = finding["count"];
  EXPECT_EQ(counts["points repeated for each tet"], 4 * mesh.tets.size() - mesh.points.size());
  EXPECT_EQ(counts["tets with reversed vertex order"], mesh.tets.size() / 2);
  EXPECT_EQ(counts.size(), 2u);
  EXPECT_EQ(run("check " + (f / "out.vtu")).status, 0);
  expect_refused("simplify " + (f / "m.ele") + " -o " + (f / "out.ply") + " --target-tets 10", 2,
                 {"\".ply\" for a tet mesh", ".vtu .pvtu .vtkhdf .msh .mesh"});
  // If all tets have a repeated vertex, no tet is left.
  put(f / "flat.node", "4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  put(f / "flat.ele", "2 4\n0 0 1 2 2\n1 3 1 3 2\n");
  expect_refused("improve " + (f / "flat.node") + " -o " + (f / "x.vtu"), 3,
                 {"flat.node", "repeated vertex"});
}

}  // namespace
}  // namespace tetwright::import_cleanup_test
