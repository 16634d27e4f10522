// SPDX-License-Identifier: Apache-2.0

// Holes of surfaces: which are closed in the plane of their rim, and how caps are named.
#include "mesher/input/surface_holes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "tests/common/features/parts.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright::surface_holes_test {
namespace {

/// The mesh without the triangles whose centre is chosen.
template <class Chosen>
TriangleMesh without(TriangleMesh mesh, const Chosen& chosen) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return chosen(Vec3((mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3));
  });
  return mesh;
}

/// A box without its sides at the largest z, and at the smallest if `both`.
TriangleMesh open_box(const Vec3& low, const Vec3& high, bool both = false) {
  return without(make_box(low, high),
                 [&](const Vec3& p) { return p.z() == high.z() || (both && p.z() == low.z()); });
}

/// The side of a cylinder around the z axis from 0 to `height`, without its ends.
TriangleMesh tube(double radius, double height, bool inwards = false) {
  constexpr Index around = 24;
  TriangleMesh mesh;
  for (const double z : {0.0, height})
    for (Index k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      mesh.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  for (Index k = 0; k < around; ++k) {
    const Index next = (k + 1) % around;
    mesh.triangles.push_back({k, next, around + next});
    mesh.triangles.push_back({k, around + next, around + k});
  }
  return inwards ? turned_over(std::move(mesh)) : mesh;
}

MesherInput input_of(TriangleMesh mesh, const CapOptions& caps = {}) {
  return make_mesher_input({{"a", 1, std::move(mesh), "a.obj"}}, {}, {}, {}, {}, nullptr, {}, caps);
}

bool is_closed(const MesherInput& input) {
  return input.bodies[0].surface.closed == input.bodies[0].surface.triangles.size();
}

TEST(SurfaceHoles, ABoxWithoutASideIsTheBox) {
  const MesherInput input = input_of(turned(open_box(Vec3(0, 0, 0), Vec3(1, 2, 3))));
  ASSERT_EQ(input.holes.size(), 1U);
  EXPECT_TRUE(input.holes[0].flat);
  EXPECT_TRUE(input.holes[0].sharp);
  EXPECT_NEAR(input.holes[0].size, 2, 1e-12);
  EXPECT_EQ(input.holes[0].name, "cap_1");
  EXPECT_TRUE(is_closed(input));
  EXPECT_NEAR(input.bodies[0].surface.volume, 6, 1e-12);
  EXPECT_EQ(input.bodies[0].groups[input.holes[0].group].name, "cap_1");
}

TEST(SurfaceHoles, BothEndsOfAThickTubeAreRings) {
  const MesherInput input = input_of(joined(tube(1, 4), tube(0.5, 4, true)));
  ASSERT_EQ(input.holes.size(), 2U);
  const double polygon = 12 * std::sin(std::numbers::pi / 12);  // of radius 1
  for (const SurfaceHole& hole : input.holes) {
    EXPECT_TRUE(hole.flat);
    EXPECT_NEAR(hole.size, 0.75 * polygon, 1e-12);
  }
  EXPECT_TRUE(is_closed(input));
  EXPECT_NEAR(input.bodies[0].surface.volume, 3 * polygon, 1e-12);
  EXPECT_EQ(input.holes[0].points[0].z(), 0) << "holes of one size are sorted by their lowest point";
}

TEST(SurfaceHoles, CapsThatEncloseNothingOrMeetTheSurfaceAreLeftOut) {
  // A square, and a box with a ball through its open side.
  EXPECT_FALSE(is_closed(
      input_of(without(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), [](const Vec3& p) { return p.z() != 0; }),
               {.open = {.accept_sheets = true}})));
  const MesherInput pierced =
      input_of(joined(open_box(Vec3(0, 0, 0), Vec3(3, 3, 3)), make_sphere(1, Vec3(1.5, 1.5, 3))));
  ASSERT_EQ(pierced.holes.size(), 1U);
  EXPECT_FALSE(pierced.holes[0].flat);
  EXPECT_FALSE(is_closed(pierced));
  // The rim of two sides that share an edge is bent.
  const MesherInput bent = input_of(without(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)),
                                            [](const Vec3& p) { return p.z() == 1 || p.x() == 1; }));
  ASSERT_EQ(bent.holes.size(), 1U);
  EXPECT_FALSE(bent.holes[0].flat);
}

TEST(SurfaceHoles, RimsThatHardlyTurnAreNoCreases) {
  // A missing triangle of a fine sphere, and a sphere cut open.
  TriangleMesh sphere = make_sphere(1);
  sphere.triangles.erase(sphere.triangles.begin());
  const MesherInput punctured = input_of(sphere);
  ASSERT_EQ(punctured.holes.size(), 1U);
  EXPECT_TRUE(punctured.holes[0].flat);
  EXPECT_FALSE(punctured.holes[0].sharp);
  EXPECT_TRUE(punctured.bodies[0].surface.groups.empty());
  EXPECT_TRUE(is_closed(punctured));

  const TriangleMesh cut = without(make_sphere(1), [](const Vec3& p) { return p.z() > 0; });
  EXPECT_TRUE(input_of(cut).holes.at(0).sharp);
  CapOptions off;
  off.feature_angle.rule = FeatureAngle::Rule::off;
  EXPECT_FALSE(input_of(cut, off).holes.at(0).sharp);
  EXPECT_TRUE(is_closed(input_of(cut, off)));
  off.close_flat = false;
  EXPECT_FALSE(is_closed(input_of(cut, off)));
}

TEST(SurfaceHoles, ClosedSurfacesHaveNone) {
  const MesherInput input = input_of(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
  EXPECT_TRUE(input.holes.empty());
  EXPECT_TRUE(input.findings.empty());
}

std::set<std::string> names_with(std::vector<RegionSeed> seeds) {
  CapOptions caps;
  caps.names = std::move(seeds);
  std::set<std::string> names;
  for (const SurfaceHole& hole : input_of(open_box(Vec3(0, 0, 0), Vec3(1, 1, 3), true), caps).holes)
    names.insert(hole.name);
  return names;
}

std::string refusal_of(std::vector<RegionSeed> seeds) {
  try {
    names_with(std::move(seeds));
  } catch (const UsageError& e) {
    return e.what();
  }
  return "";
}

TEST(SurfaceHoles, AreNamedByPoints) {
  EXPECT_EQ(names_with({}), (std::set<std::string>{"cap_1", "cap_2"}));
  EXPECT_EQ(names_with({{"top", Vec3(0.5, 0.5, 3.1)}}), (std::set<std::string>{"cap_1", "top"}));
  EXPECT_EQ(names_with({{"cap_2", Vec3(0.5, 0.5, 0)}}), (std::set<std::string>{"cap_2", "cap_3"}))
      << "a name that is taken is not given again";
  EXPECT_NE(refusal_of({{"far", Vec3(0.5, 0.5, 1.5)}}).find("1.5 from the nearest cap"), std::string::npos);
  EXPECT_NE(refusal_of({{"a", Vec3(0.5, 0.5, 0)}, {"b", Vec3(0.2, 0.5, 0)}}).find("is the same as 'a'"),
            std::string::npos);
  EXPECT_NE(refusal_of({{"a", Vec3(0.5, 0.5, 0)}, {"a", Vec3(0.5, 0.5, 3)}}).find("has this name"),
            std::string::npos);
  CapOptions caps;
  caps.names = {{"a", Vec3(0, 0, 0)}};
  EXPECT_THROW(input_of(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), caps), UsageError);
}

DenseMesh mesh_of(const MesherInput& input, int resolution) {
  MesherOptions options;
  options.resolution = resolution;
  return mesh_surfaces(input, options, nullptr);
}

TEST(SurfaceHoles, FlatCapsAreExactInTheMesh) {
  const TriangleMesh box = turned(open_box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
  DenseMesh dense = mesh_of(input_of(box), 12);
  EXPECT_NEAR(volume(dense.mesh.points, dense.mesh.tets), 1, 1e-6);
  EXPECT_EQ(dense.report.creases.corners.size(), 8U);
  ASSERT_TRUE(dense.caps);
  const CapReport report = dense.caps->name(dense.mesh, CapNaming::sharp);
  ASSERT_EQ(report.caps.size(), 1U);
  EXPECT_TRUE(report.caps[0].named);
  EXPECT_NEAR(report.caps[0].area, 1, 1e-6);
  EXPECT_NEAR(report.area / report.boundary_area, 1. / 6, 1e-6);
  const std::vector<Vec3> axis =
      turned({.points = {Vec3(0.5, 0.5, 0), Vec3(0.5, 0.5, 1)}, .triangles = {}}).points;
  EXPECT_NEAR((report.caps[0].centre - axis[1]).norm(), 0, 1e-6);
  EXPECT_NEAR((report.caps[0].normal - (axis[1] - axis[0])).norm(), 0, 1e-6);
}

TEST(SurfaceHoles, OtherCapsAreNamedAfterwards) {
  // Without two sides that share an edge: the cap bulges over the diagonal.
  const TriangleMesh box =
      without(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), [](const Vec3& p) { return p.z() == 1 || p.x() == 1; });
  DenseMesh dense = mesh_of(input_of(box), 16);
  const std::vector<InterfaceTriangle> before = dense.mesh.interfaces;
  CapReport report = dense.caps->name(dense.mesh, CapNaming::sharp);
  ASSERT_EQ(report.caps.size(), 1U);
  EXPECT_FALSE(report.caps[0].named);
  EXPECT_EQ(dense.mesh.interfaces, before);
  report = dense.caps->name(dense.mesh, CapNaming::all);
  EXPECT_TRUE(report.caps.at(0).named);
  EXPECT_FALSE(report.caps[0].flat);
  EXPECT_GT(report.caps[0].area, 1.3);
  EXPECT_LT(report.caps[0].area, 1.9);
  EXPECT_GT(report.caps[0].normal.dot(Vec3(1, 0, 1).normalized()), 0.95);
  double area = 0;
  for (const InterfaceTriangle& t : dense.mesh.interfaces)
    if (const auto group = dense.mesh.patch_groups.find({t.pair(), t.patch});
        group != dense.mesh.patch_groups.end() && group->second.name == "cap_1")
      area += (dense.mesh.points[t.ids[1]] - dense.mesh.points[t.ids[0]])
                  .cross(dense.mesh.points[t.ids[2]] - dense.mesh.points[t.ids[0]])
                  .norm() /
              2;
  EXPECT_NEAR(area, report.caps[0].area, 1e-9);
}

TEST(SurfaceHoles, OpenBodiesThatMeetAtACapAreJoined) {
  const MesherInput input =
      make_mesher_input({{"low", 1, open_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), "low.obj"},
                         {"high", 2, make_box(Vec3(0, 0, 1), Vec3(1, 1, 2)), "high.obj"}});
  EXPECT_TRUE(input.complex);
  ASSERT_EQ(input.contacts.size(), 1U);
  EXPECT_NEAR(input.contacts[0].area, 1, 1e-9);
}

}  // namespace
}  // namespace tetwright::surface_holes_test
