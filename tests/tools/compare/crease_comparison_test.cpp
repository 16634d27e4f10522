// SPDX-License-Identifier: Apache-2.0

// Tests whether a mesh has the creases of its input, and what the program reports about them.
#include "tetwright/compare.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/random.h"
#include "tests/simplify/meshes.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::crease_comparison_test {
namespace {

TetMesh cube_with_patches() {
  TetMesh mesh = grid_mesh(4);
  EXPECT_EQ(find_mesh_patches(mesh, {}, "mesh").count, 6U);
  return mesh;
}

TEST(CreaseComparison, MeasuresFromThePlacesOfTheInput) {
  const TetMesh mesh = cube_with_patches();
  CreaseCurves creases = mesh_creases(mesh);
  CreaseComparison same = compare_creases(creases, mesh);
  EXPECT_TRUE(same.same());
  EXPECT_NEAR(same.diagonal, 4 * std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(same.length, 12 * 4, 1e-9);
  EXPECT_EQ(same.max_distance, 0);
  EXPECT_EQ(same.corners, 8U);
  EXPECT_EQ(same.lost_corners, 0U);
  // A crease across a side, which the mesh does not have.
  const auto first = static_cast<Index>(creases.points.size());
  creases.points.emplace_back(2, 0, 0);
  creases.points.emplace_back(2, 4, 0);
  creases.segments.push_back({first, first + 1});
  creases.corners.emplace_back(2.5, 2.5, 0);
  const CreaseComparison other = compare_creases(creases, mesh);
  EXPECT_FALSE(other.same());
  EXPECT_NEAR(other.max_distance, 2, 1e-2);
  EXPECT_NEAR((other.place - Vec3(2, 2, 0)).norm(), 0, 1e-2);
  EXPECT_GT(other.p99_distance, 1);
  EXPECT_EQ(other.lost_corners, 1U);
  EXPECT_NEAR((other.lost_corner - Vec3(2.5, 2.5, 0)).norm(), 0, 1e-12);
  // For a mesh without creases the distance is the diagonal.
  TetMesh smooth = mesh;
  for (InterfaceTriangle& t : smooth.interfaces) t.patch = 0;
  EXPECT_EQ(compare_creases(mesh_creases(mesh), smooth).max_distance, same.diagonal);
}

TEST(CreaseComparison, BoundsWhatLiesBetweenTheMeasuredPlaces) {
  // A crease with a gap that contains no sample: its middle is 1.2e-4 from both ends.
  CreaseCurves expected, found;
  expected.points = {{0, 0, 0}, {1, 0, 0}};
  expected.segments = {{0, 1}};
  found.points = {{0, 0, 0}, {0.00013, 0, 0}, {0.00037, 0, 0}, {1, 0, 0}};
  found.segments = {{0, 1}, {2, 3}};
  const CreaseComparison c = compare_creases(expected, {found}, {}, 1);
  EXPECT_GE(c.max_distance, 0.00012);
  EXPECT_LE(c.max_distance, 0.00012 + 2e-6);
  found.segments = {{0, 3}};
  EXPECT_LE(compare_creases(expected, {found}, {}, 1).max_distance, 1e-15);
}

TEST(CreaseComparison, IsSaidOfPartsAndNotOfScans) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample cube -o " + (f / "cube.off")).status, 0);
  const std::string call = "prepare " + (f / "cube.off") + " -o " + (f / "o.vtu") + " --stats " +
                           (f / "s.json") + " --target-tets 1000 --resolution 16";
  Answer a = run(call);
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.out.find("features of 'cube': 6 patches with sharp edges between them"), std::string::npos)
      << a.out;
  EXPECT_NE(a.out.find("8 of 8 corners"), std::string::npos) << a.out;
  auto stats = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_EQ(stats["features"][0]["verdict"], "part");
  EXPECT_EQ(stats["features"][0]["patches"], 6);
  EXPECT_TRUE(stats["creases"]["same"]);
  EXPECT_LT(stats["creases"]["max_distance"].get<double>(), 1e-8);
  EXPECT_NEAR(stats["result"]["volume"].get<double>(), 8, 1e-5);

  a = run(call + " --feature-angle off");
  EXPECT_EQ(a.status, 0) << a.err;
  stats = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_EQ(stats["features"][0]["verdict"], "off");
  EXPECT_FALSE(stats.contains("creases"));
  EXPECT_GT(std::fabs(stats["result"]["volume"].get<double>() - 8), 1e-3);

  // Tet meshes keep their features in the same way.
  ASSERT_EQ(run("mesh " + (f / "cube.off") + " --resolution 16 -o " + (f / "dense.vtu")).status, 0);
  a = run("simplify " + (f / "dense.vtu") + " --target-tets 500 -o " + (f / "o.vtu") + " --stats " +
          (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  stats = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_EQ(stats["features"][0]["patches"], 6);
  EXPECT_EQ(stats["creases"]["corners"], 8);
  EXPECT_EQ(stats["creases"]["lost_corners"], 0);

  ASSERT_EQ(run("sample sphere -o " + (f / "ball.off")).status, 0);
  a = run("mesh " + (f / "ball.off") + " --resolution 16 -o " + (f / "o.vtu") + " --stats " + (f / "s.json"));
  EXPECT_NE(a.out.find("features of 'ball': none; no edge is sharp enough"), std::string::npos) << a.out;
  stats = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_EQ(stats["features"][0]["verdict"], "smooth");

  // Few edges turn by much, and most of them do not meet another one.
  TriangleMesh scan = read_surface(f / "ball.off");
  Random random(3);
  for (Vec3& p : scan.points) p *= 1 + 0.025 * (random.uniform() - 0.5);
  write_surface(scan, f / "scan.off");
  a = run("mesh " + (f / "scan.off") + " --resolution 8 -o " + (f / "o.vtu") + " --stats " + (f / "s.json"));
  stats = nlohmann::json::parse(contents(f / "s.json"));
  const double loose = stats["features"][0]["loose_ends"][1];
  EXPECT_GT(loose, 1);
  // Edges have two ends.
  char said[80];
  std::snprintf(said, sizeof said,
                " %% of the ends of edges over 15 degrees, %.3g %% of those over 35 are loose)", 50 * loose);
  EXPECT_NE(a.out.find(said), std::string::npos) << a.out;

  ASSERT_EQ(run("sample organs -o " + (f / "organs.nrrd")).status, 0);
  a = run("mesh " + (f / "organs.nrrd") + " --feature-angle 30 -o " + (f / "o.vtu"));
  EXPECT_EQ(a.status, 2);
  EXPECT_NE(a.err.find("--feature-angle is for surfaces and tet meshes"), std::string::npos) << a.err;
}

TEST(CreaseComparison, LostCreasesAreAShortfall) {
  // A ridge so low that it is found only with an angle of two degrees, in cells six times as high.
  const TemporaryFolder f;
  std::ofstream(f / "wedge.off") << "OFF\n6 5 9\n0 0 0\n1 0 0\n0.5 0.02 0\n0 0 1\n1 0 1\n0.5 0.02 1\n"
                                    "3 0 2 1\n3 3 4 5\n4 0 1 4 3\n4 1 2 5 4\n4 2 0 3 5\n";
  const Answer a = run("mesh " + (f / "wedge.off") + " -o " + (f / "o.vtu") +
                       " --resolution 8 --feature-angle 2" + " --max-refinement 0 --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 1) << a.err;
  EXPECT_NE(a.err.find("creases are off by up to "), std::string::npos) << a.err;
  const auto stats = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_TRUE(std::any_of(stats["shortfall"].begin(), stats["shortfall"].end(),
                          [](const auto& s) { return s["what"] == "creases"; }));
}

/// A cube of eight quads.
void put_cube(const std::string& path, double low, double high, double shift) {
  std::ofstream out(path);
  out << "OFF\n8 6 12\n";
  for (int i = 0; i < 8; ++i)
    out << (i & 1 ? high : low) + shift << ' ' << (i & 2 ? high : low) << ' ' << (i & 4 ? high : low) << '\n';
  out << "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
}

TEST(CreaseComparison, KnowsWhatCarvesAndWhatTouches) {
  const TemporaryFolder f;
  put_cube(f / "a.off", 0, 1, 0);
  put_cube(f / "b.off", 0, 1, 1);        // touches the first one
  put_cube(f / "c.off", 0.2, 0.8, 0.5);  // carves the first one
  for (const char* other : {"b.off", "c.off"}) {
    const Answer a = run("mesh " + (f / "a.off") + " --material b=" + (f / other) + " --resolution 20 -o " +
                         (f / "o.vtu"));
    EXPECT_EQ(a.err.find("creases are off"), std::string::npos) << a.err;
  }
  // Where parts of one surface overlap, the curves in which they cross are creases.
  std::ofstream(f / "both.off") << [&] {
    const auto points = [](double shift) {
      std::string text;
      for (int i = 0; i < 8; ++i)
        text += std::to_string((i & 1) + shift) + ' ' + std::to_string((i >> 1 & 1) + shift) + ' ' +
                std::to_string((i >> 2) + shift) + '\n';
      return text;
    };
    std::string text = "OFF\n16 12 24\n" + points(0) + points(0.4);
    for (const int k : {0, 8})
      for (const auto& q :
           {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
        text += "4 " + std::to_string(q[0] + k) + ' ' + std::to_string(q[1] + k) + ' ' +
                std::to_string(q[2] + k) + ' ' + std::to_string(q[3] + k) + '\n';
    return text;
  }();
  const Answer a = run("mesh " + (f / "both.off") + " --resolution 20 -o " + (f / "o.vtu"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.out.find("12 patches with sharp edges"), std::string::npos) << a.out;
  EXPECT_NE(a.out.find("20 of 20 corners"), std::string::npos) << a.out;
}

}  // namespace
}  // namespace tetwright::crease_comparison_test
