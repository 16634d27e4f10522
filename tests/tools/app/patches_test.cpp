// SPDX-License-Identifier: Apache-2.0

// Named patches and solids, from file to file.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "common/io/formats.h"
#include "common/mesh/mesh_statistics.h"
#include "tests/tools/program.h"

namespace tetwright::patches_test {
namespace {

/// A box as solids of an STL file: its side z = `high` is the solid `lid`, unless that is empty.
std::string box(double low, double high, const std::string& name, const std::string& lid = "") {
  const auto solid = [&](const std::string& called, std::initializer_list<std::array<int, 4>> quads) {
    std::ostringstream out;
    out << "solid " << called << "\n";
    for (const auto& q : quads)
      for (const auto& [i, k] : {std::pair(1, 2), std::pair(2, 3)}) {
        out << "facet normal 0 0 0\nouter loop\n";
        for (const int p : {q[0], q[static_cast<std::size_t>(i)], q[static_cast<std::size_t>(k)]})
          out << "vertex " << (p & 1) << " " << (p >> 1 & 1) << " " << (p & 4 ? high : low) << "\n";
        out << "endloop\nendfacet\n";
      }
    out << "endsolid\n";
    return out.str();
  };
  if (lid.empty())
    return solid(name, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
  return solid(name, {{0, 2, 3, 1}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) +
         solid(lid, {{4, 5, 7, 6}});
}

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

std::size_t faces_named(const TetMesh& mesh, const std::string& name) {
  return static_cast<std::size_t>(
      std::count_if(mesh.interfaces.begin(), mesh.interfaces.end(), [&](const InterfaceTriangle& t) {
        const auto group = mesh.patch_groups.find({t.pair(), t.patch});
        return group != mesh.patch_groups.end() && group->second.name == name;
      }));
}

TEST(Patches, AreKeptFromScanToSolver) {
  const TemporaryFolder f;
  write(f / "box.stl", box(0, 1, "wall", "inlet"));
  const Answer a = run("prepare " + (f / "box.stl") + " -o " + (f / "a.msh") + " --target-tets 500 --stats " +
                       (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.out.find("named patches: inlet ("), std::string::npos) << a.out;
  const nlohmann::json patches = nlohmann::json::parse(contents(f / "s.json")).at("patches");
  ASSERT_EQ(patches.size(), 2U);
  EXPECT_EQ(patches[0].at("name"), "inlet");
  EXPECT_NEAR(patches[0].at("area"), 1, 1e-9);
  EXPECT_NEAR(patches[1].at("area"), 5, 1e-9);
  EXPECT_NE(contents(f / "a.msh").find("2 1 \"inlet\"\n2 2 \"wall\"\n"), std::string::npos);
  for (const char* more : {"", " --feature-angle off"}) {
    const Answer b = run("simplify " + (f / "a.msh") + " -o " + (f / "b.msh") + " --target-tets 200" + more);
    EXPECT_LE(b.status, 1) << b.err;
    const TetMesh mesh = read_tet_mesh(f / "b.msh").mesh;
    EXPECT_GT(faces_named(mesh, "inlet"), 1U);
    EXPECT_EQ(faces_named(mesh, "inlet") + faces_named(mesh, "wall"), mesh.interfaces.size());
    for (const InterfaceTriangle& t : mesh.interfaces) {
      const bool above = std::all_of(t.ids.begin(), t.ids.end(),
                                     [&](Index p) { return std::abs(mesh.points[p].z() - 1) < 1e-6; });
      const auto group = mesh.patch_groups.find({t.pair(), t.patch});
      EXPECT_EQ(group->second.name == "inlet", above);
    }
  }
}

TEST(Patches, ThatAreLostAreSaid) {
  const TemporaryFolder f;
  // The lid lies within the next material.
  write(f / "box.stl", box(0, 1, "wall", "inlet"));
  write(f / "cover.stl", box(0.5, 1.5, "cover"));
  const std::string call =
      "mesh " + (f / "box.stl") + " " + (f / "cover.stl") + " --resolution 12 -o " + (f / "a.msh");
  const Answer a = run(call);
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.err.find("lost 1 of 2 named patches: 'inlet' at ("), std::string::npos) << a.err;
  const Answer b = run(call + " --accept-changes");
  EXPECT_NE(b.err.find("1 named patches that are lost: 'inlet'"), std::string::npos) << b.err;
}

TEST(Patches, ThatAFormatHasNoPlaceForAreTold) {
  const TemporaryFolder f;
  write(f / "box.stl", box(0, 1, "wall", "inlet"));
  for (const std::string output : {"a.vtu", "a.msh"}) {
    const Answer a = run("mesh " + (f / "box.stl") + " --resolution 8 -o " + (f / output));
    EXPECT_EQ(a.status, 0) << a.err;
    EXPECT_EQ(a.err.find("2 named patches (not written") != std::string::npos, output == "a.vtu") << a.err;
  }
}

TEST(Patches, OfBoxesThatTouchLeaveGoodShapes) {
  const TemporaryFolder f;
  write(f / "box.stl", box(0, 1, "wall", "inlet"));
  write(f / "case.stl", box(1, 2, "side", "outlet"));
  const Answer a =
      run("prepare " + (f / "box.stl") + " " + (f / "case.stl") + " --target-tets 3000 -o " + (f / "a.msh"));
  const TetMesh mesh = read_tet_mesh(f / "a.msh").mesh;
  EXPECT_LT(mesh_statistics(mesh, 0.1).below_percent, 5);  // with exact creases more than 30
  std::set<std::string> names;
  for (const auto& [patch, group] : mesh.patch_groups) names.insert(group.name);
  EXPECT_TRUE(names.contains("wall") && names.contains("side") && names.contains("outlet")) << a.err;
}

TEST(Patches, SolidsAreMaterials) {
  const TemporaryFolder f;
  write(f / "two.stl", box(0, 1, "bone") + box(1, 1.6, "skin"));
  const Answer a = run("mesh " + (f / "two.stl") + " --split-solids --resolution 16 -o " + (f / "a.msh"));
  EXPECT_LE(a.status, 1) << a.err;
  const TetMesh mesh = read_tet_mesh(f / "a.msh").mesh;
  EXPECT_EQ(mesh.material_names, (std::map<MaterialTag, std::string>{{1, "bone"}, {2, "skin"}}));
}

TEST(Patches, SolidsWithoutANameHaveNumbers) {
  const TemporaryFolder f;
  write(f / "a.stl", box(0, 1, "", " "));
  write(f / "b.stl", box(2, 3, "", " "));
  const Answer both =
      run("mesh " + (f / "a.stl") + " " + (f / "b.stl") + " --resolution 12 -o " + (f / "out.msh"));
  EXPECT_LE(both.status, 1) << both.err;
  const TetMesh mesh = read_tet_mesh(f / "out.msh").mesh;
  for (const char* name : {"a_1", "a_2", "b_1", "b_2"}) EXPECT_GT(faces_named(mesh, name), 0U) << name;
  write(f / "two.stl", box(0, 1, "") + box(2, 3, ""));
  const Answer split =
      run("mesh " + (f / "two.stl") + " --split-solids --resolution 12 -o " + (f / "out.msh"));
  EXPECT_LE(split.status, 1) << split.err;
  EXPECT_EQ(read_tet_mesh(f / "out.msh").mesh.material_names,
            (std::map<MaterialTag, std::string>{{1, "two_1"}, {2, "two_2"}}));
  write(f / "c.stl", box(2, 3, "c_2", " "));
  expect_refused("mesh " + (f / "a.stl") + " " + (f / "c.stl") + " -o " + (f / "out.msh"), 3,
                 {"c.stl: its patch 2 would be called 'c_2' like one of "});
}

TEST(Patches, NamesAreTheSameInTheFileAndInTheStats) {
  const TemporaryFolder f;
  write(f / "box.stl", box(0, 1, "W\xe4nde", "\xe2\x82 lid"));
  const Answer a =
      run("mesh " + (f / "box.stl") + " --resolution 12 -o " + (f / "a.msh") + " --stats " + (f / "s.json"));
  EXPECT_LE(a.status, 1) << a.err;
  const TetMesh mesh = read_tet_mesh(f / "a.msh").mesh;
  const nlohmann::json stats = nlohmann::json::parse(contents(f / "s.json"));
  ASSERT_EQ(stats.at("patches").size(), 2U);
  for (const nlohmann::json& patch : stats.at("patches"))
    EXPECT_GT(faces_named(mesh, patch.at("name")), 0U) << patch;
}

TEST(Patches, WrongCalls) {
  const TemporaryFolder f;
  const std::string out = " -o " + (f / "out.vtu");
  write(f / "one.stl", box(0, 1, "bone"));
  expect_refused("mesh " + (f / "one.stl") + " --split-solids" + out, 3,
                 {"one.stl: --split-solids finds no solids"});
  write(f / "same.stl", box(0, 1, "bone") + box(2, 3, "bone"));
  expect_refused("mesh " + (f / "same.stl") + out, 3, {"same.stl: line 87: a solid is called \"bone\""});
  run("sample organs -o " + (f / "organs.nrrd"));
  expect_refused("mesh " + (f / "organs.nrrd") + " --split-solids" + out, 2,
                 {"--split-solids is for surfaces"});
  run("sample tet_cube -o " + (f / "tets.msh"));
  expect_refused("mesh " + (f / "tets.msh") + out, 3, {"tets.msh: there are ", "tetwright simplify"});
}

}  // namespace
}  // namespace tetwright::patches_test
