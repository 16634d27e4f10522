// SPDX-License-Identifier: Apache-2.0

// Open surfaces: sheets that enclose nothing, blocks below height fields, shells.
#include "mesher/input/open_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "tests/common/features/parts.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"
#include "tetwright/mesher_input.h"

namespace tetwright::open_surfaces_test {
namespace {

/// A surface over [0, 1] x [0, 1], n x n squares.
TriangleMesh field(const std::function<double(double, double)>& height, Index n = 12) {
  TriangleMesh mesh;
  for (Index j = 0; j <= n; ++j)
    for (Index i = 0; i <= n; ++i) {
      const double x = i / double(n), y = j / double(n);
      mesh.points.emplace_back(x, y, height(x, y));
    }
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i) {
      const Index a = j * (n + 1) + i, c = a + n + 1;
      mesh.triangles.push_back({a, a + 1, c + 1});
      mesh.triangles.push_back({a, c + 1, c});
    }
  return mesh;
}

double hills(double x, double y) { return 0.15 * std::sin(5 * x + 1) * std::cos(4 * y); }

double surface_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += area_vector(mesh.points, t).norm();
  return area;
}

/// The cylinder of radius 1 around the x axis, `degrees` of it, 2 long.
TriangleMesh gutter(double degrees) {
  TriangleMesh mesh = field([](double, double) { return 0; }, 24);
  for (Vec3& p : mesh.points) {
    const double angle = (p.y() - 0.5) * degrees * std::numbers::pi / 180;
    p = Vec3(2 * p.x(), std::sin(angle), std::cos(angle));
  }
  return mesh;
}

MesherInput input_of(TriangleMesh mesh, const OpenSurfaceOptions& open = {}) {
  CapOptions caps;
  caps.open = open;
  return make_mesher_input({{"a", 1, std::move(mesh), "a.obj"}}, {}, {}, {}, {}, nullptr, {}, caps);
}

OpenSurfaceOptions with_base(BaseHeight height = {}) { return {.base = height}; }
OpenSurfaceOptions thick(double thickness) { return {.thickness = thickness}; }

std::string refusal(const TriangleMesh& mesh, const OpenSurfaceOptions& open = {}) {
  try {
    input_of(mesh, open);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

double area_of(const MesherInput& input, const std::string& group) {
  for (const MesherInput::Group& g : input.groups)
    if (g.group.name == group) return g.area;
  return 0;
}

bool is_whole(const MesherInput& input) {
  const RepairedSurface& s = input.bodies[0].surface;
  return input.bodies.size() == 1 && s.closed == s.triangles.size() && !s.intersects_itself &&
         input.holes.empty();
}

TEST(OpenSurfaces, SheetsEncloseNothing) {
  TriangleMesh frame = field(hills, 16);
  std::erase_if(frame.triangles, [&](const Triangle& t) {
    const Vec3 middle = (frame.points[t[0]] + frame.points[t[1]] + frame.points[t[2]]) / 3;
    return std::max(std::abs(middle.x() - 0.5), std::abs(middle.y() - 0.5)) < 0.375;
  });
  for (const TriangleMesh& mesh :
       {field(hills), field([](double, double) { return 0; }), gutter(90), frame}) {
    const std::string why = refusal(mesh);
    EXPECT_TRUE(contains(why, "encloses nothing")) << why;
    EXPECT_TRUE(contains(why, "--base auto") && contains(why, "--thicken D")) << why;
    EXPECT_EQ(refusal(mesh, {.accept_sheets = true}), "");
  }
}

TEST(OpenSurfaces, SurfacesWithHolesEncloseABody) {
  TriangleMesh dome = make_sphere(1);
  std::erase_if(dome.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](Index p) { return dome.points[p].z() <= 1e-9; });
  });
  EXPECT_EQ(refusal(dome), "");
  EXPECT_EQ(refusal(gutter(180)), "");
  // A short tube has two holes, each larger than itself.
  TriangleMesh ring = make_box({0, 0, 0}, {1, 1, 0.1});
  std::erase_if(ring.triangles, [&](const Triangle& t) {
    return ring.points[t[0]].z() == ring.points[t[1]].z() && ring.points[t[0]].z() == ring.points[t[2]].z();
  });
  EXPECT_EQ(refusal(ring), "");
  // A tray: the lid is exact.
  TriangleMesh tray = make_box({0, 0, 0}, {1, 1, 0.05});
  std::erase_if(tray.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](Index p) { return tray.points[p].z() == 0.05; });
  });
  EXPECT_EQ(refusal(tray), "");
}

TEST(OpenSurfaces, ABaseMakesABlock) {
  for (const bool turned : {false, true}) {
    const TriangleMesh top = turned ? turned_over(field(hills)) : field(hills);
    const MesherInput input = input_of(top, with_base(-0.5));
    EXPECT_TRUE(is_whole(input));
    EXPECT_NEAR(area_of(input, "base"), 1, 1e-12);
    EXPECT_NEAR(area_of(input, "top"), surface_area(top), 1e-12);
    EXPECT_EQ(input.low.z(), -0.5);
    EXPECT_GT(input.bodies[0].surface.volume, 0.4);
  }
}

TEST(OpenSurfaces, ABaseIsATenthOfTheWidthBelowByDefault) {
  TriangleMesh top = field([](double x, double) { return x; });
  for (Vec3& p : top.points) p.x() *= 3;
  EXPECT_NEAR(input_of(top, with_base()).low.z(), -0.3, 1e-12);
}

TEST(OpenSurfaces, ABlockMayBeThinAndHaveSteps) {
  const TriangleMesh flat = field([](double, double) { return 0; });
  EXPECT_NEAR(input_of(flat, with_base(-0.001)).bodies[0].surface.volume, 0.001, 1e-12);
  // A stair: its riser is vertical, also at the rim.
  TriangleMesh stair;
  for (const auto& [x, z] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {2.0, 1.0}})
    for (const double y : {0.0, 1.0}) stair.points.emplace_back(x, y, z);
  for (Index k = 0; k < 6; k += 2) {
    stair.triangles.push_back({k, k + 2, k + 3});
    stair.triangles.push_back({k, k + 3, k + 1});
  }
  const MesherInput input = input_of(stair, with_base(-1.0));
  EXPECT_TRUE(is_whole(input));
  EXPECT_NEAR(input.bodies[0].surface.volume, 3, 1e-12);
}

TEST(OpenSurfaces, HolesOfAHeightFieldStayHoles) {
  TriangleMesh top = field(hills);
  std::erase_if(top.triangles,
                [&](const Triangle& t) { return (top.points[t[0]] - Vec3(0.5, 0.5, 0)).norm() < 0.2; });
  const MesherInput input = input_of(top, with_base(-0.5));
  ASSERT_EQ(input.holes.size(), 1u);
  EXPECT_NEAR(area_of(input, "base"), 1, 1e-12);
  EXPECT_NEAR(area_of(input, "side"), area_of(input_of(field(hills), with_base(-0.5)), "side"), 1e-9);
}

TEST(OpenSurfaces, ABaseIsRefusedWithThePlace) {
  TriangleMesh bent = field(hills);
  for (Vec3& p : bent.points) p.x() += 2 * std::max(0.0, 0.3 - (p - Vec3(0.5, 0.5, p.z())).norm());
  EXPECT_TRUE(contains(refusal(bent, with_base()), "overhangs at ("));
  const std::string above = refusal(field(hills), with_base(0.0));
  EXPECT_TRUE(contains(above, "--base 0 is not below the surface")) << above;
  // A ramp that winds above itself.
  TriangleMesh ramp;
  for (Index k = 0; k <= 40; ++k)
    for (const double r : {1.0, 2.0}) {
      const double angle = k * 0.25;
      ramp.points.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.1 * k);
    }
  for (Index k = 0; k < 40; ++k) {
    ramp.triangles.push_back({2 * k, 2 * k + 1, 2 * k + 3});
    ramp.triangles.push_back({2 * k, 2 * k + 3, 2 * k + 2});
  }
  const std::string winding = refusal(ramp, with_base());
  EXPECT_TRUE(contains(winding, "cross each other or the surface at (")) << winding;
  // Three sheets at an edge whose borders end at its ends: more edges end at a point of the rim than start
  // there.
  TriangleMesh three;
  three.points = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 1}, {-1, 0, 2}};
  three.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 1, 4}};
  EXPECT_NE(refusal(three, with_base()), "");
}

TEST(OpenSurfaces, AShellHasItsThicknessEverywhere) {
  // Around a fold of 90 degrees, and behind a bent sheet with many narrow facets.
  TriangleMesh fold;
  fold.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}};
  fold.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 5}, {0, 5, 1}};
  const MesherInput l = input_of(fold, thick(0.1));
  EXPECT_TRUE(is_whole(l));
  EXPECT_NEAR(area_of(l, "front"), 2, 1e-12);
  EXPECT_NEAR(area_of(l, "back"), 2.2, 1e-12);
  EXPECT_NEAR(l.bodies[0].surface.volume, 0.21, 1e-12);
  EXPECT_NEAR(l.low.z(), -0.1, 1e-12);
  EXPECT_NEAR(l.low.y(), -0.1, 1e-12);

  // A triangle without area on the fold changes nothing.
  TriangleMesh split = fold;
  split.points.emplace_back(0.5, 0, 0);
  split.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 5}, {0, 5, 6}, {6, 5, 1}, {0, 6, 1}};
  EXPECT_NEAR(input_of(split, thick(0.1)).bodies[0].surface.volume, 0.21, 1e-9);

  const MesherInput bent = input_of(gutter(90), thick(0.2));
  EXPECT_TRUE(is_whole(bent));
  for (const Vec3& p : bent.bodies[0].surface.points) {
    const double radius = std::hypot(p.y(), p.z());
    EXPECT_NEAR(radius, radius > 0.9 ? 1 : 0.8, 1e-3);
  }
}

TEST(OpenSurfaces, ShellsFollowNoise) {
  const TriangleMesh rough = field(
      [](double x, double y) {
        return hills(x, y) + 0.01 * std::sin(97 * x + 31 * y) * std::cos(83 * y - 53 * x);
      },
      40);
  const MesherInput input = input_of(rough, thick(0.05));
  EXPECT_TRUE(is_whole(input));
  EXPECT_NEAR(input.bodies[0].surface.volume, 0.05 * surface_area(rough), 0.1 * 0.05 * surface_area(rough));
}

TEST(OpenSurfaces, ShellsThatCrossThemselvesAreRefusedWithThePlace) {
  const std::string why = refusal(gutter(300), thick(1.5));
  EXPECT_TRUE(contains(why, "crosses itself at (")) << why;
  TriangleMesh three = field([](double, double) { return 0; }, 1);
  three.points.emplace_back(0.5, 0.5, 1);
  three.triangles.push_back({0, 3, 4});
  EXPECT_TRUE(contains(refusal(three, thick(0.1)), "one or two triangles at each edge"));
}

TEST(OpenSurfaces, OptionsForOpenSurfacesNeedSome) {
  EXPECT_TRUE(contains(refusal(unit_cube(), with_base()), "--base is for open surfaces"));
  EXPECT_TRUE(contains(refusal(unit_cube(), thick(0.1)), "--thicken is for open surfaces"));
  for (const double thickness : {0.0, -0.1, std::nan("")})
    EXPECT_TRUE(contains(refusal(field(hills), thick(thickness)), "must be above 0"));
  TriangleMesh wall = field(hills);
  for (Vec3& p : wall.points) p = {0, p.x(), p.y()};
  EXPECT_TRUE(contains(refusal(wall, with_base()), "the surface is vertical"));
  EXPECT_TRUE(
      contains(refusal(field(hills), {.base = BaseHeight(), .thickness = 0.1}), "leave one of them out"));
}

}  // namespace
}  // namespace tetwright::open_surfaces_test
