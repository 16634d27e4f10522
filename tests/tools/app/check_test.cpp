// SPDX-License-Identifier: Apache-2.0

// Tests the output and the exit status of `check`.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/program.h"

namespace tetwright::check_test {
namespace {

/// A Medit file of five points and one tet, which is given by its vertices, from 1. The last point is far
/// away.
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
  // Commands that change such a mesh remove the point.
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

/// Surface of a box with one corner at the origin, as an OFF file.
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
  // A quarter is missing at one end, so the largest distance from the surface to the mesh is 0.25. The mesh's
  // end is half way between the surface's sides, and no farther from them than from the surface's end.
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
  EXPECT_NE(words.out.find("not within the tolerance of 0.2: the mesh is up to 0.25"), std::string::npos)
      << words.out;
  EXPECT_NE(words.out.find("distance of the surface from the mesh: at most 0.25"), std::string::npos)
      << words.out;
  EXPECT_TRUE(words.out.ends_with("\nvalid, but not within the tolerance\n")) << words.out;
  // --quiet prints only shortfalls.
  const Answer quiet = run(check + (f / "longer.off") + " --tolerance 0.2 --quiet");
  EXPECT_EQ(quiet.status, 1);
  EXPECT_EQ(quiet.out, "");
  EXPECT_TRUE(quiet.err.starts_with("tetwright: not within the tolerance of 0.2: the mesh is up to 0.25"))
      << quiet.err;
  EXPECT_EQ(run(check + (f / "box.off") + " --tolerance 0.2 --quiet").err, "");
}

/// Points of a prism with ten sides, whose edges turn by 36 degrees; the first one turns by less if `first`
/// is below 1. The points of the axis come last.
std::string decagon_points(double first, const std::string& after) {
  std::string text;
  for (int z = 0; z < 2; ++z)
    for (int i = 0; i < 10; ++i) {
      const double angle = i * std::numbers::pi / 5, radius = i == 0 ? first : 1;
      text += std::to_string(radius * std::cos(angle)) + " " + std::to_string(radius * std::sin(angle)) +
              " " + std::to_string(z) + after + "\n";
    }
  return text + "0 0 0" + after + "\n0 0 1" + after + "\n";
}

std::string decagon_off() {
  std::string text = "OFF\n22 40 0\n" + decagon_points(1, "");
  for (int i = 0; i < 10; ++i) {
    const int j = (i + 1) % 10;
    for (const std::array<int, 3>& t :
         {std::array{i, j, 10 + j}, {i, 10 + j, 10 + i}, {20, j, i}, {21, 10 + i, 10 + j}})
      text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  }
  return text;
}

std::string decagon_mesh(double first) {
  std::string text = "MeshVersionFormatted 2\nDimension 3\nVertices\n22\n" + decagon_points(first, " 0") +
                     "Tetrahedra\n30\n";
  for (int i = 0; i < 10; ++i) {
    const int b = i, c = (i + 1) % 10;
    for (const std::array<int, 4>& t :
         {std::array{20, b, c, 10 + c}, {20, b, 10 + c, 10 + b}, {20, 10 + b, 10 + c, 21}}) {
      for (const int p : t) text += std::to_string(p + 1) + " ";
      text += "7\n";
    }
  }
  return text + "End\n";
}

TEST(Check, ACreaseIsNotLostForADegree) {
  const TemporaryFolder f;
  put(f / "decagon.off", decagon_off());
  put(f / "decagon.mesh", decagon_mesh(0.99));
  const std::string check = "check " + (f / "decagon.mesh") + " --surface " + (f / "decagon.off");
  const Answer same = run(check + " --json --tolerance 0.011");
  EXPECT_EQ(same.status, 0) << same.out;
  const auto creases = nlohmann::json::parse(same.out)["surface"]["creases"];
  EXPECT_NEAR(creases["max_distance"], 0.01, 1e-4);
  EXPECT_EQ(creases["corners"], 20);
  // The distance is larger than this; the message names the bound that fails and its location.
  const Answer far = run(check + " --tolerance 0.005");
  EXPECT_EQ(far.status, 1);
  for (const char* said :
       {"not within the tolerance of 0.005: the mesh is up to 0.009", "; the surface is up to 0.01",
        "; creases of the surface are up to 0.01 from those of the mesh, at (1, 0, ",
        "; corners of the surface are up to 0.01 from points of the mesh, at (1, 0, 0)\n",
        "; 2 of its 20 corners lost, at most 0.01 "})
    EXPECT_NE(far.out.find(said), std::string::npos) << far.out << "lacks: " << said;
}

TEST(Check, AMeshWithoutTheCreasesIsNotWithinAnyTolerance) {
  const TemporaryFolder f;
  put(f / "cube.off", box_off(1, 1, 1));
  ASSERT_EQ(run("sample sphere -o " + (f / "ball.off")).status, 0);
  ASSERT_EQ(run("mesh " + (f / "ball.off") + " -o " + (f / "ball.vtu") + " --resolution 20").status, 0);
  const std::string check = "check " + (f / "ball.vtu") + " --surface " + (f / "cube.off");
  const Answer answer = run(check + " --tolerance 1.7");
  EXPECT_EQ(answer.status, 1);
  EXPECT_NE(answer.out.find("not within the tolerance of 1.7: the mesh has none of the creases"),
            std::string::npos)
      << answer.out;
  EXPECT_TRUE(
      nlohmann::json::parse(run(check + " --json").out)["surface"]["creases"]["max_distance"].is_null());
}

TEST(Check, EqualPointsOfASurfaceAreJoined) {
  // A box whose triangles have separate points; some are oriented inwards.
  const TemporaryFolder f;
  const std::string box = box_off(2, 1, 1);
  std::istringstream in(box);
  std::string line;
  std::getline(in, line);
  std::getline(in, line);
  std::vector<std::string> points(8);
  for (std::string& p : points) std::getline(in, p);
  std::string soup = "OFF\n36 12 0\n", triangles;
  for (int t = 0; t < 12; ++t) {
    int n = 0;
    std::array<std::size_t, 3> p{};
    in >> n >> p[0] >> p[1] >> p[2];
    for (const std::size_t k : p) soup += points[k] + "\n";
    const int first = 3 * t, turn = t % 2;
    triangles += "3 " + std::to_string(first) + " " + std::to_string(first + 1 + turn) + " " +
                 std::to_string(first + 2 - turn) + "\n";
  }
  put(f / "soup.off", soup + triangles);
  put(f / "box.off", box);
  ASSERT_EQ(run("mesh " + (f / "box.off") + " -o " + (f / "box.vtu") + " --resolution 8").status, 0);
  const std::string check = "check " + (f / "box.vtu") + " --surface " + (f / "soup.off");
  const auto surface = nlohmann::json::parse(run(check + " --json").out)["surface"];
  EXPECT_TRUE(surface["solid"]["same"]) << surface;
  EXPECT_NEAR(surface["solid"]["expected"]["volume"], 2, 1e-9);
  EXPECT_EQ(surface["creases"]["corners"], 8);
  EXPECT_LT(surface["creases"]["max_distance"], 1e-5);
}

TEST(Check, ASurfaceWithoutExtentIsRefused) {
  const TemporaryFolder f;
  put(f / "tet.mesh", medit("1 2 3 4"));
  put(f / "point.off", "OFF\n3 1 0\n0 0 0\n0 0 0\n0 0 0\n3 0 1 2\n");
  const auto scaled = [](const char* size) {
    const std::string s = size;
    return "OFF\n4 4 0\n0 0 0\n" + s + " 0 0\n0 " + s + " 0\n0 0 " + s +
           "\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
  };
  put(f / "tiny.off", scaled("1e-200"));
  put(f / "huge.off", scaled("1e200"));
  const std::string check = "check " + (f / "tet.mesh") + " --surface ";
  expect_refused(check + (f / "point.off"), 3, {"point.off: all triangles are flat"});
  expect_refused(check + (f / "tiny.off"), 3, {"tiny.off: ", "scale the surface to between 1e-50 and 1e50"});
  expect_refused(check + (f / "huge.off"), 3, {"huge.off: ", "scale the surface to between 1e-50 and 1e50"});
}

TEST(Check, TheOutsideThatIsKeptIsNotCompared) {
  const TemporaryFolder f;
  put(f / "box.off", box_off(2, 1, 1));
  ASSERT_EQ(
      run("mesh " + (f / "box.off") + " -o " + (f / "box.vtu") + " --resolution 16 --keep-outside").status,
      0);
  const Answer a = run("check " + (f / "box.vtu") + " --tolerance 1% --surface " + (f / "box.off"));
  EXPECT_EQ(a.status, 0) << a.out;
  EXPECT_NE(a.out.find("not compared with the surface: the "), std::string::npos) << a.out;
  EXPECT_NE(a.out.find("of the surface 2; same components, handles and cavities"), std::string::npos)
      << a.out;
}

TEST(Check, AnInvertedMeshIsNotAnotherSolid) {
  const TemporaryFolder f;
  put(f / "tet.off", tetrahedron_off);
  put(f / "tet.mesh", medit("1 3 2 4"));
  const Answer a = run("check " + (f / "tet.mesh") + " --tolerance 1% --surface " + (f / "tet.off"));
  EXPECT_EQ(a.status, 1);
  for (const char* said :
       {"all tets are inverted; compared with the surface as if their orientation were reversed",
        "same components, handles and cavities", "\nwithin the tolerance"})
    EXPECT_NE(a.out.find(said), std::string::npos) << a.out << "lacks: " << said;
}

TEST(Check, CapsAreLeftOutAndReported) {
  // A box without its top face, which the mesh closes.
  const TemporaryFolder f;
  const std::string box = box_off(2, 1, 1), first = "3 4 5 6\n3 5 7 6\n";
  std::string open = box;
  open.replace(open.find("8 12 0"), 6, "8 10 0");
  open.erase(open.find(first), first.size());
  put(f / "box.off", box);
  put(f / "open.off", open);
  ASSERT_EQ(run("mesh " + (f / "box.off") + " -o " + (f / "box.vtu") + " --resolution 8").status, 0);
  const std::string check = "check " + (f / "box.vtu") + " --tolerance 1% --surface " + (f / "open.off");
  const Answer a = run(check);
  EXPECT_EQ(a.status, 0) << a.out;
  EXPECT_NE(
      a.out.find("the surface is open: 4 edges with one triangle; caps of the mesh are left out, area "),
      std::string::npos)
      << a.out;
  EXPECT_NE(a.out.find("\nwithin the tolerance of 0.0244949; caps, 20 % of the mesh's area, are left out\n"),
            std::string::npos)
      << a.out;
  const auto caps = nlohmann::json::parse(run(check + " --json").out)["surface"]["caps"];
  EXPECT_NEAR(caps["area"], 2, 0.02);
  EXPECT_NEAR(caps["share"], 0.2, 0.002);
  EXPECT_NEAR(caps["upper"], 0.5, 0.01);
  // If most of the mesh is beyond the rim, the surface does not belong to the mesh.
  put(f / "patch.off", "OFF\n4 2 0\n0 0 0\n0 0 1\n0 1 0\n0 1 1\n3 0 1 2\n3 1 3 2\n");
  const Answer patch = run("check " + (f / "box.vtu") + " --tolerance 1 --surface " + (f / "patch.off"));
  EXPECT_EQ(patch.status, 1) << patch.out;
  EXPECT_NE(patch.out.find("most of the mesh has no counterpart on the surface: "), std::string::npos)
      << patch.out;
  // Deviations that are not beyond a rim count: the bottom face is moved.
  put(f / "lower.off", [&] {
    std::string text = open;
    for (const std::string from : {"0.000000\n"})
      for (std::size_t at = 0; (at = text.find(" " + from, at)) != std::string::npos;) {
        text.replace(at, from.size() + 1, " -0.100000\n");
        at += 11;
      }
    return text;
  }());
  EXPECT_EQ(run("check " + (f / "box.vtu") + " --tolerance 0.05 --surface " + (f / "lower.off")).status, 1);
  EXPECT_EQ(run("check " + (f / "box.vtu") + " --tolerance 0.11 --surface " + (f / "lower.off")).status, 0);
}

TEST(Check, AToleranceSmallerThanDistancesAreKnownIsRefused) {
  const TemporaryFolder f;
  put(f / "tet.off", tetrahedron_off);
  put(f / "tet.mesh", medit("1 2 3 4"));
  expect_refused("check " + (f / "tet.mesh") + " --tolerance 1e-5 --surface " + (f / "tet.off"), 2,
                 {"--tolerance 1e-05 is below the accuracy", "give 0.000173205 or more"});
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
