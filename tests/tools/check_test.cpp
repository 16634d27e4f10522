// `check`: what it prints, and its exit status.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace tetwright::check_test {
namespace {

/// A Medit file of one tet, given by its vertices from 1, and five points, of which the last is far away.
std::string medit(const std::string& tet) {
  return "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n5 5 5 0\n"
         "Tetrahedra\n1\n" +
         tet + " 7\nEnd\n";
}

TEST(Check, FindingsAreInWords) {
  const TemporaryFolder f;
  put(f / "bad.mesh", medit("1 3 2 4"));
  const Answer a = run("check " + (f / "bad.mesh"));
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.out.find("error: inverted or flat tets (inverted): 1, at tet 0 (0 2 1 3)\n"), std::string::npos)
      << a.out;
  EXPECT_NE(a.out.find("warning: points that no tet uses (unused_points): 1, at point 4 at 5 5 5\n"),
            std::string::npos)
      << a.out;
  EXPECT_NE(a.out.find("\nnot valid\n"), std::string::npos) << a.out;
}

TEST(Check, AnUnusedPointIsAWarning) {
  const TemporaryFolder f;
  put(f / "spare.mesh", medit("1 2 3 4"));
  const Answer a = run("check " + (f / "spare.mesh"));
  EXPECT_EQ(a.status, 0) << a.out;
  EXPECT_EQ(a.out.rfind("warning: points that no tet uses", 0), 0u) << a.out;
  EXPECT_NE(a.out.find("\nvalid\n"), std::string::npos) << a.out;
  const Answer json = run("check --json " + (f / "spare.mesh"));
  EXPECT_EQ(json.status, 0);
  const auto j = nlohmann::json::parse(json.out);
  EXPECT_TRUE(j["valid"]);
  ASSERT_EQ(j["findings"].size(), 1u);
  EXPECT_EQ(j["findings"][0]["number"], 6);
  EXPECT_EQ(j["findings"][0]["name"], "unused_points");
  EXPECT_EQ(j["findings"][0]["severity"], "warning");
  EXPECT_EQ(j["mesh"]["tets"], 1);
  // Commands that change such a mesh leave the point out.
  ASSERT_LE(run("improve " + (f / "spare.mesh") + " -o " + (f / "out.vtu")).status, 1);
  EXPECT_EQ(run("check " + (f / "out.vtu")).out.find("warning"), std::string::npos);
}

TEST(Check, UnsoundArraysHaveNoStatistics) {
  const TemporaryFolder f;
  put(f / "flat.node", "4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  put(f / "flat.ele", "1 4\n0 0 1 2 2\n");
  const auto degenerate = nlohmann::json::parse(run("check --json " + (f / "flat.node")).out);
  EXPECT_FALSE(degenerate["valid"]);
  EXPECT_EQ(degenerate["findings"][0]["severity"], "error");
  EXPECT_TRUE(degenerate.contains("mesh"));
}

/// The surface of a box from the origin, as an OFF file.
std::string box_off(double x, double y, double z) {
  std::string text = "OFF\n8 12 0\n";
  for (int k = 0; k < 8; ++k)
    text += std::to_string(k & 1 ? x : 0) + " " + std::to_string(k & 2 ? y : 0) + " " +
            std::to_string(k & 4 ? z : 0) + "\n";
  return text +
         "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 6\n"
         "3 1 3 5\n3 3 7 5\n";
}

TEST(Check, DistancesFromASurfaceAreProven) {
  const TemporaryFolder f;
  put(f / "box.off", box_off(2, 1, 1));
  put(f / "longer.off", box_off(2.25, 1, 1));
  ASSERT_EQ(
      run("prepare " + (f / "box.off") + " -o " + (f / "box.vtu") + " --target-tets 300 --quiet").status, 0);
  const std::string check = "check " + (f / "box.vtu") + " --surface ";
  const auto same = nlohmann::json::parse(run(check + (f / "box.off") + " --json --tolerance 0.1%").out);
  EXPECT_TRUE(same["tolerance"]["held"]);
  EXPECT_LT(same["surface"]["from_mesh"]["upper"], 3e-5);
  EXPECT_LT(same["surface"]["from_surface"]["upper"], 3e-5);
  EXPECT_TRUE(same["surface"]["solid"]["same"]);
  EXPECT_LT(same["surface"]["creases"]["max_distance"], 1e-5);
  EXPECT_EQ(same["surface"]["creases"]["corners"], 8);
  // A quarter is missing at one end: 0.25 from the surface to the mesh; the mesh's end is half way between
  // the surface's sides, and no farther from them than from the surface's end.
  const Answer answer = run(check + (f / "longer.off") + " --json --tolerance 0.2");
  EXPECT_EQ(answer.status, 1);
  const auto longer = nlohmann::json::parse(answer.out);
  EXPECT_FALSE(longer["tolerance"]["held"]);
  for (const char* way : {"from_mesh", "from_surface"}) {
    EXPECT_NEAR(longer["surface"][way]["lower"], 0.25, 1e-4) << way;
    EXPECT_NEAR(longer["surface"][way]["upper"], 0.25, 0.0026) << way;
  }
  EXPECT_FALSE(longer["surface"]["solid"]["same"]);
  EXPECT_EQ(run(check + (f / "longer.off") + " --tolerance 0.26").status, 0);
  const Answer words = run(check + (f / "longer.off") + " --tolerance 0.2");
  EXPECT_NE(words.out.find("not within the tolerance of 0.2\n"), std::string::npos) << words.out;
  EXPECT_NE(words.out.find("distance of the surface from the mesh: at most 0.25"), std::string::npos)
      << words.out;
}

TEST(Check, AToleranceNeedsASurface) {
  const TemporaryFolder f;
  put(f / "tet.mesh", medit("1 2 3 4"));
  const Answer a = run("check " + (f / "tet.mesh") + " --tolerance 1");
  EXPECT_EQ(a.status, 2);
  EXPECT_NE(a.err.find("give --surface FILE"), std::string::npos) << a.err;
  EXPECT_EQ(run("check " + (f / "tet.mesh") + " --surface " + (f / "none.off")).status, 3);
}

}  // namespace
}  // namespace tetwright::check_test
