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

}  // namespace
}  // namespace tetwright::check_test
