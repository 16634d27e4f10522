// SPDX-License-Identifier: Apache-2.0

// Open surfaces inside bodies become faces of the dense mesh, or divide bodies into materials.
#include "tetwright/sheets.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright::inner_sheets_test {
namespace {

const Vec3 low(0, 0, 0), high(2, 1.5, 1);

/// A parallelogram of n x n cells.
TriangleMesh parallelogram(const Vec3& corner, const Vec3& u, const Vec3& v, int n = 4) {
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.points.push_back(corner + u * i / n + v * j / n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto a = static_cast<Index>(j * (n + 1) + i), b = a + 1, c = a + static_cast<Index>(n) + 1;
      mesh.triangles.push_back({a, b, c + 1});
      mesh.triangles.push_back({a, c + 1, c});
    }
  return mesh;
}

TriangleMesh baffle() { return parallelogram({0.5, 0.3, 0.3}, {0.9, 0.4, 0}, {0, 0, 0.45}); }
constexpr double baffle_area = 0.443199;  // sqrt(0.9^2 + 0.4^2) * 0.45

SheetSurface sheet(const std::string& name, TriangleMesh surface) {
  return {name, std::move(surface), name + ".off"};
}

SheetSurface partition(const std::string& name, TriangleMesh surface) {
  return {name, std::move(surface), name + ".off", true};
}

MesherInput in_box(std::vector<SheetSurface> sheets, double extend = 0,
                   TriangleMesh box = make_box(low, high)) {
  return make_mesher_input({{"box", 1, std::move(box), "box.off"}}, {}, NestedRule::automatic, {}, {},
                           nullptr, {std::move(sheets), extend});
}

DenseMesh mesh_of(const MesherInput& input, int resolution = 20) {
  MesherOptions options;
  options.resolution = resolution;
  return mesh_surfaces(input, options, nullptr);
}

/// The message of the InputError for sheets in the box.
std::string refusal(std::vector<SheetSurface> sheets, double extend = 0) {
  try {
    in_box(std::move(sheets), extend);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

std::string said_of(const MesherInput& input, DiagnosticCode code) {
  std::string text;
  for (const Diagnostic& d : input.findings)
    if (d.code == code) text += d.file + ": " + diagnostic_text(d) + "\n";
  return text;
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

double volume_of(const TetMesh& mesh, MaterialTag tag) {
  std::vector<Tet> tets;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (mesh.materials[t] == tag) tets.push_back(mesh.tets[t]);
  return volume(mesh.points, tets);
}

/// \param slack relative difference of lengths and areas
void expect_sheets(const TetMesh& mesh, const std::map<std::string, double>& areas, double border,
                   double slack = 1e-5) {
  EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
  EXPECT_TRUE(misplaced_sheet_faces(mesh).empty());
  const std::vector<SheetStatistics> found = sheet_statistics(mesh);
  ASSERT_EQ(found.size(), areas.size());
  for (const SheetStatistics& s : found) {
    ASSERT_TRUE(areas.contains(s.name)) << s.name;
    EXPECT_NEAR(s.area, areas.at(s.name), slack * s.area) << s.name;
    EXPECT_EQ(s.pieces, 1U) << s.name;
    EXPECT_EQ(s.euler, 1) << s.name;
    EXPECT_NEAR(s.border_length, border, slack * border) << s.name;
  }
}

std::map<std::string, SheetStatistics> found_sheets(const TetMesh& mesh) {
  std::map<std::string, SheetStatistics> found;
  for (const SheetStatistics& s : sheet_statistics(mesh)) found[s.name] = s;
  return found;
}

TEST(InnerSheets, AreFacesWithTheirExactBorder) {
  for (const int resolution : {12, 20, 33}) {
    const DenseMesh dense = mesh_of(in_box({sheet("baffle", baffle())}), resolution);
    expect_sheets(dense.mesh, {{"baffle", baffle_area}}, 2 * (std::hypot(0.9, 0.4) + 0.45));
    EXPECT_NEAR(volume_of(dense.mesh, 1), 3, 1e-4);
    ASSERT_EQ(dense.report.sheets.size(), 1U);
    EXPECT_NEAR(dense.report.sheets[0].shape.area, baffle_area, 1e-5);
    EXPECT_NE(dense.reference, nullptr);
  }
}

TEST(InnerSheets, MayReachFromWallToWall) {
  const DenseMesh dense =
      mesh_of(in_box({sheet("wall", parallelogram({0.7, 0, 0}, {0.5, 1.5, 0}, {0, 0, 1}))}));
  expect_sheets(dense.mesh, {{"wall", std::hypot(0.5, 1.5)}}, 2 * (std::hypot(0.5, 1.5) + 1));
  EXPECT_NEAR(volume_of(dense.mesh, 1), 3, 1e-6);
  EXPECT_EQ(solid_topology(dense.mesh.points, dense.mesh.tets).components, 1);
}

// The vertex nearest to a corner of the sheet is not always where its mesh's border turns from one face of
// the box to the next.
TEST(InnerSheets, CornersOfTurnedWallsAreExact) {
  const auto turn = Eigen::AngleAxisd(71 * std::numbers::pi / 180, Vec3(0.36, -0.48, 0.8));
  TriangleMesh box = make_box(low, high), wall = parallelogram({0.7, 0, 0}, {0.5, 1.5, 0}, {0, 0, 1});
  for (TriangleMesh* surface : {&box, &wall})
    for (Vec3& p : surface->points) p = turn * p;
  const Vec3 normal = turn * Vec3(1.5, -0.5, 0).normalized();
  const TetMesh mesh = mesh_of(in_box({sheet("wall", wall)}, 0, box), 30).mesh;
  double off = 0;
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids)
      if (t.is_sheet()) off = std::max(off, std::abs(normal.dot(mesh.points[p] - wall.points[0])));
  EXPECT_LT(off, 1e-9);
}

TEST(InnerSheets, ThatAreApartKeepTheirNames) {
  const DenseMesh dense =
      mesh_of(in_box({sheet("low", parallelogram({0.4, 0.4, 0.3}, {1, 0, 0}, {0, 0.8, 0})),
                      sheet("high", parallelogram({0.4, 0.4, 0.7}, {1, 0, 0}, {0, 0.8, 0}))}));
  expect_sheets(dense.mesh, {{"low", 0.8}, {"high", 0.8}}, 3.6);
}

TEST(InnerSheets, ThatAreCloserThanACellStayApart) {
  TriangleMesh other = baffle();
  // A cell is 0.1; a turned copy keeps at least 0.05 from the sheet.
  for (Vec3& p : other.points) p += Vec3(-0.02, 0.05 + 0.04 * p.z(), 0);
  const MesherInput input = in_box({sheet("baffle", baffle()), sheet("other", std::move(other))});
  const std::map<std::string, SheetStatistics> found = found_sheets(mesh_of(input).mesh);
  ASSERT_EQ(found.size(), 2U);
  for (const auto& [name, s] : found) {
    EXPECT_EQ(s.pieces, 1U) << name;
    EXPECT_EQ(s.euler, 1) << name;
    EXPECT_NEAR(s.area, baffle_area, 0.01 * baffle_area) << name;
  }
}

TEST(InnerSheets, DoNotDependOnTheNumberOfThreads) {
  std::vector<TetMesh> meshes;
  for (const std::size_t threads : {1, 2}) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    meshes.push_back(mesh_of(in_box({sheet("baffle", baffle())})).mesh);
  }
  EXPECT_EQ(meshes[0].points, meshes[1].points);
  EXPECT_EQ(meshes[0].tets, meshes[1].tets);
  EXPECT_EQ(meshes[0].interfaces, meshes[1].interfaces);
}

TEST(InnerSheets, AreCutOffOutsideBodies) {
  const MesherInput input = in_box({sheet("fin", parallelogram({1.5, 0.5, 0.2}, {1, 0, 0}, {0, 0, 0.5}))});
  EXPECT_TRUE(
      holds(said_of(input, DiagnosticCode::sheet_cut_off), "fin.off: a part of the sheet 'fin' outside"));
  // Its end on the wall is as accurate as other curves in which surfaces meet.
  expect_sheets(mesh_of(input).mesh, {{"fin", 0.25}}, 2, 0.01);
}

TEST(InnerSheets, OutsideBodiesAreRefused) {
  EXPECT_TRUE(holds(refusal({sheet("fin", parallelogram({3, 0.5, 0.2}, {1, 0, 0}, {0, 0, 0.5}))}),
                    "the sheet 'fin' is in no body"));
}

TEST(InnerSheets, OnTheBoundaryAreRefused) {
  EXPECT_TRUE(holds(refusal({sheet("side", parallelogram({0.5, 0.5, 0}, {1, 0, 0}, {0, 0.5, 0}))}),
                    "the sheet 'side' lies on the boundary of a body"));
}

TEST(InnerSheets, ThatAreClosedAreRefused) {
  EXPECT_TRUE(holds(refusal({sheet("ball", make_sphere(0.2, {1, 0.7, 0.5}))}), "the sheet is closed at "));
}

TEST(InnerSheets, WithoutTrianglesAreRefused) {
  EXPECT_TRUE(holds(refusal({sheet("empty", {})}), "empty.off"));
}

TEST(InnerSheets, WithOneSideAreRefused) {
  TriangleMesh strip = make_moebius_strip();
  for (Vec3& p : strip.points) p = Vec3(1, 0.7, 0.5) + 0.2 * p;
  EXPECT_TRUE(holds(refusal({sheet("strip", strip)}), "the sheet is one-sided"));
}

/// The sheets of a mesh by name.
TEST(InnerSheets, CrossInACurveOfFourFaces) {
  const MesherInput input =
      in_box({sheet("first", parallelogram({0.4, 0.5, 0.3}, {1.2, 0.4, 0}, {0, 0, 0.4})),
              sheet("second", parallelogram({0.85, 0.25, 0.2}, {0.2, 0.95, 0}, {0, 0, 0.6}))});
  for (const int resolution : {20, 26, 40}) {
    const TetMesh mesh = mesh_of(input, resolution).mesh;
    EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
    EXPECT_TRUE(misplaced_sheet_faces(mesh).empty());
    const std::map<std::string, SheetStatistics> found = found_sheets(mesh);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(found.at("first").area, 0.4 * std::hypot(1.2, 0.4), 2e-3);
    EXPECT_NEAR(found.at("second").area, 0.6 * std::hypot(0.2, 0.95), 2e-3);
    std::map<std::array<Index, 2>, int> at_edges;
    for (const InterfaceTriangle& t : mesh.interfaces)
      if (t.other == t.material)
        for (std::size_t k = 0; k < 3; ++k) ++at_edges[ascending_edge(t.ids[k], t.ids[(k + 1) % 3])];
    double crossing = 0;
    for (const auto& [edge, faces] : at_edges)
      if (faces == 4) crossing += (mesh.points[edge[0]] - mesh.points[edge[1]]).norm();
    EXPECT_NEAR(crossing, 0.4, 1e-3) << resolution;
    for (const auto& [name, s] : found) EXPECT_EQ(s.pieces, 1U) << name << " " << resolution;
  }
}

TEST(InnerSheets, CrossTheContactOfTwoBodies) {
  const TriangleMesh across = parallelogram({0.3, 0.2, 0.45}, {1.4, 0.05, 0.05}, {0, 0.55, 0.05});
  const double area = std::abs(Vec3(1.4, 0.05, 0.05).cross(Vec3(0, 0.55, 0.05)).norm());
  for (const int resolution : {20, 30, 45}) {
    const MesherInput input =
        make_mesher_input({{"left", 1, make_box({0, 0, 0}, {1, 1, 1}), "left.off"},
                           {"right", 2, make_box({1, 0, 0}, {2, 1, 1}), "right.off"}},
                          {}, NestedRule::automatic, {}, {}, nullptr, {{sheet("fault", across)}, 0});
    const std::map<std::string, SheetStatistics> found = found_sheets(mesh_of(input, resolution).mesh);
    ASSERT_EQ(found.size(), 1U) << resolution;
    const SheetStatistics& s = found.begin()->second;
    EXPECT_EQ(s.pieces, 1U) << resolution;
    EXPECT_EQ(s.euler, 1) << resolution;
    EXPECT_NEAR(s.area, area, 0.005 * area) << resolution;
  }
}

TEST(InnerSheets, BranchInACurveOfThreeFaces) {
  const TriangleMesh fan = joined(joined(parallelogram({1, 0.7, 0.3}, {0.5, 0, 0}, {0, 0, 0.4}),
                                         parallelogram({1, 0.7, 0.3}, {-0.3, 0.4, 0}, {0, 0, 0.4})),
                                  parallelogram({1, 0.7, 0.3}, {-0.3, -0.4, 0}, {0, 0, 0.4}));
  const TetMesh mesh = mesh_of(in_box({sheet("fan", fan)}), 40).mesh;
  EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
  EXPECT_TRUE(misplaced_sheet_faces(mesh).empty());
  const std::map<std::string, SheetStatistics> found = found_sheets(mesh);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found.at("fan").area, 0.6, 1e-4);
  EXPECT_EQ(found.at("fan").pieces, 1U);
  EXPECT_EQ(found.at("fan").euler, 1);
}

TEST(InnerSheets, GivenTwiceAreRefused) {
  const std::string text = refusal({sheet("one", baffle()), sheet("again", baffle())});
  EXPECT_TRUE(holds(text, "again.off: the sheet 'again' lies on another sheet")) << text;
}

TEST(InnerSheets, CannotBeCombinedWithLayers) {
  EXPECT_THROW(make_mesher_input({{"box", 1, make_box(low, high), "box.off"}}, {{"skin", 2, 0.1}},
                                 NestedRule::automatic, {}, {}, nullptr, {{sheet("baffle", baffle())}, 0}),
               UsageError);
}

TEST(InnerSheets, InAnOpenBodyAreRefused) {
  const auto box_without = [](const auto& chosen) {
    TriangleMesh box = make_box(low, high);
    std::erase_if(box.triangles, [&](const Triangle& t) {
      return chosen(Vec3((box.points[t[0]] + box.points[t[1]] + box.points[t[2]]) / 3));
    });
    return box;
  };
  const auto without_corner =
      box_without([](const Vec3& p) { return p.z() == high.z() || p.x() == high.x(); });
  EXPECT_THROW(in_box({sheet("baffle", baffle())}, 0, without_corner), InputError);
  // Flat holes are closed.
  const auto without_lid = box_without([](const Vec3& p) { return p.z() == high.z(); });
  EXPECT_EQ(in_box({sheet("baffle", baffle())}, 0, without_lid).sheets.size(), 1U);
}

TEST(Partitions, DivideABodyIntoMaterials) {
  const MesherInput input =
      in_box({partition("fault", parallelogram({-0.5, -0.5, 0.6}, {3, 0, 0}, {0, 3, 0}))});
  ASSERT_EQ(input.bodies.size(), 2U);
  EXPECT_EQ(input.bodies[0].name, "box_1");  // from the top
  EXPECT_EQ(input.bodies[1].name, "box_2");
  const DenseMesh dense = mesh_of(input);
  EXPECT_EQ(broken_promise(dense.mesh.points, dense.mesh.tets), "");
  EXPECT_NEAR(volume_of(dense.mesh, input.bodies[0].tag), 1.2, 1e-5);
  EXPECT_NEAR(volume_of(dense.mesh, input.bodies[1].tag), 1.8, 1e-5);
}

TEST(Partitions, ThatEndInsideAreRefusedUnlessExtended) {
  const TriangleMesh fault = parallelogram({0.1, 0.1, 0.6}, {1.8, 0, 0}, {0, 1.3, 0});
  EXPECT_TRUE(holds(refusal({partition("fault", fault)}), "reaches the boundary of none"));
  EXPECT_EQ(in_box({partition("fault", fault)}, 0.2).bodies.size(), 2U);
}

TEST(Partitions, ThatReachTheBoundaryOnOneSideAreRefused) {
  const std::string text =
      refusal({partition("fault", parallelogram({-0.1, 0.1, 0.6}, {1.5, 0, 0}, {0, 1.3, 0}))});
  EXPECT_TRUE(holds(text, "it ends inside 'box' at ")) << text;
}

TEST(Partitions, WithWavyBordersAreContinuedWithoutFolds) {
  TriangleMesh wavy = parallelogram({0.5, 0.4, 0.6}, {1, 0, 0}, {0, 0.7, 0}, 20);
  for (Vec3& p : wavy.points)
    p += 0.004 * Vec3(std::sin(40 * p.y()), std::sin(40 * p.x()), std::sin(70 * p.x() + 60 * p.y()));
  EXPECT_EQ(in_box({partition("fault", wavy)}, 0.8).bodies.size(), 2U);
}

TEST(Partitions, ThatWouldFoldAreRefused) {
  // The sides of the notch, continued, cross each other.
  TriangleMesh notched = parallelogram({0.5, 0.4, 0.6}, {1, 0, 0}, {0, 0.7, 0}, 10);
  std::erase_if(notched.triangles, [&](const Triangle& t) {
    const Vec3 p = (notched.points[t[0]] + notched.points[t[1]] + notched.points[t[2]]) / 3;
    return p.x() > 0.9 && p.x() < 1.1 && p.y() > 0.7;
  });
  EXPECT_TRUE(holds(refusal({partition("fault", notched)}, 0.8), "would cross itself at "));
}

/// A partition from x = 0.2 to 1.2 that rises, continued by 0.8 or as asked.
MesherInput with_rising(double height, double slope, double extend = 0.8) {
  return in_box({partition("fault", parallelogram({0.2, 0.1, height}, {1, 0, slope}, {0, 1.3, 0}, 10))},
                extend);
}

/// The largest x of a body on the top of the box.
double end_on_top(const MesherInput::Body& body) {
  double end = 0;
  for (const Vec3& p : body.surface.points)
    if (p.z() > high.z() - 1e-4) end = std::max(end, p.x());
  return end;
}

TEST(Partitions, TurnOntoWallsThatTheyWouldMeetAtANarrowAngle) {
  // Straight on, it would meet the top at x = 1.53, at 17 degrees.
  const MesherInput input = with_rising(0.6, 0.3);
  ASSERT_EQ(input.bodies.size(), 2U);
  const auto& upper = input.bodies[0];
  EXPECT_EQ(upper.name, "box_1");
  EXPECT_GT(end_on_top(upper), 1.3);
  EXPECT_LT(end_on_top(upper), 1.4);
  const DenseMesh dense = mesh_of(input, 16);
  EXPECT_EQ(broken_promise(dense.mesh.points, dense.mesh.tets), "");
  // Continued by hand, it leaves a wedge full of the smallest cells.
  const DenseMesh straight = mesh_of(
      in_box({partition("fault", parallelogram({-0.3, -0.1, 0.45}, {2.4, 0, 0.72}, {0, 1.7, 0}, 10))}), 16);
  EXPECT_LT(dense.mesh.tets.size(), straight.mesh.tets.size() / 2);
}

TEST(Partitions, TurnOntoWallsAtTheirCornersToo) {
  const MesherInput input =
      in_box({partition("fault", parallelogram({0.2, 0.1, 0.5}, {1, 0, 0.25}, {0, 1, 0.15}, 10))}, 0.85);
  ASSERT_EQ(input.bodies.size(), 2U);
  // It leaves the box by the top at one of its corners only, where it turns, and elsewhere by the sides.
  bool at_corner = false;
  for (const Vec3& p : input.bodies[1].surface.points) {
    if (p.z() < high.z() - 1e-4) continue;
    EXPECT_GT(p.x(), 0.9);
    at_corner |= p.x() > high.x() - 1e-4 && p.y() > high.y() - 1e-4;
  }
  EXPECT_TRUE(at_corner);
  const DenseMesh dense = mesh_of(input, 16);
  EXPECT_EQ(broken_promise(dense.mesh.points, dense.mesh.tets), "");
  EXPECT_LT(dense.mesh.tets.size(), 60'000U);
  EXPECT_NEAR(volume_of(dense.mesh, input.bodies[0].tag) + volume_of(dense.mesh, input.bodies[1].tag), 3,
              1e-4);
}

TEST(Partitions, ThatRunAlongAWallAreContinuedStraight) {
  const MesherInput input = with_rising(0.94, 0.015, 0.9);
  ASSERT_EQ(input.bodies.size(), 2U);
  for (const auto& body : input.bodies) EXPECT_NEAR(end_on_top(body), body.name == "box_1" ? 2 : 0, 1e-9);
}

TEST(Partitions, ThatMeetWallsAtWideAnglesAreContinuedStraight) {
  const MesherInput input = with_rising(0.1, 0.85, 0.4);
  ASSERT_EQ(input.bodies.size(), 2U);
  for (const auto& body : input.bodies)
    if (body.name == "box_1") EXPECT_NEAR(end_on_top(body), 0.2 + 0.9 / 0.85, 1e-3);
}

TEST(Partitions, OutsideBodiesAreRefused) {
  EXPECT_TRUE(holds(refusal({partition("fault", parallelogram({0, 0, 3}, {2, 0, 0}, {0, 1.5, 0}))}),
                    "the partition 'fault' divides no body: it reaches the boundary of none"));
}

}  // namespace
}  // namespace tetwright::inner_sheets_test
