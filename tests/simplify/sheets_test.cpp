// SPDX-License-Identifier: Apache-2.0

// Sheets: inner faces with one material on both sides, kept as they are by all operations.
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "tests/simplify/patches.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/remesher.h"
#include "tetwright/resources.h"
#include "tetwright/sheets.h"
#include "tetwright/simplify.h"

namespace tetwright::sheets_test {
namespace {

constexpr int n = 12;
/// Points are rounded to the lattice of working coordinates.
constexpr double rounding = 1e-8;

/// Axis-aligned rectangle in the plane where coordinate `axis` is `at`; the bounds of the other axes are
/// inclusive.
struct Rectangle {
  int axis;
  double at;
  std::array<double, 3> low{0, 0, 0}, high{n, n, n};

  bool has(const Vec3& p) const {
    if (p[axis] != at) return false;
    for (int a = 0; a < 3; ++a)
      if (a != axis && (p[a] < low[a] || p[a] > high[a])) return false;
    return true;
  }
};

/// Adds the faces that lie in a rectangle to the sheets of a mesh, as the named patch.
/// \pre Points have lattice coordinates; mesh.interfaces has the other interfaces.
void add_sheet(TetMesh& mesh, const Rectangle& where, std::uint16_t patch, const std::string& name) {
  std::vector<InterfaceTriangle> sheet;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size()))
    if (f.count == 2 && mesh.materials[f.first] == mesh.materials[f.second] &&
        std::all_of(f.ids.begin(), f.ids.end(), [&](Index p) { return where.has(mesh.points[p]); })) {
      const MaterialTag tag = mesh.materials[f.first];
      sheet.push_back({f.ids, tag, tag, patch});
      mesh.patch_groups[{{tag, tag}, patch}] = {patch, name};
    }
  ASSERT_FALSE(sheet.empty());
  append_sheets(mesh.interfaces, sheet);
}

/// Moves the points within the material slightly.
void jitter_off_surfaces(TetMesh& mesh, std::uint64_t seed, double amount) {
  std::vector<std::uint8_t> on_surface(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) on_surface[p] = 1;
  Random random(seed);
  for (std::size_t p = 0; p < mesh.points.size(); ++p)
    for (int a = 0; a < 3; ++a) {
      const double by = amount * (random.uniform() - 0.5);
      if (!on_surface[p]) mesh.points[p][a] += by;
    }
}

TetMesh box_with(const std::vector<Rectangle>& sheets) {
  TetMesh mesh = grid_mesh(n);
  set_patches(mesh, [](const InterfaceTriangle&, const Vec3& c) { return side_of(c, n); });
  std::uint16_t patch = 1;
  for (const Rectangle& r : sheets) {
    add_sheet(mesh, r, patch, "sheet " + std::to_string(patch));
    ++patch;
  }
  jitter_off_surfaces(mesh, 7, 0.3);
  return mesh;
}

const Rectangle within{2, 6, {3, 3, 0}, {9, 9, 0}};
const Rectangle wall_to_wall{2, 6};
const Rectangle crossing{0, 6};
const Rectangle ends_at_wall{2, 6, {0, 3, 0}, {7, 9, 0}};

void expect_valid(const TetMesh& before, const TetMesh& after) {
  for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
  for (const std::string& d : topology_differences(topology(before), topology(after))) ADD_FAILURE() << d;
}

/// Expects the sheets of `before` in `after`, flat as they were.
void expect_sheets(const TetMesh& before, const TetMesh& after, const std::vector<Rectangle>& sheets) {
  expect_valid(before, after);
  const std::vector<SheetStatistics> was = sheet_statistics(before), is = sheet_statistics(after);
  ASSERT_EQ(was.size(), is.size());
  for (std::size_t i = 0; i < was.size(); ++i) {
    EXPECT_EQ(was[i].name, is[i].name);
    EXPECT_EQ(was[i].pieces, is[i].pieces);
    EXPECT_EQ(was[i].border_pieces, is[i].border_pieces);
    EXPECT_NEAR(was[i].area, is[i].area, 0.01 * was[i].area);
    EXPECT_NEAR(was[i].border_length, is[i].border_length, 0.01 * was[i].border_length);
  }
  for (const InterfaceTriangle& t : after.interfaces)
    if (t.is_sheet()) {
      const Rectangle& r = sheets[t.patch - 1u];
      for (const Index p : t.ids) EXPECT_NEAR(after.points[p][r.axis], r.at, rounding);
    }
}

SimplifyOptions to(std::size_t target) {
  SimplifyOptions options;
  options.target_tets = target;
  return options;
}

struct Case {
  const char* name;
  std::vector<Rectangle> sheets;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class FlatSheets : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Shapes, FlatSheets,
                         testing::Values(Case{"within", {within}}, Case{"wall_to_wall", {wall_to_wall}},
                                         Case{"ends_at_wall", {ends_at_wall}},
                                         Case{"two_crossing", {wall_to_wall, crossing}},
                                         Case{"crossing_within", {within, crossing}}),
                         [](const auto& c) { return c.param.name; });

TEST_P(FlatSheets, AreKeptBySimplify) {
  const TetMesh mesh = box_with(GetParam().sheets);
  for (const std::size_t target : {1500, 300, 1}) {
    const TetMesh after = simplify(mesh, to(target));
    expect_sheets(mesh, after, GetParam().sheets);
    EXPECT_LT(2 * sheets_of(after).size(), sheets_of(mesh).size());
  }
}

TEST_P(FlatSheets, AreKeptByThePapersSchedule) {
  const TetMesh mesh = box_with(GetParam().sheets);
  SimplifyOptions options = to(1000);
  options.schedule = Schedule::paper;
  expect_sheets(mesh, simplify(mesh, options), GetParam().sheets);
}

TEST_P(FlatSheets, KeepTheirCornersAndBorders) {
  const TetMesh mesh = box_with(GetParam().sheets);
  const TetMesh after = simplify(mesh, to(500));
  for (const Rectangle& r : GetParam().sheets)
    for (int corner = 0; corner < 4; ++corner) {
      Vec3 at;
      for (int a = 0, bit = 0; a < 3; ++a)
        at[a] = a == r.axis ? r.at : (corner >> bit++ & 1) ? r.high[a] : r.low[a];
      double nearest = n;
      for (const InterfaceTriangle& t : after.interfaces)
        if (t.is_sheet())
          for (const Index p : t.ids) nearest = std::min(nearest, (after.points[p] - at).norm());
      EXPECT_LT(nearest, rounding) << at.transpose();
    }
}

TEST_P(FlatSheets, GiveTheSameBytesForAnyNumberOfThreads) {
  const TetMesh mesh = box_with(GetParam().sheets);
  std::vector<TetMesh> results;
  for (const unsigned threads : {1u, 2u}) {
    const ThreadLimit limit(threads);
    results.push_back(simplify(mesh, to(800)));
  }
  EXPECT_EQ(results[0].points, results[1].points);
  EXPECT_EQ(results[0].tets, results[1].tets);
  EXPECT_EQ(results[0].interfaces, results[1].interfaces);
}

TEST_P(FlatSheets, AreKeptByImproveAndTheRemesher) {
  const TetMesh mesh = simplify(box_with(GetParam().sheets), to(3000));
  expect_sheets(mesh, improve(mesh, {}), GetParam().sheets);

  Remesher remesher(mesh, {});
  remesher.coarsen(RemeshRegion::box(Vec3(-1, -1, -1), Vec3(n + 1, n + 1, n + 1)), 3);
  expect_sheets(mesh, remesher.mesh(), GetParam().sheets);
  remesher.refine(RemeshRegion::box(Vec3(2, 2, 2), Vec3(8, 8, 8)), 1);
  expect_sheets(mesh, remesher.mesh(), GetParam().sheets);
}

TEST(Sheets, AreOrientedConsistently) {
  const TetMesh mesh = box_with({within});
  const TetMesh after = simplify(mesh, to(1000));
  std::set<bool> up;
  for (const InterfaceTriangle& t : after.interfaces)
    if (t.is_sheet()) {
      const Vec3 &a = after.points[t.ids[0]], &b = after.points[t.ids[1]], &c = after.points[t.ids[2]];
      up.insert((b - a).cross(c - a).z() > 0);
    }
  EXPECT_EQ(up.size(), 1u);
}

TEST(Sheets, WithoutPatchesOfTheBoundaryAreKept) {
  TetMesh mesh = grid_mesh(n);
  mesh.interfaces = find_interfaces(mesh);
  add_sheet(mesh, within, 0, "membrane");
  jitter_off_surfaces(mesh, 3, 0.3);
  const TetMesh after = simplify(mesh, to(800));
  expect_valid(mesh, after);
  const SheetStatistics sheet = sheet_statistics(after).at(0);
  EXPECT_EQ(sheet.name, "membrane");
  EXPECT_NEAR(sheet.area, 36, 0.36);
  for (const InterfaceTriangle& t : after.interfaces)
    if (t.is_sheet())
      for (const Index p : t.ids) EXPECT_NEAR(after.points[p].z(), 6, rounding);
}

/// A reference without the sheet: all of space projects onto the plane z = 0.
class FarPlane : public ReferenceSurface {
 public:
  double signed_distance(const Vec3& p, MaterialTag) const override { return -p.z(); }
  std::optional<Vec3> project(const Vec3& p, MaterialOrOutside, MaterialOrOutside,
                              double max_distance) const override {
    if (p.z() > max_distance) return {};
    return Vec3(p.x(), p.y(), 0);
  }
};

TEST(Sheets, CurvedSheetsStayOnTheirOwnSurfaceBesideAReference) {
  TetMesh mesh = grid_mesh(n);
  mesh.interfaces = find_interfaces(mesh);
  add_sheet(mesh, {2, 6, {2, 2, 0}, {10, 10, 0}}, 0, "dome");
  // Bend the whole box.
  const auto height = [](const Vec3& p) {
    return 0.02 * ((p.x() - 6) * (p.x() - 6) + (p.y() - 6) * (p.y() - 6));
  };
  for (Vec3& p : mesh.points) p.z() -= height(p);
  const FarPlane reference;
  SimplifyOptions options = to(3000);
  options.reference = &reference;
  const TetMesh after = simplify(mesh, options);
  expect_valid(mesh, after);
  EXPECT_NEAR(sheet_statistics(after).at(0).area, sheet_statistics(mesh).at(0).area,
              0.01 * sheet_statistics(mesh).at(0).area);
  for (const InterfaceTriangle& t : after.interfaces)
    if (t.is_sheet())
      for (const Index p : t.ids) EXPECT_NEAR(after.points[p].z(), 6 - height(after.points[p]), 0.15);
}

TEST(Sheets, AreMeasuredAgainstThemselvesBesideASurface) {
  // As after meshing: the given surface is the boundary alone.
  const TetMesh mesh = box_with({within, crossing});
  TriangleMesh surface;
  surface.points = mesh.points;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (!t.is_sheet()) surface.triangles.push_back(t.ids);
  SimplifyOptions options = to(800);
  options.surface = &surface;
  options.tolerance = 0.1;
  SimplifyReport report;
  const TetMesh after = simplify(mesh, options, &report);
  expect_sheets(mesh, after, {within, crossing});
  ASSERT_TRUE(report.deviation);
  EXPECT_LT(report.deviation->upper(), 0.1);
  EXPECT_EQ(report.deviation->apart_area, 0);
  EXPECT_EQ(report.deviation->hidden_area, 0);
}

TEST(Sheets, ThatAreNoFacesOfTheirMaterialAreAnError) {
  TetMesh mesh = grid_mesh(2);
  mesh.interfaces = find_interfaces(mesh);
  InterfaceTriangle wrong = mesh.interfaces.front();
  wrong.other = wrong.material;
  mesh.interfaces.push_back(wrong);
  EXPECT_THROW(simplify(mesh, to(10)), InputError);
  const std::vector<MeshFinding> findings = check_mesh(mesh);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, DiagnosticCode::sheet_faces_misplaced);
  EXPECT_TRUE(findings[0].places.at(0).at);

  TetMesh twice = box_with({within});
  twice.interfaces.push_back(twice.interfaces.back());
  EXPECT_THROW(simplify(twice, to(10)), InputError);
}

TEST(Sheets, SecondOrderTetsFollowThem) {
  TetMesh mesh = grid_mesh(n);
  mesh.interfaces = find_interfaces(mesh);
  add_sheet(mesh, within, 0, "flat");
  const TetMesh after = simplify(mesh, to(800));
  const FarPlane reference;
  SurfaceToFollow surface = follow(reference);
  follow_sheets(surface, mesh);
  MidsideNodes nodes = straight_midside_nodes(after);
  curve_midside_nodes(after, surface, nodes);
  for (std::size_t f = 0; f < after.interfaces.size(); ++f)
    if (after.interfaces[f].is_sheet())
      for (const Index m : nodes.of_faces[f]) EXPECT_NEAR(nodes.points[m].z(), 6, rounding);
}

}  // namespace
}  // namespace tetwright::sheets_test
