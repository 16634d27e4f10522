// SPDX-License-Identifier: Apache-2.0

// Tests the program as a whole: commands, exit statuses, messages, files.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "common/samples/samples.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::program_test {
namespace {

TEST(Program, PreparesASurfaceEndToEnd) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample torus -o " + (f / "torus.ply")).status, 0);
  const Answer a = run("prepare " + (f / "torus.ply") + " -o " + (f / "torus.vtu") +
                       " --target-tets 4000 --stats " + (f / "stats.json"));
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(a.err, "");
  EXPECT_NE(a.out.find("smallest solid angle"), std::string::npos);
  EXPECT_NE(a.out.find("resolution "), std::string::npos);  // the chosen one is printed
  const Answer c = run("check " + (f / "torus.vtu") + " --json");
  EXPECT_EQ(c.status, 0) << c.out;
  const auto j = nlohmann::json::parse(c.out);
  EXPECT_TRUE(j["valid"]);
  EXPECT_NEAR(j["mesh"]["tets"].get<double>(), 4000, 40);
  EXPECT_LT(j["mesh"]["percent_below_threshold"].get<double>(), 2);
}

TEST(Program, MeshThenSimplifyKeepsTheTopology) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample knot -o " + (f / "knot.stl")).status, 0);
  ASSERT_EQ(
      run("mesh " + (f / "knot.stl") + " -o " + (f / "dense.mesh") + " --resolution 48 --accept-changes")
          .status,
      0);
  ASSERT_EQ(run("simplify " + (f / "dense.mesh") + " -o " + (f / "small.msh") + " --target-tets 3000").status,
            0);
  const Answer a = run("check " + (f / "small.msh") + " --before " + (f / "dense.mesh"));
  EXPECT_EQ(a.status, 0) << a.out;
  // A ball does not have the topology of a knotted ring.
  ASSERT_EQ(run("sample sphere -o " + (f / "sphere.off")).status, 0);
  ASSERT_EQ(
      run("mesh " + (f / "sphere.off") + " -o " + (f / "sphere.vtu") + " --resolution 16 --accept-changes")
          .status,
      0);
  EXPECT_EQ(run("check " + (f / "sphere.vtu") + " --before " + (f / "dense.mesh")).status, 1);
}

TEST(Program, OneThreadAndOneSeedGiveTheSameFile) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample torus -o " + (f / "torus.obj")).status, 0);
  for (const char* name : {"a.mesh", "b.mesh"})
    ASSERT_EQ(
        run("prepare " + (f / "torus.obj") + " -o " + (f / name) + " --target-tets 3000 --threads 1 --seed 7")
            .status,
        0);
  EXPECT_EQ(contents(f / "a.mesh"), contents(f / "b.mesh"));
  // The dense mesh does not depend on the number of threads.
  for (const char* threads : {"1", "2"})
    ASSERT_EQ(run("mesh " + (f / "torus.obj") + " -o " + (f / threads) +
                  ".mesh --resolution 24 --accept-changes --threads " + threads)
                  .status,
              0);
  EXPECT_EQ(contents(f / "1.mesh"), contents(f / "2.mesh"));
}

TEST(Program, QuietSaysNothing) {
  const TemporaryFolder f;
  const Answer a = run("sample cube -o " + (f / "cube.off") + " --quiet");
  EXPECT_EQ(a.status, 0);
  EXPECT_EQ(a.out + a.err, "");
  const Answer b = run("mesh " + (f / "cube.off") + " -o " + (f / "cube.vtu") + " --resolution 12 --quiet");
  EXPECT_EQ(b.status, 0);
  EXPECT_EQ(b.out + b.err, "");
}

TEST(Program, HelpAndVersion) {
  for (const char* arguments :
       {"--help", "prepare --help", "mesh --help", "simplify --help", "improve --help", "values --help",
        "embed --help", "check --help", "sample --help", "--version"}) {
    const Answer a = run(arguments);
    EXPECT_EQ(a.status, 0) << arguments;
    EXPECT_NE(a.out.find("etwright"), std::string::npos) << arguments;
    EXPECT_EQ(a.err, "");
  }
}

TEST(Program, StatisticsNeverReplaceAMesh) {
  const TemporaryFolder f;
  put(f / "t.off", tetrahedron_off);
  const std::string mesh = "mesh " + (f / "t.off") + " --accept-changes --resolution 8 -o ";
  expect_refused(mesh + (f / "a.vtu") + " --stats " + (f / "a.vtu"), 2, {"--stats", ".json"});
  expect_refused(mesh + (f / "a.vtu") + " --stats " + (f / "t.off"), 2, {"--stats", ".json"});
  ASSERT_EQ(run(mesh + (f / "a.vtu")).status, 0);
  std::filesystem::create_symlink(f / "a.vtu", f / "link.json");
  expect_refused("check " + (f / "a.vtu") + " --stats " + (f / "link.json"), 2, {"link.json"});
  EXPECT_EQ(contents(f / "t.off"), tetrahedron_off);
  EXPECT_EQ(run("check " + (f / "a.vtu")).status, 0);
}

TEST(Program, AnInterruptLeavesNothingBehind) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample knot -o " + (f / "k.off")).status, 0);
  const std::size_t files = f.entries();
  // Both during the work and while the program waits for input that never arrives.
  const std::string prefix = "timeout --preserve-status -s INT ";
  const Answer working =
      run("prepare " + (f / "k.off") + " -o " + (f / "k.vtu") + " --target-tets 500000", "", prefix + "0.5");
  EXPECT_EQ(working.status, 130) << working.err;
  EXPECT_EQ(f.entries(), files);
  ASSERT_EQ(std::system(("mkfifo " + (f / "pipe.off")).c_str()), 0);
  const Answer waiting = run("mesh " + (f / "pipe.off") + " -o " + (f / "k.vtu"), "", prefix + "0.3");
  EXPECT_EQ(waiting.status, 130) << waiting.err;
  EXPECT_EQ(f.entries(), files + 1);
}

TEST(Program, ResultsThatCannotBePrintedAreStatusFive) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample tet_cube -o " + (f / "t.vtu")).status, 0);
  const int code =
      std::system((program() + " check --json " + (f / "t.vtu") + " >/dev/full 2>/dev/null").c_str());
  EXPECT_EQ(WEXITSTATUS(code), 5);
}

TEST(Program, WhatAFileHoldsBesideTheMeshIsNamed) {
  const TemporaryFolder f;
  const std::string head =
      "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  const std::string tets = "Tetrahedra\n1\n1 2 3 4 1\n";
  put(f / "ridges.mesh", head + tets + "Ridges\n2\n1\n2\nEnd\n");
  const Answer checked = run("check " + (f / "ridges.mesh") + " --json");
  EXPECT_EQ(checked.status, 0);
  EXPECT_EQ(checked.err, "tetwright: note: " + (f / "ridges.mesh") + ": 2 ridges (dropped)\n");
  EXPECT_EQ(
      run("improve " + (f / "ridges.mesh") + " -o " + (f / "out.vtu") + " --quiet --stats " + (f / "s.json"))
          .status,
      0);
  const auto findings = nlohmann::json::parse(contents(f / "s.json"))["input"]["findings"];
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0]["what"], "ridges");
  EXPECT_EQ(findings[0]["count"], 2);
  // Interface triangles are restored, so they are not reported as dropped.
  ASSERT_EQ(run("sample two_materials -o " + (f / "two.msh")).status, 0);
  ASSERT_EQ(run("improve " + (f / "two.msh") + " -o " + (f / "better.msh") + " --quiet").status, 0);
  EXPECT_EQ(run("check " + (f / "better.msh") + " --json").err, "");
  EXPECT_NE(run("check " + (f / "better.msh")).err.find("(restored from the materials)"), std::string::npos);
  // Cells of other kinds are rejected, since they would be missing in the body.
  put(f / "hexa.mesh", head + tets + "Hexahedra\n1\n1 2 3 4 1 2 3 4 0\nEnd\n");
  expect_refused("check " + (f / "hexa.mesh"), 3,
                 {"hexa.mesh: line 12: 1 hexahedra", "convert them to tets"});
  // Surfaces drop faces with fewer than three vertices, and report it.
  put(f / "t.off", tetrahedron_off);
  std::string with_edge = tetrahedron_off + "2 0 1\n";
  with_edge.replace(4, 5, "4 5 6");
  put(f / "e.off", with_edge);
  EXPECT_NE(run("mesh " + (f / "e.off") + " -o " + (f / "e.vtu") + " --resolution 8")
                .err.find("1 faces of fewer than three vertices (dropped)"),
            std::string::npos);
}

TEST(Program, AnErrorIsOneLineWhateverTheName) {
  expect_refused("check \"$(printf 'no\\nfile.vtu')\"", 3, {"no?file.vtu"});
}

TEST(Program, BrokenInputsAreStatusThree) {
  const TemporaryFolder f;
  const auto refused = [&](const std::string& name, const std::string& text,
                           const std::vector<std::string>& said) {
    put(f / name, text);
    std::vector<std::string> all = said;
    all.push_back(name);
    expect_refused("prepare " + (f / name) + " -o " + (f / "out.vtu") + " --target-tets 100", 3, all);
    EXPECT_FALSE(std::filesystem::exists(f / "out.vtu"));
  };
  expect_refused("prepare " + (f / "missing.ply") + " -o " + (f / "out.vtu") + " --target-tets 100", 3,
                 {"missing.ply"});
  refused("empty.off", "", {});
  refused("cut.off", tetrahedron_off.substr(0, tetrahedron_off.size() - 8), {});
  refused("word.off", "OFF\n4 4 6\n0 0 zero\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
          {"line 3", "zero"});
  refused("range.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 9\n3 0 3 2\n",
          {"line 9", "9"});
  refused("nan.off", "OFF\n4 4 6\n0 0 nan\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
          {"line 3"});
  refused("none.off", "OFF\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n", {});
  refused(
      "huge.ply",
      "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n1234",
      {"4000000000"});
  refused("huge.off", "OFF\n4000000000 4000000000 0\n0 0 0\n", {});
  refused("flat.off", "OFF\n3 1 3\n0 0 0\n1 0 0\n2 0 0\n3 0 1 0\n", {});
  refused("not.vdb", tetrahedron_off, {"not a .vdb"});
  put(f / "empty.mesh", "MeshVersionFormatted 2\nDimension 3\nVertices\n0\nTetrahedra\n0\nEnd\n");
  expect_refused("simplify " + (f / "empty.mesh") + " -o " + (f / "out.vtu") + " --target-tets 10", 3,
                 {"empty.mesh"});
  expect_refused("check " + (f / "empty.mesh"), 3, {"empty.mesh"});
}

TEST(Program, HolesAreClosedAndSaid) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample open_sphere -o " + (f / "open.ply")).status, 0);
  const std::string mesh = "mesh " + (f / "open.ply") + " -o " + (f / "out.vtu") + " --resolution 24";
  const Answer a = run(mesh + " --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(a.err.rfind("tetwright: note: ", 0), 0u) << a.err;
  EXPECT_NE(a.err.find("boundary edges of holes"), std::string::npos) << a.err;
  const auto findings = nlohmann::json::parse(contents(f / "s.json"))["input"]["findings"];
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0]["what"], "boundary edges of holes");
  EXPECT_GT(findings[0]["count"], 2);
  EXPECT_EQ(findings[0]["place"].size(), 3u);
  EXPECT_EQ(run(mesh + " --quiet").err, "");
  EXPECT_EQ(run("check " + (f / "out.vtu")).status, 0);
}

TEST(Program, MaterialsLayersAndLevelSets) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample sphere -o " + (f / "ball.off")).status, 0);
  put(f / "cube.off",
      "OFF\n8 6 12\n-0.4 -0.4 -0.4\n0.4 -0.4 -0.4\n-0.4 0.4 -0.4\n0.4 0.4 -0.4\n-0.4 -0.4 0.4\n"
      "0.4 -0.4 0.4\n-0.4 0.4 0.4\n0.4 0.4 0.4\n4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n"
      "4 0 4 6 2\n4 1 3 7 5\n");
  const std::string surfaces = (f / "ball.off") + " --material \"the core=" + (f / "cube.off") +
                               "\" --layer skin=0.12 --voxel-size 0.08 --accept-changes ";
  const auto materials = [&](const std::string& mesh) {
    std::map<std::string, std::pair<int, double>> found;
    const auto j = nlohmann::json::parse(run("check --json " + mesh).out);
    EXPECT_TRUE(j["valid"]) << j;
    for (const auto& m : j["mesh"]["materials"])
      found[m["name"].get<std::string>()] = {m["tag"].get<int>(), m["volume"].get<double>()};
    return found;
  };
  const Answer a = run("mesh " + surfaces + " -o " + (f / "out.msh") + " --write-sdf " + (f / "fields.vdb"));
  ASSERT_EQ(a.status, 0) << a.err;
  const auto first = materials(f / "out.msh");
  ASSERT_EQ(first.size(), 3u);
  EXPECT_EQ(first.at("ball").first, 1);
  EXPECT_EQ(first.at("the core").first, 2);
  EXPECT_EQ(first.at("skin").first, 3);
  EXPECT_GT(first.at("skin").second, 0);
  // The written fields give the same materials again.
  const Answer again =
      run("mesh " + (f / "fields.vdb") + " --voxel-size 0.08 --accept-changes -o " + (f / "again.vtu"));
  ASSERT_EQ(again.status, 0) << again.err;
  for (const auto& [name, material] : materials(f / "again.vtu"))
    EXPECT_NEAR(material.second, first.at(name).second, 0.05 * first.at(name).second) << name;
  // `prepare` with the same input.
  ASSERT_EQ(run("prepare " + surfaces + " -o " + (f / "small.vtu") + " --target-tets 4000").status, 0);
  EXPECT_EQ(materials(f / "small.vtu").size(), 3u);
  const Answer outside = run("mesh " + (f / "ball.off") +
                             " --keep-outside --resolution 12 --accept-changes -o " + (f / "box.vtu"));
  ASSERT_EQ(outside.status, 0) << outside.err;
  EXPECT_EQ(materials(f / "box.vtu").at("outside").first, 0);
}

TEST(Program, MaterialsThatMakeNoSense) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample sphere -o " + (f / "ball.off")).status, 0);
  ASSERT_EQ(run("sample cube -o " + (f / "cube.off")).status, 0);
  const std::string out = " --resolution 16 -o " + (f / "out.vtu"), ball = "mesh " + (f / "ball.off");
  expect_refused("mesh" + out, 2, {"input"});
  expect_refused(ball + " --material core" + out, 2, {"core", "NAME=FILE"});
  expect_refused(ball + " --material core=" + (f / "none.off") + out, 3, {"none.off"});
  expect_refused(ball + " --material ball=" + (f / "cube.off") + out, 2, {"'ball'"});
  expect_refused(ball + " --layer skin=thick" + out, 2, {"thick"});
  expect_refused(ball + " --layer skin=-1" + out, 2, {"-1"});
  expect_refused(ball + " --layer skin=50" + out, 3, {"skin", "thicker"});
  expect_refused(ball + " --nested never" + out, 2, {"never"});
  expect_refused(ball + " --write-sdf " + (f / "fields.txt") + out, 2, {".vdb"});
  expect_refused(ball + " --nested 1" + out, 2, {"cavity"});
  expect_refused(ball + " --material outside=" + (f / "cube.off") + " --keep-outside" + out, 2,
                 {"'outside'"});
  // A link to an input, and a name that is not UTF-8.
  ASSERT_EQ(std::system(("ln -s ball.off " + (f / "link.vtu")).c_str()), 0);
  expect_refused(ball + " --resolution 16 -o " + (f / "link.vtu"), 2, {"link.vtu"});
  EXPECT_EQ(contents(f / "ball.off").substr(0, 3), "OFF");
  EXPECT_EQ(
      run("prepare --material \"$(printf '\\377')=" + (f / "ball.off") +
          "\" --target-tets 500 --accept-changes -o " + (f / "odd.vtu") + " --stats " + (f / "odd.json"))
          .status,
      0);
  EXPECT_EQ(nlohmann::json::parse(contents(f / "odd.json"))["result"]["materials"].size(), 1u);
  // An outermost surface that is listed last covers the earlier ones.
  expect_refused("mesh " + (f / "cube.off") + " --voxel-size 0.1 --material shell=" + (f / "ball.off") +
                     " --layer hull=0.01 -o " + (f / "out.vtu"),
                 3, {"hull"});
  EXPECT_FALSE(std::filesystem::exists(f / "out.vtu"));
}

TEST(Program, ASurfaceSmallerThanACellIsStatusFour) {
  const TemporaryFolder f;
  put(f / "t.off", tetrahedron_off);
  expect_refused("mesh " + (f / "t.off") + " -o " + (f / "out.vtu") + " --voxel-size 50", 4, {});
  EXPECT_FALSE(std::filesystem::exists(f / "out.vtu"));
}

TEST(Program, WhatCannotBeWrittenIsStatusFive) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample sphere -o " + (f / "s.off")).status, 0);
  const std::string mesh = "mesh " + (f / "s.off") + " --resolution 16 -o ";
  expect_refused(mesh + (f / "no/such/folder.vtu"), 5, {"folder"});
  // A file size limit of 16 blocks acts like a full disk. The existing file must be kept.
  put(f / "old.vtu", "precious");
  expect_refused(mesh + (f / "old.vtu"), 5, {"old.vtu"}, "ulimit -f 16;");
  EXPECT_EQ(contents(f / "old.vtu"), "precious");
  EXPECT_EQ(f.entries(), 2u);  // no temporary file is left behind
  // The folder is checked before any work: the broken input is not read.
  put(f / "broken.off", "nothing");
  expect_refused("mesh " + (f / "broken.off") + " -o " + (f / "no/out.vtu"), 5, {});
}

TEST(Program, AnExistingFileSurvivesABrokenInput) {
  const TemporaryFolder f;
  put(f / "old.vtu", "precious");
  put(f / "broken.off", "OFF\n1 1 1\n");
  expect_refused("mesh " + (f / "broken.off") + " -o " + (f / "old.vtu"), 3, {});
  EXPECT_EQ(contents(f / "old.vtu"), "precious");
}

TEST(Program, ShortOfTheTargetIsStatusOneAndWritten) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample torus -o " + (f / "t.off")).status, 0);
  ASSERT_EQ(
      run("mesh " + (f / "t.off") + " -o " + (f / "d.vtu") + " --resolution 24 --accept-changes").status, 0);
  const Answer a = run("simplify " + (f / "d.vtu") + " -o " + (f / "s.vtu") + " --target-tets 3 --stats " +
                       (f / "s.json"));
  EXPECT_EQ(a.status, 1) << a.err;
  EXPECT_NE(a.err.find("limited by"), std::string::npos) << a.err;
  EXPECT_EQ(run("check " + (f / "s.vtu") + " --before " + (f / "d.vtu")).status, 0);
  EXPECT_EQ(nlohmann::json::parse(contents(f / "s.json"))["shortfall"][0]["what"], "target_tets");
  // A target above the mesh's number of tets.
  expect_refused("simplify " + (f / "d.vtu") + " -o " + (f / "x.vtu") + " --target-tets 100000000", 2,
                 {"100000000"});
  // A solid angle that was requested and cannot be reached.
  EXPECT_EQ(
      run("simplify " + (f / "d.vtu") + " -o " + (f / "s.vtu") + " --target-tets 2000 --min-solid-angle 0.5")
          .status,
      1);
}

}  // namespace
}  // namespace tetwright::program_test
