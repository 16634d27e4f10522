// SPDX-License-Identifier: Apache-2.0

// Tests whether a mesh is the solid of its input, and what the program reports if it is not.
#include "tetwright/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/mesher/test_surfaces.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::solid_comparison_test {
namespace {

/// A tetrahedron of volume 1/6, as a mesh of one tet.
TetMesh one_tet() {
  TetMesh mesh;
  mesh.points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.materials = {1};
  mesh.interfaces = find_interfaces(mesh);
  return mesh;
}

ExpectedSolid expected(std::vector<SolidShell> shells) {
  ExpectedSolid e{.name = "part", .tag = 1, .shape = {}};
  e.shape.shells = std::move(shells);
  return e;
}

std::string difference(const ExpectedSolid& e) { return compare_solids({e}, one_tet()).at(0).difference; }

TEST(SolidComparison, ComparesVolumesAndCounts) {
  constexpr double v = 1.0 / 6;
  EXPECT_EQ(difference(expected({{.volume = v}})), "");
  EXPECT_EQ(difference(expected({{.volume = v * 1.0099}})), "");
  EXPECT_EQ(difference(expected({{.volume = v / 0.98}})), "volume 2 % less");
  EXPECT_EQ(difference(expected({{.volume = v / 1.5}})), "volume 50 % more");
  EXPECT_EQ(difference(expected({{.volume = 0}})),
            "1 component instead of 0, 0 cavities instead of 1, volume 0.166667 instead of 0");
  EXPECT_EQ(difference(expected({{.volume = v, .handles = 2}})), "0 handles instead of 2");
  EXPECT_EQ(difference(expected({{.volume = v * 0.999}, {.volume = v * 0.001}})), "1 component instead of 2");
  EXPECT_EQ(difference(expected({{.volume = v * 1.001}, {.volume = v * -0.001}})), "0 cavities instead of 1");
}

TEST(SolidComparison, NamesThePlaceAndLeavesOutWhatSaysNothing) {
  constexpr double v = 1.0 / 6;
  ExpectedSolid e = expected({{.volume = v * 0.999}, {.place = Vec3(1, 2, 3), .volume = v * 0.001}});
  EXPECT_EQ(compare_solids({e}, one_tet()).at(0).place, Vec3(1, 2, 3));
  e.min_volume = 0.01 * v;
  EXPECT_TRUE(compare_solids({e}, one_tet()).at(0).same());
  EXPECT_FALSE(compare_solids({e}, one_tet()).at(0).place);
}

TEST(SolidComparison, WhatAFlawedSurfaceSaysIsAnEstimateOfTwo) {
  constexpr double v = 1.0 / 6;
  ExpectedSolid e = expected({{.volume = v, .handles = 1}});
  EXPECT_TRUE(compare_solids({e}, one_tet()).at(0).certain);
  // With the distances only, nothing is certain.
  e.flaw = SurfaceFlaw::intersecting;
  const auto compared = [&] { return compare_solids({e}, one_tet()).at(0); };
  EXPECT_FALSE(compared().same());
  EXPECT_FALSE(compared().certain);
  EXPECT_EQ(compared().against, SolidComparison::Against::distances);
  // The result agrees with the surface.
  e.by_flawed_surface.emplace().shells = {{.volume = v}};
  EXPECT_TRUE(compared().same());
  EXPECT_FALSE(compared().certain);
  EXPECT_EQ(compared().against, SolidComparison::Against::surface);
  // The result agrees with neither of them.
  e.by_flawed_surface->shells = {{.volume = v, .handles = 2}};
  EXPECT_EQ(compared().difference, "0 handles instead of 1");
  EXPECT_FALSE(compared().certain);
  // Both of them agree, and the result differs.
  e.by_flawed_surface->shells = {{.volume = v * 1.005, .handles = 1}};
  EXPECT_EQ(compared().difference, "0 handles instead of 1");
  EXPECT_TRUE(compared().certain);
  e.by_flawed_surface->shells = {{.volume = v * 1.05, .handles = 1}};
  EXPECT_FALSE(compared().certain);
}

void write_box(std::ofstream& out, std::size_t& first, const Vec3& low, const Vec3& high) {
  for (int k = 0; k < 8; ++k)
    out << "v " << (k & 1 ? high : low).x() << " " << (k & 2 ? high : low).y() << " "
        << (k & 4 ? high : low).z() << "\n";
  for (const auto& [a, b, c, d] : {std::array<std::size_t, 4>{0, 2, 3, 1},
                                   {4, 5, 7, 6},
                                   {0, 1, 5, 4},
                                   {2, 6, 7, 3},
                                   {0, 4, 6, 2},
                                   {1, 3, 7, 5}})
    out << "f " << first + a << " " << first + b << " " << first + c << " " << first + d << "\n";
  first += 8;
}

/// Two unit boxes with a gap between them.
void write_boxes(const std::string& path, double gap) {
  std::ofstream out(path);
  std::size_t first = 1;
  write_box(out, first, Vec3(0, 0, 0), Vec3(1, 1, 1));
  write_box(out, first, Vec3(1 + gap, 0, 0), Vec3(2 + gap, 1, 1));
}

TEST(SolidComparison, TheProgramSaysWhereTheSolidIsAnotherOne) {
  const TemporaryFolder f;
  const std::string mesh =
      " -o " + (f / "out.vtu") + " --resolution 32 --max-refinement 0 --stats " + (f / "s.json");
  const auto stats = [&] { return nlohmann::json::parse(contents(f / "s.json")); };
  write_boxes(f / "wide.obj", 0.4);
  Answer a = run("mesh " + (f / "wide.obj") + mesh);
  EXPECT_EQ(a.status, 0) << a.err;
  const auto same = stats()["fidelity"].at(0);
  EXPECT_TRUE(same["same"]);
  EXPECT_EQ(same["against"], "surface");
  EXPECT_EQ(same["result"]["components"], 2);
  EXPECT_NEAR(same["expected"]["volume"].get<double>(), 2, 1e-12);

  write_boxes(f / "narrow.obj", 0.001);
  a = run("mesh " + (f / "narrow.obj") + mesh);
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.err.find("not the solid of the input: 'narrow' has 1 component instead of 2"),
            std::string::npos)
      << a.err;
  EXPECT_NE(a.err.find("--accept-changes"), std::string::npos) << a.err;
  EXPECT_FALSE(stats()["fidelity"].at(0)["same"]);
  EXPECT_EQ(stats()["shortfall"].at(0)["what"], "fidelity");

  a = run("prepare " + (f / "narrow.obj") + mesh + " --target-tets 8000 --accept-changes");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("note: "), std::string::npos) << a.err;
  EXPECT_NE(a.err.find("1 component instead of 2"), std::string::npos) << a.err;
  EXPECT_TRUE(stats()["shortfall"].empty());
  a = run("prepare " + (f / "narrow.obj") + mesh + " --target-tets 8000 --accept-changes --strict --quiet");
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.err.find("--strict: "), std::string::npos) << a.err;
  EXPECT_EQ(stats()["shortfall"].at(0)["what"], "notes");
}

/// A plate of 10 x 10 and thickness `thickness`.
void write_plate(const std::string& path, double thickness) {
  std::ofstream out(path);
  std::size_t first = 1;
  write_box(out, first, Vec3(0, 0, 0), Vec3(10, 10, thickness));
}

/// A ball with narrow dents; it intersects itself where a point is moved beyond its neighbour.
TriangleMesh dented_ball() {
  TriangleMesh ball = make_sphere(1, Vec3::Zero(), 5);
  for (Vec3& p : ball.points)
    p *= 1 + 0.35 * std::sin(12 * p.x()) * std::sin(12 * p.y() + 1) * std::sin(12 * p.z() + 2);
  const Vec3 neighbour = ball.points[ball.triangles[0][1]];
  Vec3& beyond = ball.points[ball.triangles[0][0]];
  beyond += 1.5 * (neighbour - beyond);
  return ball;
}

TEST(SolidComparison, AMeshAsAClosedSurfaceSaysIsRightWhateverTheDistancesSay) {
  const TemporaryFolder f;
  write_surface(dented_ball(), f / "ball.obj");
  const Answer a = run("mesh " + (f / "ball.obj") + " -o " + (f / "o.vtu") +
                       " --uniform --resolution 26 --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("triangles that intersect"), std::string::npos) << a.err;
  EXPECT_EQ(a.err.find("instead of"), std::string::npos) << a.err;
  const auto j = nlohmann::json::parse(contents(f / "s.json"))["fidelity"].at(0);
  EXPECT_EQ(j["against"], "surface");
  EXPECT_EQ(j["result"]["handles"], 0);
  EXPECT_TRUE(j["same"]);
  EXPECT_FALSE(j["certain"]);
}

TEST(SolidComparison, ADifferenceFromAnEstimateIsANoteAndNoStatus) {
  const TemporaryFolder f;
  {
    std::ofstream body(f / "body.obj"), later(f / "later.obj");
    std::size_t first = 1;
    write_box(body, first, Vec3(0, 0, 0), Vec3(10, 10, 10));
    first = 1;
    // Leaves one plate thinner than a cell and a thick one.
    write_box(later, first, Vec3(0.5, -1, -1), Vec3(7, 11, 11));
  }
  const std::string call = "mesh " + (f / "body.obj") + " " + (f / "later.obj") + " -o " + (f / "o.vtu") +
                           " --uniform --resolution 20 --stats " + (f / "s.json");
  for (const char* strict : {"", " --strict"}) {
    const Answer a = run(call + strict);
    // Only that the bodies cross is certain.
    EXPECT_EQ(a.status, *strict ? 1 : 0) << a.err;
    EXPECT_EQ(a.err.find("--strict: 1 note: ") != std::string::npos, *strict != 0) << a.err;
    EXPECT_NE(a.err.find("note: 'body' has 2 components instead of 1"), std::string::npos) << a.err;
    EXPECT_NE(a.err.find("by the distances (not certain, since its surface meets another one)"),
              std::string::npos)
        << a.err;
  }
  const auto j = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_FALSE(j["fidelity"].at(0)["same"]);
  EXPECT_FALSE(j["fidelity"].at(0)["certain"]);
  ASSERT_EQ(j["shortfall"].size(), 1U);
  EXPECT_EQ(j["shortfall"].at(0).dump().find("components"), std::string::npos) << j["shortfall"];
}

TEST(SolidComparison, ThinPartsAreNamedOnlyWhereTheyMayHaveChanged) {
  const TemporaryFolder f;
  std::string call = "mesh";
  for (const int radius : {40, 37, 34}) {
    const std::string path = f / ("shell" + std::to_string(radius) + ".obj");
    write_surface(make_sphere(radius), path);
    call += " " + path;
  }
  call += " -o " + (f / "o.vtu") + " --uniform --strict --stats " + (f / "s.json") + " --resolution ";
  const auto stats = [&] { return nlohmann::json::parse(contents(f / "s.json")); };
  Answer a = run(call + "28");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(a.err.find("is thinner than"), std::string::npos) << a.err;
  EXPECT_FALSE(stats()["dense"]["thin_parts"].empty());
  a = run(call + "20");
  EXPECT_EQ(a.status, 1) << a.err;
  EXPECT_NE(a.err.find("'shell37' is thinner than two cells at "), std::string::npos) << a.err;
  EXPECT_NE(a.err.find("'shell37' has "), std::string::npos) << a.err;
}

TEST(SolidComparison, ATargetThatCannotFillAPlateIsMissedAndNotThePlate) {
  const TemporaryFolder f;
  write_plate(f / "plate.obj", 0.5);
  const std::string call = "prepare " + (f / "plate.obj") + " -o " + (f / "o.vtu") + " --stats " +
                           (f / "s.json") + " --target-tets ";
  Answer a = run(call + "100");
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.err.find("walls so thin that fewer tets would be flat; request "), std::string::npos) << a.err;
  auto stats = nlohmann::json::parse(contents(f / "s.json"));
  const auto filling = stats["dense"]["filling_tets"].get<int>();
  EXPECT_NEAR(filling, 1.5 * 0.66 * 100 / 0.25, 150);
  EXPECT_NEAR(stats["result"]["tets"].get<double>(), filling, 0.03 * filling);
  EXPECT_LT(stats["result"]["percent_below_threshold"].get<double>(), 3);
  EXPECT_EQ(stats["fidelity"][0]["result"]["components"], 1);
  EXPECT_EQ(stats["fidelity"][0]["result"]["handles"], 0);
  EXPECT_EQ(run(call + std::to_string(2 * filling)).status, 0);
}

TEST(SolidComparison, WhatStaysTooThickOrClosedIsSaidWithItsPlace) {
  const TemporaryFolder f;
  write_plate(f / "plate.obj", 0.02);
  const std::string call = "mesh " + (f / "plate.obj") + " -o " + (f / "o.vtu") + " --stats " +
                           (f / "s.json") + " --resolution 20 --max-refinement 0";
  Answer a = run(call);
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.err.find("too thin for cells: walls are up to "), std::string::npos) << a.err;
  EXPECT_NE(a.err.find("raise --resolution or --max-refinement"), std::string::npos) << a.err;
  auto stats = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_GT(stats["dense"]["thickened_walls"]["points"], 0);
  EXPECT_NEAR(stats["dense"]["thickened_walls"]["thickness"].get<double>(), 0.02, 1e-3);
  EXPECT_EQ(stats["fidelity"][0]["result"]["components"], 1);
  EXPECT_EQ(stats["fidelity"][0]["result"]["handles"], 0);
  a = run(call + " --accept-changes");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("times too thick"), std::string::npos) << a.err;

  write_boxes(f / "boxes.obj", 0.05);
  const std::string boxes = "mesh " + (f / "boxes.obj") + " -o " + (f / "o.vtu") + " --stats " +
                            (f / "s.json") + " --resolution 20";
  a = run(boxes + " --max-refinement 0");
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.err.find("a gap of 'boxes' 0.05 wide, over an area of "), std::string::npos) << a.err;
  stats = nlohmann::json::parse(contents(f / "s.json"));
  ASSERT_EQ(stats["dense"]["closed_gaps"].size(), 1U);
  EXPECT_EQ(stats["dense"]["closed_gaps"][0]["kind"], "gap");
  EXPECT_FALSE(stats["dense"]["closed_gaps"][0]["on_purpose"]);
  // As requested: a note.
  a = run(boxes + " --min-gap 5%");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("closed by --min-gap"), std::string::npos) << a.err;
  EXPECT_EQ(nlohmann::json::parse(contents(f / "s.json"))["fidelity"][0]["result"]["components"], 1);
}

TEST(SolidComparison, StrictIsQuietWhereThereIsNothingToNote) {
  const TemporaryFolder f;
  write_boxes(f / "boxes.obj", 0.5);
  EXPECT_EQ(run("mesh " + (f / "boxes.obj") + " -o " + (f / "b.vtu") + " --resolution 48 --strict").status,
            0);
  EXPECT_EQ(run("simplify " + (f / "b.vtu") + " -o " + (f / "c.vtu") + " --target-tets 2000 --strict").status,
            0);
}

TEST(SolidComparison, OpenSurfacesAreComparedWithTheirDistances) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample open_sphere -o " + (f / "open.ply")).status, 0);
  const Answer a = run("prepare " + (f / "open.ply") + " -o " + (f / "o.vtu") +
                       " --target-tets 1000 --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  const auto j = nlohmann::json::parse(contents(f / "s.json"))["fidelity"].at(0);
  EXPECT_EQ(j["against"], "distances");
  EXPECT_TRUE(j["same"]);
  EXPECT_GT(j["expected"]["volume"], 0);
  EXPECT_EQ(j["result"]["components"], 1);
}

}  // namespace
}  // namespace tetwright::solid_comparison_test
