// SPDX-License-Identifier: Apache-2.0

// Tests --tolerance of prepare, simplify and mesh.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace tetwright::tolerance_test {
namespace {

class Tolerance : public testing::Test {
 protected:
  Tolerance() { EXPECT_EQ(run("sample sphere -o " + surface).status, 0); }
  TemporaryFolder f;
  const std::string surface = f / "s.ply", out = f / "o.vtu", stats = f / "s.json";

  nlohmann::json work(const std::string& command, const std::string& options) {
    const Answer a = run(command + " -o " + out + " --stats " + stats + " " + options);
    EXPECT_EQ(a.status, 0) << a.err;
    return nlohmann::json::parse(contents(stats));
  }
};

TEST_F(Tolerance, TakesAsFewTetsAsHoldItAllWellShaped) {
  std::size_t last = 0;
  for (const char* share : {"3%", "1%"}) {
    const auto j =
        work("prepare " + surface, std::string("--resolution 40 --accept-changes --tolerance ") + share);
    EXPECT_TRUE(j["tolerance"]["held"]);
    EXPECT_GE(j["result"]["min_solid_angle"], 0.1);
    EXPECT_GT(j["result"]["tets"], last) << share;
    last = j["result"]["tets"];
    EXPECT_LT(last, 2000U) << share;
    // `check` of the file reports the same.
    EXPECT_EQ(run("check " + out + " --surface " + surface + " --tolerance " + share).status, 0);
  }
}

TEST_F(Tolerance, LargerThanTheBodyCostsNoTets) {
  const std::size_t few =
      work("prepare " + surface, "--resolution 24 --accept-changes --tolerance 10%")["result"]["tets"];
  EXPECT_LE(
      work("prepare " + surface, "--resolution 24 --accept-changes --tolerance 1e300")["result"]["tets"],
      few);
}

TEST_F(Tolerance, OfADenseMeshChoosesItsCells) {
  const auto j = work("mesh " + surface, "--tolerance 0.3%");
  const double asked = j["tolerance"]["distance"];
  EXPECT_LE(j["tolerance"]["from_mesh"]["upper"], 0.6 * asked);
  EXPECT_LE(j["tolerance"]["from_surface"]["upper"], 0.6 * asked);
  const auto coarser = work("mesh " + surface, "--tolerance 5%");
  EXPECT_LT(coarser["result"]["tets"], j["result"]["tets"]);
}

TEST_F(Tolerance, CapsAreComparedApart) {
  // A box without its lid and one side: the cap is bent. Without its lid only, it is part of the surface.
  const auto apart_area = [&](const std::string& triangles) {
    put(f / "open.off", "OFF\n8 " + triangles.substr(0, 2) +
                            " 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n" +
                            triangles.substr(3));
    const auto j = work("prepare " + (f / "open.off"), "--tolerance 3% --target-tets 800 --resolution 24");
    EXPECT_EQ(j["tolerance"]["hidden_area"], 0);
    return j["tolerance"]["apart_area"].get<double>();
  };
  const std::string four = "3 0 2 1\n3 0 3 2\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n";
  EXPECT_NEAR(apart_area("8  " + four), 1.6, 0.5);
  EXPECT_EQ(apart_area("10 " + four + "3 3 0 4\n3 3 4 7\n"), 0);
}

TEST_F(Tolerance, OfADenseMeshOfAVolumeIsRefused) {
  ASSERT_EQ(run("sample organs -o " + (f / "v.nrrd")).status, 0);
  const Answer a = run("mesh " + (f / "v.nrrd") + " -o " + out + " --tolerance 1%");
  EXPECT_EQ(a.status, 2);
  EXPECT_NE(a.err.find("prepare --tolerance"), std::string::npos) << a.err;
}

TEST_F(Tolerance, BoundsOfEdgesThatBindNothingLeaveTheCount) {
  const auto j = work("prepare " + surface, "--target-tets 900 --max-edge 1e30 --min-edge 1e-30");
  EXPECT_NEAR(j["result"]["tets"].get<double>(), 900, 9);
}

TEST_F(Tolerance, MaxEdgeHoldsBelowASizeField) {
  put(f / "size.vtk",
      "# vtk DataFile Version 3.0\nsizes\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
      "-9 -9 -9\n27 -9 -9\n-9 27 -9\n-9 -9 27\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"
      "POINT_DATA 4\nSCALARS size double 1\nLOOKUP_TABLE default\n0.5\n0.5\n0.5\n0.5\n");
  const auto j = work("prepare " + surface, "--size-field " + (f / "size.vtk") + " --max-edge 0.35");
  EXPECT_LE(j["edge_lengths"]["longest"], 0.35);
}

TEST_F(Tolerance, AnOutsideThatIsNotShownIsAShortfall) {
  // A box with a bore far narrower than a cell, which the mesh closes.
  constexpr int rings = 9;
  std::string text;
  int points = 0, triangles = 0;
  const auto ring = [&](double side, double z) {
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      text += std::to_string(x * side) + " " + std::to_string(y * side) + " " + std::to_string(z) + "\n";
      ++points;
    }
  };
  ring(1, -1);
  ring(1, 1);
  for (int k = 0; k < rings; ++k) ring(0.003, -1 + 2.0 * k / (rings - 1));
  const auto quad = [&](int a, int b, int c, int d) {
    for (const std::array<int, 3>& t : {std::array{a, b, c}, {a, c, d}}) {
      text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
      ++triangles;
    }
  };
  constexpr int lowest = 8, highest = 8 + 4 * (rings - 1);
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    quad(i, j, 4 + j, 4 + i);
    quad(i, lowest + i, lowest + j, j);
    quad(4 + j, highest + j, highest + i, 4 + i);
    for (int k = lowest; k < highest; k += 4) quad(k + j, k + i, k + 4 + i, k + 4 + j);
  }
  text = "OFF\n" + std::to_string(points) + " " + std::to_string(triangles) + " 0\n" + text;
  put(f / "bore.off", text);
  const Answer a =
      run("prepare " + (f / "bore.off") + " -o " + (f / "o.vtu") +
          " --tolerance 5% --resolution 16 --max-refinement 0 --accept-changes --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 1) << a.err;
  EXPECT_NE(a.err.find("the mesh lacks an area of "), std::string::npos) << a.err;
  EXPECT_FALSE(nlohmann::json::parse(contents(f / "s.json"))["tolerance"]["held"]);
}

}  // namespace
}  // namespace tetwright::tolerance_test
