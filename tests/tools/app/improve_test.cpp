// SPDX-License-Identifier: Apache-2.0

// Tests `improve`, and the options that it shares with `simplify`, through the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::improve_test {
namespace {

nlohmann::json json_of(const std::string& path) { return nlohmann::json::parse(contents(path)); }

TEST(Improve, MakesShapesBetterAtAboutTheSameCount) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample knot -o " + (f / "k.off")).status, 0);
  ASSERT_EQ(
      run("mesh " + (f / "k.off") + " -o " + (f / "d.vtu") + " --resolution 24 --accept-changes").status, 0);
  const Answer a = run("improve " + (f / "d.vtu") + " -o " + (f / "i.vtu") + " --stats " + (f / "s.json"));
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(a.err, "");
  EXPECT_NE(a.out.find("before"), std::string::npos) << a.out;
  EXPECT_NE(a.out.find("improve "), std::string::npos) << a.out;
  EXPECT_EQ(run("check " + (f / "i.vtu") + " --before " + (f / "d.vtu")).status, 0);
  const auto j = json_of(f / "s.json");
  EXPECT_EQ(j["command"], "improve");
  EXPECT_EQ(j["objective"], "both");
  EXPECT_EQ(j["only_below"], 0);
  EXPECT_FALSE(j.contains("schedule"));
  const double before = j["dense"]["tets"], after = j["result"]["tets"];
  EXPECT_NEAR(after, before, 0.05 * before);
  EXPECT_LE(j["result"]["percent_below_threshold"], j["dense"]["percent_below_threshold"]);
}

TEST(Improve, SaysThatAllTetsAreBad) {
  const TemporaryFolder f;
  write_tet_mesh(TetMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0.01}}, {{0, 1, 2, 3}}, {1}, {}},
                 f / "flat.mesh");
  const Answer a = run("improve " + (f / "flat.mesh") + " -o " + (f / "out.mesh"));
  EXPECT_EQ(a.status, 0);
  EXPECT_NE(a.err.find("1 tets below 0.1 sr, 100 % of all"), std::string::npos) << a.err;
}

TEST(Improve, TakesWhatSteersItAndMayReplaceItsInput) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample two_materials -o " + (f / "m.msh")).status, 0);
  const Answer a = run("improve " + (f / "m.msh") + " -o " + (f / "m.msh") +
                       " --only-below 0.05 --objective dihedral --max-iterations 3 --threads 1 --seed 4" +
                       " --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  const auto j = json_of(f / "s.json");
  EXPECT_EQ(j["objective"], "dihedral");
  EXPECT_EQ(j["only_below"], 0.05);
  EXPECT_EQ(run("check " + (f / "m.msh")).status, 0);
}

TEST(Improve, AnAngleThatCannotBeHadIsStatusOneAndWritten) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample layers -o " + (f / "l.vtu")).status, 0);
  ASSERT_EQ(
      run("simplify --target-tets 700 --schedule paper " + (f / "l.vtu") + " -o " + (f / "m.vtu")).status, 0);
  const Answer a = run("improve " + (f / "m.vtu") + " -o " + (f / "o.vtu") + " --min-solid-angle 0.55" +
                       " --max-iterations 2 --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 1) << a.err;
  EXPECT_NE(a.err.find("--min-solid-angle: 0.55 requested"), std::string::npos) << a.err;
  EXPECT_NE(a.err.find(" %"), std::string::npos) << a.err;
  EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
  EXPECT_EQ(json_of(f / "s.json")["shortfall"][0]["what"], "min_solid_angle");
  EXPECT_EQ(run("check " + (f / "o.vtu") + " --before " + (f / "m.vtu")).status, 0);
}

TEST(Improve, FixBoundaryKeepsTheBoundaryAndInterfaces) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample two_materials -o " + (f / "m.mesh")).status, 0);
  /// Boundary and interface triangles of a file, by their coordinates.
  const auto triangles = [&](const std::string& path) {
    const TetMesh mesh = read_tet_mesh(path).mesh;
    std::vector<std::vector<std::array<double, 3>>> out;
    for (const InterfaceTriangle& t : find_interfaces(mesh)) {
      out.emplace_back();
      for (Index p : t.ids)
        out.back().push_back({mesh.points[p].x(), mesh.points[p].y(), mesh.points[p].z()});
      std::sort(out.back().begin(), out.back().end());
    }
    std::sort(out.begin(), out.end());
    return out;
  };
  const auto before = triangles(f / "m.mesh");
  for (const std::string& call : {std::string("improve "), std::string("simplify --target-tets 100 ")}) {
    const Answer fixed = run(call + (f / "m.mesh") + " -o " + (f / "f.mesh") + " --fix-boundary");
    EXPECT_LE(fixed.status, 1) << fixed.err;
    EXPECT_EQ(triangles(f / "f.mesh"), before);
  }
  ASSERT_LE(run("simplify --target-tets 100 " + (f / "m.mesh") + " -o " + (f / "g.mesh")).status, 1);
  EXPECT_NE(triangles(f / "g.mesh"), before);
}

TEST(Improve, TetsThatStayBelowOnlyBelowAreReported) {
  const TemporaryFolder f;
  // A single flat tet whose shape no operation can change.
  put(f / "flat.mesh",
      "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 0.001 0\n"
      "Tetrahedra\n1\n1 2 3 4 1\nEnd\n");
  const Answer a = run("improve " + (f / "flat.mesh") + " -o " + (f / "o.vtu") +
                       " --only-below 0.05 --max-iterations 2 --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("1 tets still below --only-below 0.05 sr, the smallest at 0.00"), std::string::npos)
      << a.err;
  EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
  EXPECT_EQ(json_of(f / "s.json")["input"]["findings"].size(), 1u);
}

TEST(Improve, WrongCallsAreStatusTwoAndSayWhatIsRight) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample tet_cube -o " + (f / "m.vtu")).status, 0);
  const auto refused = [&](const std::string& call, const std::string& said) {
    const Answer a = run(call + " " + (f / "m.vtu") + " -o " + (f / "o.vtu"));
    EXPECT_EQ(a.status, 2) << call << a.err;
    EXPECT_NE(a.err.find(said), std::string::npos) << a.err;
    EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
  };
  refused("improve --objective best", "'best' is not one of both, solid-angle, dihedral");
  refused("improve --only-below -1", "--only-below");
  refused("improve --only-below 2", "0.5513");
  refused("improve --only-below nan", "--only-below");
  refused("improve --max-iterations 0", "--max-iterations");
  refused("improve --min-solid-angle wide", "--min-solid-angle");
  refused("simplify --target-tets 100 --min-solid-angle nan", "--min-solid-angle");
  refused("improve --target-tets=5", "--target-tets");
  refused("improve --schedule=paper", "--schedule");
  refused("simplify --target-tets 100 --schedule fast", "'fast' is not one of tuned, paper");
  refused("simplify --target-tets 100 --objective ''", "is not one of both");
  refused("simplify --target-tets 385", "above the 384 tets");
  refused("simplify --target-tets 100 --only-below=0.1", "--only-below");
  EXPECT_EQ(run("improve " + (f / "m.vtu") + " -o " + (f / "o.xyz")).status, 2);
  EXPECT_EQ(f.entries(), 1u);
}

TEST(Improve, MeshesThatMakeNoSenseAreStatusThree) {
  const TemporaryFolder f;
  const auto medit = [](const std::string& points, int tets, const std::string& ids) {
    return "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n" + points + "Tetrahedra\n" +
           std::to_string(tets) + "\n" + ids + "End\n";
  };
  const std::string points = "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 2 0\n";
  put(f / "none.mesh", medit(points, 0, ""));
  put(f / "nan.mesh", medit("0 0 nan 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 2 0\n", 1, "1 2 3 4 1\n"));
  put(f / "range.mesh", medit(points, 1, "1 2 3 9 1\n"));
  put(f / "shared.mesh",
      medit("0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 2 0\n", 3, "1 2 3 4 1\n1 2 3 5 1\n1 2 3 4 1\n"));
  for (const char* name : {"none.mesh", "nan.mesh", "range.mesh", "shared.mesh"})
    for (const char* call : {"improve ", "simplify --target-tets 1 "}) {
      const Answer a = run(call + (f / name) + " -o " + (f / "o.vtu"));
      EXPECT_EQ(a.status, 3) << call << name << a.err;
      EXPECT_NE(a.err.find(name), std::string::npos) << a.err;
      EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
    }
  EXPECT_EQ(f.entries(), 4u);
}

TEST(Simplify, ATargetThatTopologyForbidsSaysWhichRules) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample layers -o " + (f / "m.vtu")).status, 0);
  const Answer a = run("simplify " + (f / "m.vtu") + " -o " + (f / "o.vtu") + " --target-tets 4 --stats " +
                       (f / "s.json"));
  EXPECT_EQ(a.status, 1) << a.err;
  EXPECT_NE(a.err.find("short of --target-tets: 4 requested"), std::string::npos) << a.err;
  EXPECT_NE(a.err.find("limited by: "), std::string::npos) << a.err;
  EXPECT_NE(a.err.find(" %"), std::string::npos) << a.err;
  const std::string rules = json_of(f / "s.json")["shortfall"][0]["held_back_by"];
  EXPECT_NE(a.err.find(rules), std::string::npos) << rules;
  EXPECT_EQ(run("check " + (f / "o.vtu") + " --before " + (f / "m.vtu")).status, 0);
  // The number of iterations is also a limit.
  const Answer b =
      run("simplify " + (f / "m.vtu") + " -o " + (f / "o.vtu") + " --target-tets 4 --max-iterations 1");
  EXPECT_EQ(b.status, 1);
  EXPECT_NE(b.err.find("max_iterations"), std::string::npos) << b.err;
}

TEST(Simplify, BothSchedulesReachTheTarget) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample torus -o " + (f / "t.ply")).status, 0);
  for (const char* schedule : {"tuned", "paper"}) {
    const Answer a =
        run("prepare " + (f / "t.ply") + " -o " + (f / "o.mesh") + " --target-tets 3000 --accept-changes" +
            " --objective solid-angle --schedule " + schedule + " --stats " + (f / "s.json"));
    EXPECT_EQ(a.status, 0) << a.err;
    const auto j = json_of(f / "s.json");
    EXPECT_EQ(j["schedule"], schedule);
    EXPECT_EQ(j["objective"], "solid-angle");
    EXPECT_EQ(run("check " + (f / "o.mesh")).status, 0);
  }
}

}  // namespace
}  // namespace tetwright::improve_test
