// SPDX-License-Identifier: Apache-2.0

// Groups of a surface's triangles become patches of the dense mesh and keep their borders.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "tests/common/features/parts.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright::surface_regions_test {
namespace {

/// A unit cube whose sides are grids of n x n squares.
TriangleMesh gridded_cube(int n) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 1})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto first = static_cast<Index>(mesh.points.size());
          for (const auto& [u, v] : {std::pair(i, j), {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
            Vec3 p;
            p[axis] = side;
            p[(axis + 1) % 3] = static_cast<double>(u) / n;
            p[(axis + 2) % 3] = static_cast<double>(v) / n;
            mesh.points.push_back(p);
          }
          for (Triangle t : {Triangle{first, first + 1, first + 2}, Triangle{first, first + 2, first + 3}}) {
            if (side == 0) std::swap(t[1], t[2]);
            mesh.triangles.push_back(t);
          }
        }
  return mesh;
}

template <class GroupOf>
TriangleMesh grouped(TriangleMesh mesh, std::vector<SurfaceRegion> groups, const GroupOf& group_of) {
  for (const auto& [a, b, c] : mesh.triangles)
    mesh.triangle_groups.push_back(group_of((mesh.points[a] + mesh.points[b] + mesh.points[c]) / 3));
  mesh.groups = std::move(groups);
  return mesh;
}

/// A square of half the side length in the middle of the side z = 1.
TriangleMesh cube_with_inlet() {
  TriangleMesh mesh = grouped(gridded_cube(8), {{}, {7, "inlet"}}, [](const Vec3& p) {
    return p.z() == 1 && (p - Vec3(0.5, 0.5, 1)).cwiseAbs().maxCoeff() < 0.25 ? 1U : 0U;
  });
  return turned(std::move(mesh));
}

DenseMesh mesh_of(std::vector<MaterialSurface> surfaces, int resolution, FeatureAngle angle = {}) {
  MesherOptions options;
  options.resolution = resolution;
  options.feature_angle = angle;
  return mesh_surfaces(make_mesher_input(std::move(surfaces)), options, nullptr);
}

std::map<std::string, double> areas_of(const TetMesh& mesh) {
  std::map<std::string, double> areas;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    const auto group = mesh.patch_groups.find({t.pair(), t.patch});
    const Vec3& a = mesh.points[t.ids[0]];
    areas[group == mesh.patch_groups.end() ? "" : group->second.name] +=
        (mesh.points[t.ids[1]] - a).cross(mesh.points[t.ids[2]] - a).norm() / 2;
  }
  return areas;
}

TEST(SurfaceRegions, KeepTheirBordersOnAPlane) {
  for (const FeatureAngle::Rule rule : {FeatureAngle::Rule::automatic, FeatureAngle::Rule::off})
    for (const int resolution : {16, 28}) {
      const DenseMesh dense = mesh_of({{"cube", 1, cube_with_inlet(), "cube.obj"}}, resolution, {rule, 0});
      EXPECT_EQ(broken_promise(dense.mesh.points, dense.mesh.tets), "");
      const auto areas = areas_of(dense.mesh);
      ASSERT_EQ(areas.size(), 2U);
      // A point may stop just short of the border to keep a tet's shape.
      EXPECT_NEAR(areas.at("inlet"), 0.25, 1e-5) << resolution;
      if (rule == FeatureAngle::Rule::automatic) {
        EXPECT_NEAR(areas.at(""), 5.75, 1e-5);
      }
      // The corners of the square and, unless creases are off, those of the cube.
      EXPECT_EQ(dense.report.creases.corners.size(), rule == FeatureAngle::Rule::off ? 4U : 12U);
    }
}

TEST(SurfaceRegions, DivideASmoothSurface) {
  const TriangleMesh halves = grouped(make_sphere(1), {{0, "above"}, {0, "below"}},
                                      [](const Vec3& p) { return p.z() > 0 ? 0U : 1U; });
  const DenseMesh dense = mesh_of({{"ball", 1, halves, "ball.stl"}}, 32);
  const auto areas = areas_of(dense.mesh);
  ASSERT_EQ(areas.size(), 2U);
  EXPECT_NEAR(areas.at("above") / areas.at("below"), 1, 0.01);
}

/// A cube whose upper side is a group, and the others another one.
MaterialSurface cube_with_groups(const std::string& name, MaterialTag tag, const SurfaceRegion& sides,
                                 const SurfaceRegion& top) {
  return {name, tag, grouped(unit_cube(), {sides, top}, [](const Vec3& p) { return p.z() > 0.9 ? 1U : 0U; }),
          name + ".stl"};
}

std::vector<std::string> said_of(const MesherInput& input) {
  std::vector<std::string> lines;
  for (const Diagnostic& d : input.findings) lines.push_back(d.file + ": " + diagnostic_text(d));
  return lines;
}

TEST(SurfaceRegions, OfOneNameInTwoSurfacesAreQualified) {
  const MesherInput input = make_mesher_input({cube_with_groups("a", 1, {0, "side"}, {7, "top"}),
                                               cube_with_groups("b", 2, {0, "wall"}, {7, "top"}),
                                               cube_with_groups("c", 3, {0, "side"}, {2, "top"})});
  EXPECT_EQ(input.bodies[0].groups, (std::vector<SurfaceRegion>{{0, "a:side"}, {7, "a:top"}}));
  EXPECT_EQ(input.bodies[1].groups, (std::vector<SurfaceRegion>{{0, "wall"}, {7, "b:top"}}));
  EXPECT_EQ(input.bodies[2].groups, (std::vector<SurfaceRegion>{{0, "c:side"}, {2, "c:top"}}));
  EXPECT_EQ(said_of(input),
            (std::vector<std::string>{
                "a.stl: 2 names of patches (changed, as others have them, too; the first: \"side\" -> "
                "\"a:side\")",
                "b.stl: 1 names of patches (changed, as others have it, too: \"top\" -> \"b:top\")",
                "c.stl: 2 names of patches (changed, as others have them, too; the first: \"side\" -> "
                "\"c:side\")"}));
  ASSERT_EQ(input.groups.size(), 6u);
  for (const MesherInput::Group& g : input.groups) EXPECT_GT(g.area, 0.9) << g.group.name;
}

TEST(SurfaceRegions, OfOtherNamesStayAsTheyAre) {
  const MesherInput one = make_mesher_input({cube_with_groups("a", 1, {1, "top"}, {2, "top"})});
  EXPECT_EQ(one.bodies[0].groups, (std::vector<SurfaceRegion>{{1, "top"}, {2, "top"}}));
  const MesherInput two = make_mesher_input(
      {cube_with_groups("a", 1, {1, "top"}, {2, "top"}), cube_with_groups("b", 2, {3, "Top"}, {4, "lid"})});
  EXPECT_EQ(two.bodies[0].groups, (std::vector<SurfaceRegion>{{1, "top"}, {2, "top"}}));
  EXPECT_EQ(two.bodies[1].groups, (std::vector<SurfaceRegion>{{3, "Top"}, {4, "lid"}}));
  EXPECT_EQ(said_of(two), (std::vector<std::string>{}));
}

TEST(SurfaceRegions, OfAQualifiedNameStayApart) {
  const MesherInput input = make_mesher_input({cube_with_groups("a", 1, {0, "b:top"}, {0, "top"}),
                                               cube_with_groups("b", 2, {0, "b:top_2"}, {0, "top"}),
                                               cube_with_groups("", 3, {0, "x"}, {0, "top"})});
  EXPECT_EQ(input.bodies[0].groups, (std::vector<SurfaceRegion>{{0, "b:top"}, {0, "a:top"}}));
  EXPECT_EQ(input.bodies[1].groups, (std::vector<SurfaceRegion>{{0, "b:top_2"}, {0, "b:top_3"}}));
  EXPECT_EQ(input.bodies[2].groups, (std::vector<SurfaceRegion>{{0, "x"}, {0, "top"}}));
}

TEST(SurfaceRegions, WithoutANameAreCalledAfterTheirSurface) {
  const MesherInput input = make_mesher_input(
      {cube_with_groups("a", 1, {0, "b_3"}, {3, ""}), cube_with_groups("b", 2, {0, "side"}, {3, ""})});
  EXPECT_EQ(input.bodies[0].groups, (std::vector<SurfaceRegion>{{0, "b_3"}, {0, "a_3"}}));
  EXPECT_EQ(input.bodies[1].groups, (std::vector<SurfaceRegion>{{0, "side"}, {0, "b_3_2"}}));
}

TEST(SurfaceRegions, StayWithTheirTrianglesInRepair) {
  // Repeated and collapsed triangles are dropped, and the others are sorted.
  TriangleMesh mesh = grouped(gridded_cube(2), {{0, "low"}, {0, "high"}},
                              [](const Vec3& p) { return p.x() > 0.5 ? 1U : 0U; });
  mesh.triangles.insert(mesh.triangles.begin(), {0, 0, 1});
  mesh.triangle_groups.insert(mesh.triangle_groups.begin(), 1);
  mesh.triangles.push_back(mesh.triangles[5]);
  mesh.triangle_groups.push_back(mesh.triangle_groups[5]);
  const RepairedSurface s = repair_surface(mesh, "f").surface;
  ASSERT_EQ(s.groups.size(), s.triangles.size());
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const auto& [a, b, c] = s.triangles[t];
    EXPECT_EQ(s.groups[t], (s.points[a] + s.points[b] + s.points[c]).x() / 3 > 0.5 ? 1U : 0U);
  }
}

TEST(SurfaceRegions, AreSplitIntoSolids) {
  TriangleMesh two = unit_cube();
  two.triangle_groups.assign(two.triangles.size(), 2);
  const TriangleMesh other = make_sphere(1, Vec3(4, 0, 0), 2);
  const auto first = static_cast<Index>(two.points.size());
  two.points.insert(two.points.end(), other.points.begin(), other.points.end());
  for (const auto& [a, b, c] : other.triangles) {
    two.triangles.push_back({first + a, first + b, first + c});
    two.triangle_groups.push_back(0);
  }
  two.groups = {{5, ""}, {}, {0, "box"}};
  const std::vector<NamedSurface> solids = split_solids(two, "parts");
  ASSERT_EQ(solids.size(), 2U);
  EXPECT_EQ(solids[0].name, "box");
  EXPECT_EQ(solids[1].name, "parts_5");
  const auto expect_same = [](const TriangleMesh& a, const TriangleMesh& b) {
    EXPECT_EQ(a.points.size(), b.points.size());
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    for (std::size_t t = 0; t < a.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(a.points[a.triangles[t][k]], b.points[b.triangles[t][k]]);
    EXPECT_TRUE(a.groups.empty());
  };
  expect_same(solids[0].surface, unit_cube());
  expect_same(solids[1].surface, other);
  EXPECT_EQ(split_solids(unit_cube(), "cube")[0].name, "cube");
}

TEST(SurfaceRegions, OfSurfacesThatMeetAreKept) {
  const auto halves = [](const std::string& name, double shift) {
    TriangleMesh mesh = grouped(gridded_cube(4), {{0, name + "1"}, {0, name + "2"}},
                                [&](const Vec3& p) { return p.x() == 0 ? 0U : 1U; });
    for (Vec3& p : mesh.points) p.x() += shift;
    return mesh;
  };
  const DenseMesh dense = mesh_of({{"left", 1, halves("a", 0), "a"}, {"right", 2, halves("b", 1), "b"}}, 38);
  EXPECT_EQ(dense.report.features[0].found.verdict, SurfacePatches::Verdict::part);
  std::set<std::string> names;
  for (const auto& [patch, group] : dense.mesh.patch_groups) names.insert(group.name);
  EXPECT_EQ(names, (std::set<std::string>{"a1", "a2", "a2+b1", "b2"}));
  EXPECT_TRUE(dense.reference->has_patches());
  EXPECT_TRUE(dense.reference->has_junctions());
}

TEST(SurfaceRegions, OfWhichRepairLeavesNothingAreKnown) {
  TriangleMesh mesh = gridded_cube(2);
  const std::size_t own = mesh.triangles.size();
  mesh.triangles.push_back(mesh.triangles.front());
  mesh.groups = {{0, "cube"}, {0, "again"}, {0, "empty"}};
  mesh.triangle_groups.assign(own, 0);
  mesh.triangle_groups.push_back(1);
  const MesherInput input = make_mesher_input({{"cube", 1, mesh, "a"}});
  ASSERT_EQ(input.groups.size(), 2u);
  EXPECT_EQ(input.groups[0].group.name, "again");
  EXPECT_DOUBLE_EQ(input.groups[0].area, 0.125);
  EXPECT_DOUBLE_EQ(input.groups[1].area, 6);
}

TEST(SurfaceRegions, CreasesAndCornersOfBodiesThatTouchAreExact) {
  TriangleMesh above = unit_cube(), apart = unit_cube();
  for (Vec3& p : above.points) p.z() += 1;
  for (Vec3& p : apart.points) p.x() += 3;
  using Verdict = SurfacePatches::Verdict;
  const DenseMesh dense =
      mesh_of({{"below", 1, unit_cube(), "a"}, {"above", 2, above, "b"}, {"c", 3, apart, "c"}}, 40);
  ASSERT_EQ(dense.report.features.size(), 3U);
  for (const FeatureReport& f : dense.report.features) EXPECT_EQ(f.found.verdict, Verdict::part);
  // Each of two sheets that end at the contact has all eight corners, and so has the cube apart.
  EXPECT_EQ(dense.report.creases.corners.size(), 24U);
  for (const Vec3& corner : dense.report.creases.corners)
    EXPECT_TRUE(std::any_of(dense.mesh.points.begin(), dense.mesh.points.end(), [&](const Vec3& p) {
      return (p - corner).norm() < 1e-9;
    })) << corner.transpose();
  double contact = 0;
  for (const InterfaceTriangle& t : dense.mesh.interfaces) {
    if (t.pair() != MaterialPair{1, 2}) continue;
    const Vec3 &a = dense.mesh.points[t.ids[0]], &b = dense.mesh.points[t.ids[1]],
               &c = dense.mesh.points[t.ids[2]];
    contact += (b - a).cross(c - a).norm() / 2;
  }
  EXPECT_NEAR(contact, 1, 1e-9);
}

/// Two boxes of other tessellations, turned: no slit of outside between them.
TEST(SurfaceRegions, ContactOfTurnedBodiesIsOnePiece) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.6, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  TriangleMesh low = gridded_cube(3), high = unit_cube();
  for (Vec3& p : high.points) p.z() += 1;
  for (TriangleMesh* mesh : {&low, &high})
    for (Vec3& p : mesh->points) p = turn * p;
  const MesherInput input = make_mesher_input({{"low", 1, low, "a"}, {"high", 2, high, "b"}});
  ASSERT_EQ(input.contacts.size(), 1U);
  EXPECT_NEAR(input.contacts[0].area, 1, 1e-9);
  EXPECT_EQ(input.contacts[0].pieces, 1U);
  MesherOptions options;
  options.resolution = 40;
  const DenseMesh dense = mesh_surfaces(input, options, nullptr);
  double contact = 0, volume = 0;
  std::map<std::array<Index, 2>, int> edges;
  std::set<Index> points;
  std::size_t faces = 0;
  for (const InterfaceTriangle& t : dense.mesh.interfaces) {
    if (t.pair() != MaterialPair{1, 2}) continue;
    const Vec3 &a = dense.mesh.points[t.ids[0]], &b = dense.mesh.points[t.ids[1]],
               &c = dense.mesh.points[t.ids[2]];
    contact += (b - a).cross(c - a).norm() / 2;
    ++faces;
    for (int k = 0; k < 3; ++k) {
      ++edges[ascending_edge(t.ids[k], t.ids[(k + 1) % 3])];
      points.insert(t.ids[k]);
    }
  }
  EXPECT_NEAR(contact, 1, 1e-9);
  // A disc has the Euler characteristic 1.
  EXPECT_EQ(static_cast<int>(points.size()) - static_cast<int>(edges.size()) + static_cast<int>(faces), 1);
  for (const Tet& t : dense.mesh.tets) {
    const Vec3& a = dense.mesh.points[t[0]];
    volume +=
        (dense.mesh.points[t[1]] - a).cross(dense.mesh.points[t[2]] - a).dot(dense.mesh.points[t[3]] - a) / 6;
  }
  EXPECT_NEAR(volume, 2, 1e-9);
}

TEST(SurfaceRegions, OverlapsBelongToTheBodyThatTheRuleNames) {
  TriangleMesh second = unit_cube();
  for (Vec3& p : second.points) p += Vec3(0.5, 0.25, 0.25);
  const double both = 0.5 * 0.75 * 0.75;
  struct Expected {
    OverlapRule rule;
    std::string owner;
    std::map<std::string, double> volumes;
  };
  for (const Expected& e :
       {Expected{OverlapRule::later, "b", {{"a", 1 - both}, {"b", 1}}},
        Expected{OverlapRule::first, "a", {{"a", 1}, {"b", 1 - both}}},
        Expected{OverlapRule::material, "a+b", {{"a", 1 - both}, {"b", 1 - both}, {"a+b", both}}}}) {
    ContactOptions contact;
    contact.overlap = e.rule;
    const MesherInput input = make_mesher_input({{"a", 1, unit_cube(), "a"}, {"b", 2, second, "b"}}, {},
                                                NestedRule::automatic, contact);
    ASSERT_EQ(input.overlaps.size(), 1U);
    EXPECT_EQ(input.overlaps[0].owner, e.owner);
    const TetMesh mesh = mesh_surfaces(input, {.resolution = 12}, nullptr).mesh;
    std::map<std::string, double> volumes;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const auto& [p, q, r, s] = mesh.tets[t];
      const Vec3& o = mesh.points[p];
      volumes[mesh.material_names.at(mesh.materials[t])] +=
          (mesh.points[q] - o).cross(mesh.points[r] - o).dot(mesh.points[s] - o) / 6;
    }
    ASSERT_EQ(volumes.size(), e.volumes.size()) << e.owner;
    for (const auto& [name, volume] : e.volumes) EXPECT_NEAR(volumes[name], volume, 1e-9) << name;
  }
}

TEST(SurfaceRegions, ContactsTellGapsFromOverlaps) {
  for (const double gap : {2e-6, -3e-6}) {
    TriangleMesh second = unit_cube();
    for (Vec3& p : second.points) p.x() += 1 + gap;
    const MesherInput input = make_mesher_input({{"a", 1, unit_cube(), "a"}, {"b", 2, second, "b"}});
    ASSERT_EQ(input.contacts.size(), 1U);
    EXPECT_NEAR(input.contacts[0].area, 1, 1e-9);
    EXPECT_EQ(input.contacts[0].pieces, 1U);
    EXPECT_NEAR(input.contacts[0].largest_gap, std::max(0.0, gap), 1e-12);
    EXPECT_NEAR(input.contacts[0].largest_overlap, std::max(0.0, -gap), 1e-12);
  }
}

TEST(SurfaceRegions, BodiesThatCrossAreNamedOrRefused) {
  TriangleMesh second = unit_cube();
  for (Vec3& p : second.points) p += Vec3(0.5, 0.25, 0.25);
  const MesherInput input = make_mesher_input({{"a", 1, unit_cube(), "a"}, {"b", 2, second, "b"}});
  ASSERT_EQ(input.overlaps.size(), 1U);
  EXPECT_NEAR(input.overlaps[0].volume, 0.5 * 0.75 * 0.75, 1e-9);
  EXPECT_TRUE(std::any_of(input.findings.begin(), input.findings.end(),
                          [](const Diagnostic& f) { return f.code == DiagnosticCode::bodies_overlap; }));
  ContactOptions contact;
  contact.overlap = OverlapRule::error;
  const auto join = [&] {
    return make_mesher_input({{"a", 1, unit_cube(), "a"}, {"b", 2, second, "b"}}, {}, NestedRule::automatic,
                             contact);
  };
  EXPECT_THROW(join(), InputError);
  contact = {};
  contact.tolerance = 1;  // larger than the bodies' features
  EXPECT_THROW(join(), InputError);
  contact.tolerance = 0;
  EXPECT_THROW(join(), UsageError);
}

}  // namespace
}  // namespace tetwright::surface_regions_test
