// SPDX-License-Identifier: Apache-2.0

// Exact distances, inside tests and thicknesses of surfaces.
#include "mesher/thin/surface_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/random.h"
#include "tests/mesher/test_surfaces.h"

namespace tetwright::surface_distance_test {
namespace {

using Side = SurfaceDistance::Side;

SurfaceDistance distance_of(const TriangleMesh& mesh) {
  return {mesh.points, mesh.triangles, mesh.triangles.size(), {}, false};
}

/// The mesh rotated about an axis oblique to the grid.
TriangleMesh turned(TriangleMesh mesh) {
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  for (Vec3& p : mesh.points) p = turn * p;
  return mesh;
}

TEST(SurfaceDistance, InsideIsExactOnGridPlanesToo) {
  const SurfaceDistance box = distance_of(make_box(Vec3(0, 0, 0), Vec3(4, 4, 1)));
  EXPECT_TRUE(box.inside(Vec3(2, 2, 0.5)));
  EXPECT_TRUE(box.inside(Vec3(2, 2, 1e-12)));
  EXPECT_FALSE(box.inside(Vec3(2, 2, -1e-12)));
  EXPECT_FALSE(box.inside(Vec3(2, 2, 1 + 1e-12)));
  // A box inside a box, oriented inwards: a cavity.
  const SurfaceDistance hollow = distance_of(
      joined(make_box(Vec3(0, 0, 0), Vec3(3, 3, 3)), turned_over(make_box(Vec3(1, 1, 1), Vec3(2, 2, 2)))));
  EXPECT_FALSE(hollow.inside(Vec3(1.5, 1.5, 1.5)));
  EXPECT_TRUE(hollow.inside(Vec3(0.5, 1.5, 1.5)));
}

TEST(SurfaceDistance, NearestPlaceOfManyPoints) {
  const TriangleMesh sphere = make_sphere(2);
  const SurfaceDistance distance = distance_of(sphere);
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(4 * random.uniform() - 2, 4 * random.uniform() - 2, 4 * random.uniform() - 2);
    const auto place = distance.nearest(p, 10);
    ASSERT_TRUE(place);
    EXPECT_NEAR((place->point - p).norm(), std::abs(p.norm() - 2), 0.01);
    EXPECT_GT(place->normal.dot(place->point), 0);
    EXPECT_FALSE(distance.nearest(p, 0.9 * (place->point - p).norm()));
    EXPECT_EQ(distance.inside(p), p.norm() < 2 - 0.01 || (p.norm() < 2 && distance.inside(p)));
  }
}

/// A square of this side in a plane of constant z, facing up or down.
TriangleMesh square(double side, double z, bool up) {
  TriangleMesh mesh;
  mesh.points = {{0, 0, z}, {side, 0, z}, {side, side, z}, {0, side, z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return up ? mesh : turned_over(std::move(mesh));
}

TEST(SurfaceDistance, LargeCapsAreNoWalls) {
  const TriangleMesh sheet = square(10, 0, true);
  for (const double side : {6.0, 8.0}) {
    const TriangleMesh cap = square(side, -0.5, false);
    const SurfaceDistance distance{sheet.points, sheet.triangles, 0, cap, false};
    const bool is_wall = side * side < 50;
    const auto above = distance.nearest({3, 3, 0.1}, 1), below = distance.nearest({3, 3, -0.6}, 1);
    ASSERT_TRUE(above && below);
    EXPECT_NEAR(below->point.z(), -0.5, 1e-12);
    EXPECT_EQ(below->on_cap, !is_wall);
    EXPECT_FALSE(above->on_cap);
    for (const SurfacePlace& place : {*above, *below})
      EXPECT_NEAR(distance.thickness(place, Side::wall, 0.7, 2), is_wall ? 0.5 : 2, 1e-9) << side;
    EXPECT_EQ(distance.is_ball_empty({3, 3, -0.75}, 0.5), !is_wall);
  }
}

/// A star with long spikes: at its corners faces of all directions meet.
TriangleMesh make_star() {
  TriangleMesh star = make_sphere(2, Vec3::Zero(), 2);
  Random random(11);
  for (Vec3& p : star.points) p *= 0.2 + 0.8 * random.uniform();
  return star;
}

/// Asks for the side of random points and of some close to corners and edges. \return how many are told
int told_sides(const TriangleMesh& mesh, const SurfaceDistance& distance) {
  Random random(5);
  const auto anywhere = [&](double size) {
    return Vec3(size * (2 * random.uniform() - 1), size * (2 * random.uniform() - 1),
                size * (2 * random.uniform() - 1));
  };
  int told = 0;
  for (std::size_t i = 0; i < 3000; ++i) {
    const Triangle& t = mesh.triangles[i % mesh.triangles.size()];
    const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]];
    const std::array<Vec3, 3> points{anywhere(3), a + anywhere(0.05), (a + b) / 2 + anywhere(0.05)};
    const Vec3& p = points[i % 3];
    const auto place = distance.nearest(p, 10);
    if (!place || place->side == 0) continue;
    ++told;
    EXPECT_EQ(place->side < 0, distance.inside(p)) << p.transpose();
  }
  return told;
}

TEST(SurfaceDistance, ClosestTrianglesTellTheSide) {
  const TriangleMesh hollow =
      joined(make_box(Vec3(0, 0, 0), Vec3(3, 3, 3)), turned_over(make_box(Vec3(1, 1, 1), Vec3(2, 2, 2))));
  for (const TriangleMesh& mesh : {make_star(), turned(hollow), hollow, turned(make_torus(2, 0.5))}) {
    const int told = told_sides(mesh, distance_of(mesh));
    EXPECT_GT(told, 2000);
  }
}

TEST(SurfaceDistance, TrianglesWithTheInsideOnBothSidesTellIt) {
  // Both boxes are oriented outwards: the faces of the inner one have the inside on either side.
  const TriangleMesh twice =
      joined(make_box(Vec3(0, 0, 0), Vec3(3, 3, 3)), make_box(Vec3(1, 1, 1), Vec3(2, 2, 2)));
  const SurfaceDistance nested = distance_of(twice);
  EXPECT_GT(told_sides(twice, nested), 2000);
  EXPECT_EQ(nested.nearest(Vec3(1.5, 1.5, 1.9), 10)->side, -1);
  EXPECT_EQ(nested.nearest(Vec3(1.5, 1.5, 2.1), 10)->side, -1);
}

TEST(SurfaceDistance, OnlyTrianglesThatCrossNothingTellTheSide) {
  // Two spheres that cross: triangles at the curve between them have the inside on either side in parts.
  const TriangleMesh mesh = joined(make_sphere(2), make_sphere(2, {1.5, 0.1, 0.2}));
  for (const std::size_t closed : {mesh.triangles.size(), std::size_t{0}}) {
    const SurfaceDistance crossing{mesh.points, mesh.triangles, closed, {}, true};
    EXPECT_GT(told_sides(mesh, crossing), 1500);
    // On the curve in which the spheres meet, 1.5 x + 0.1 y + 0.2 z = 1.15.
    const auto at_curve = crossing.nearest(Vec3(0.64, 1.895, 0), 10);
    ASSERT_TRUE(at_curve);
    EXPECT_EQ(at_curve->side, 0);
    EXPECT_FALSE(at_curve->is_boundary);
    EXPECT_EQ(crossing.nearest(Vec3(-2.1, 0, 0), 10)->is_boundary, true);
    EXPECT_EQ(crossing.nearest(Vec3(1.9, 0.1, 0), 10)->is_boundary, false);
  }
}

TEST(SurfaceDistance, TrianglesNearCapsTellNoSide) {
  // A sphere without its top.
  TriangleMesh bowl = make_sphere(4);
  std::erase_if(bowl.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](Index p) { return bowl.points[p].z() > 3; });
  });
  TriangleMesh cap = square(6, 3, true);
  for (Vec3& p : cap.points) p -= Vec3(3, 3, 0);
  const SurfaceDistance open{bowl.points, bowl.triangles, 0, cap, false};
  EXPECT_GT(told_sides(bowl, open), 1000);
  EXPECT_EQ(open.nearest(Vec3(3, 0, 2.5), 10)->side, 0);
  EXPECT_EQ(open.nearest(Vec3(0.1, 0.2, -3.9), 10)->side, -1);
  EXPECT_EQ(open.nearest(Vec3(0.1, 0.2, -4.1), 10)->side, 1);
}

TEST(SurfaceDistance, EmptyBallsTouchNothing) {
  const TriangleMesh star = make_star();
  const SurfaceDistance distance = distance_of(star);
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(4 * random.uniform() - 2, 4 * random.uniform() - 2, 4 * random.uniform() - 2);
    const double nearest = (distance.nearest(p, 10)->point - p).norm();
    EXPECT_TRUE(distance.is_ball_empty(p, nearest * (1 - 1e-9)));
    EXPECT_FALSE(distance.is_ball_empty(p, nearest * (1 + 1e-9) + 1e-12));
  }
}

TEST(SurfaceDistance, ThicknessOfWallsAndGapsInAnyDirection) {
  for (const bool turn : {false, true}) {
    TriangleMesh two =
        joined(make_box(Vec3(0, 0, 0), Vec3(10, 10, 0.3)), make_box(Vec3(0, 0, 0.5), Vec3(10, 10, 3)));
    if (turn) two = turned(two);
    const SurfaceDistance distance = distance_of(two);
    const Vec3 up = turn ? Vec3(turned({{Vec3(0, 0, 1)}, {}}).points[0]) : Vec3(0, 0, 1);
    const Vec3 middle = turn ? Vec3(turned({{Vec3(5, 5, 0.35)}, {}}).points[0]) : Vec3(5, 5, 0.35);
    const auto place = distance.nearest(middle, 1);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->normal.dot(up), 1, 1e-12);
    EXPECT_NEAR(distance.thickness(*place, Side::wall, 0.9, 5), 0.3, 1e-6);
    EXPECT_NEAR(distance.thickness(*place, Side::gap, 0.9, 5), 0.2, 1e-6);
    EXPECT_EQ(distance.thickness(*place, Side::wall, 0.9, 0.25), 0.25);
  }
}

TEST(SurfaceDistance, ConvexEdgesAreNotThinAndWedgesAre) {
  const SurfaceDistance box = distance_of(make_box(Vec3(0, 0, 0), Vec3(4, 4, 4)));
  const auto near_edge = box.nearest(Vec3(0.01, 2, 4.1), 1);
  ASSERT_TRUE(near_edge);
  EXPECT_EQ(box.thickness(*near_edge, Side::wall, 0.3, 2), 2);
  // A wedge of 20 degrees: the ball at a distance x from the tip has the diameter 2 x tan(10 degrees).
  const double slope = std::tan(20 * M_PI / 180);
  TriangleMesh wedge;
  wedge.points = {Vec3(0, 0, 0), Vec3(10, 0, 0), Vec3(10, 0, 10 * slope),
                  Vec3(0, 9, 0), Vec3(10, 9, 0), Vec3(10, 9, 10 * slope)};
  wedge.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {0, 2, 5}, {0, 5, 3}};
  if (enclosed_volume(wedge) < 0) wedge = turned_over(wedge);
  const SurfaceDistance distance = distance_of(wedge);
  const auto below = distance.nearest(Vec3(1, 4.5, -0.1), 1);
  ASSERT_TRUE(below);
  EXPECT_NEAR(distance.thickness(*below, Side::wall, 0.9, 2), 2 * std::tan(10 * M_PI / 180), 1e-4);
  EXPECT_EQ(distance.thickness(*below, Side::wall, 0.99, 2), 2);
}

/// A pyramid without its top from a base of side 12 in the plane of z `base` to a square of side 8.
TriangleMesh frustum(double base, double top) {
  TriangleMesh mesh;
  for (const auto& [half, z] : {std::pair(6.0, base), std::pair(4.0, top)})
    for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
      mesh.points.push_back(Vec3(half * x, half * y, z));
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (Index i = 0; i < 4; ++i) {
    const Index j = (i + 1) % 4;
    mesh.triangles.push_back({i, j, j + 4});
    mesh.triangles.push_back({i, j + 4, i + 4});
  }
  return enclosed_volume(mesh) < 0 ? turned_over(mesh) : mesh;
}

TEST(SurfaceDistance, BodiesAlmostInContactDoNotTellTheSidesOfEachOther) {
  // A point beside the largest triangle of one, from which the sides of the others would follow, is beyond
  // the other one's.
  const double gap = 1e-6;
  const SurfaceDistance distance = distance_of(turned(joined(frustum(gap / 2, 5), frustum(-gap / 2, -5))));
  Random random(3);
  std::size_t known = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(16 * random.uniform() - 8, 16 * random.uniform() - 8, 16 * random.uniform() - 8);
    const auto place = distance.nearest(p, 20);
    ASSERT_TRUE(place);
    if (place->side == 0) continue;
    ++known;
    EXPECT_EQ(place->side < 0, distance.inside(p)) << p.transpose();
  }
  EXPECT_GT(known, 0u);
}

TEST(SurfaceDistance, AtAnEdgeTheFaceThatFacesThePoint) {
  const SurfaceDistance box = distance_of(make_box(Vec3(0, 0, 0), Vec3(4, 4, 4)));
  EXPECT_NEAR(box.nearest(Vec3(4.1, 2, 4.3), 1)->normal.z(), 1, 1e-12);
  EXPECT_NEAR(box.nearest(Vec3(4.3, 2, 4.1), 1)->normal.x(), 1, 1e-12);
}

}  // namespace
}  // namespace tetwright::surface_distance_test
