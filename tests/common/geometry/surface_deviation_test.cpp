// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/geometry/projection_tree.h"
#include "common/random.h"
#include "tetwright/resources.h"

namespace tetwright {
namespace {

struct Surface {
  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> items;
  ProjectionTree tree() const { return {points, items}; }
};

/// Graph of a function over n x n squares of [0, 1]^2, two triangles each.
template <class Height>
Surface graph(Index n, const Height& height) {
  Surface s;
  for (Index y = 0; y <= n; ++y)
    for (Index x = 0; x <= n; ++x) {
      const double u = static_cast<double>(x) / n, v = static_cast<double>(y) / n;
      s.points.emplace_back(u, v, height(u, v));
    }
  for (Index y = 0; y < n; ++y)
    for (Index x = 0; x < n; ++x) {
      const Index a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      s.items.push_back({{a, b, d}, {}});
      s.items.push_back({{a, d, c}, {}});
    }
  return s;
}

double flat(double, double) { return 0; }

double distance(const Vec3& p, const Surface& to) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& t : to.items)
    nearest = std::min(nearest, squared_distance(p, to.points[t.corners[0]], to.points[t.corners[1]],
                                                 to.points[t.corners[2]]));
  return std::sqrt(nearest);
}

/// Maximum distance of many points of the triangles.
double farthest_point(const Surface& from, const Surface& to, int steps) {
  double farthest = 0;
  for (const auto& item : from.items)
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const Vec3& a = from.points[item.corners[0]];
        farthest = std::max(farthest, distance(a + (from.points[item.corners[1]] - a) * i / steps +
                                                   (from.points[item.corners[2]] - a) * j / steps,
                                               to));
      }
  return farthest;
}

void expect_between(const SurfaceDeviation& d, double truth) {
  EXPECT_LE(d.lower, truth * (1 + 1e-12) + 1e-15);
  EXPECT_GE(d.upper, truth * (1 - 1e-12) - 1e-15);
  EXPECT_LE(d.upper, std::max(1.01 * d.lower, d.lower + 1e-6) + 1e-15);
}

TEST(SurfaceDeviation, OfPlanesIsTheirDistance) {
  const Surface below = graph(3, flat), above = graph(7, [](double, double) { return 0.25; });
  for (const auto& d : {surface_deviation(below.tree(), above.tree(), 1e-6),
                        surface_deviation(above.tree(), below.tree(), 1e-6)}) {
    expect_between(d, 0.25);
    EXPECT_NEAR(d.rms, 0.25, 1e-12);
  }
}

TEST(SurfaceDeviation, OfASurfaceFromItselfIsNothing) {
  const Surface wave = graph(20, [](double u, double v) { return std::sin(9 * u) * std::cos(7 * v); });
  const SurfaceDeviation d = surface_deviation(wave.tree(), wave.tree(), 1e-6);
  EXPECT_LT(d.lower, 1e-13);
  EXPECT_LE(d.upper, 1e-6);
  EXPECT_LT(d.rms, 1e-12);
}

// One triangle over a ridge: its corners are on the other surface, but it deviates by 0.3 between them.
TEST(SurfaceDeviation, IsFoundBetweenTheCorners) {
  const Surface roof = graph(40, [](double u, double) { return 0.3 * (1 - std::abs(2 * u - 1)); });
  Surface floor;
  floor.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  floor.items = {{{0, 1, 2}, {}}, {{0, 2, 3}, {}}};
  // The ridge is 0.3 above the floor; the floor below the ridge is nearer to the slopes.
  expect_between(surface_deviation(roof.tree(), floor.tree(), 1e-6), 0.3);
  const SurfaceDeviation d = surface_deviation(floor.tree(), roof.tree(), 1e-6);
  expect_between(d, 0.3 / std::sqrt(1 + 0.36));
  EXPECT_NEAR(d.place.x(), 0.5, 0.01);
  // Below the slopes, distances grow linearly from 0 to the maximum.
  EXPECT_NEAR(d.rms, d.lower / std::sqrt(3), 0.01 * d.lower);
}

TEST(SurfaceDeviation, IsThatOfASearchOfManyPoints) {
  Random random(5);
  for (int round = 0; round < 5; ++round) {
    const auto number = [&] { return 2 * random.uniform() - 1; };
    const auto soup = [&](Index count, double size) {
      Surface s;
      for (Index i = 0; i < count; ++i) {
        const Vec3 c(number(), number(), number());
        for (int k = 0; k < 3; ++k) s.points.push_back(c + size * Vec3(number(), number(), number()));
        s.items.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, {}});
      }
      return s;
    };
    const Surface from = soup(20, 0.8), to = soup(60, 0.5);
    const SurfaceDeviation d = surface_deviation(from.tree(), to.tree(), 1e-6);
    const double farthest = farthest_point(from, to, 60);
    EXPECT_GE(d.upper, farthest);
    EXPECT_GE(d.lower, 0.99 * farthest);  // the lower bound is attained
    EXPECT_LE(d.upper, 1.01 * d.lower + 1e-12);
    EXPECT_NEAR(distance(d.place, to), d.lower, 1e-12);
  }
}

// With an accuracy that is always reached the upper bound is that of the whole triangle.
TEST(SurfaceDeviation, OfATriangleOverAFanIsBoundedBeforeAnyCut) {
  Random random(7);
  const auto number = [&] { return 2 * random.uniform() - 1; };
  for (int round = 0; round < 200; ++round) {
    // A fan around a point at any height, parts of it flat; the triangle lies over one to all of its
    // triangles.
    const Index sides = 3 + static_cast<Index>(4 * random.uniform());
    const double height = round % 3 == 0 ? 0 : number();
    Surface fan, triangle;
    fan.points.emplace_back(0, 0, height);
    for (Index i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      fan.points.emplace_back(std::cos(angle), std::sin(angle), round % 3 == 0 ? 0 : 0.3 * number());
      fan.items.push_back({{0, 1 + i, 1 + (i + 1) % sides}, {}});
    }
    for (int k = 0; k < 3; ++k)
      triangle.points.emplace_back(0.4 * number(), 0.4 * number(), height + 0.05 * number());
    triangle.items.push_back({{0, 1, 2}, {}});
    const SurfaceDeviation d = surface_deviation(triangle.tree(), fan.tree(), 1e3);
    EXPECT_GE(d.upper, farthest_point(triangle, fan, 20) * (1 - 1e-12)) << round;
  }
}

TEST(SurfaceDeviation, OfALidOverAPitIsBoundedBeforeAnyCut) {
  // The lid's corners are on the pit's walls, each near the next edge between two walls.
  Surface pit, lid;
  for (Index i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3;
    pit.points.emplace_back(std::cos(angle), std::sin(angle), 0);
    pit.items.push_back({{i, (i + 1) % 3, 3}, {}});
  }
  pit.points.emplace_back(0, 0, -9);
  for (Index i = 0; i < 3; ++i) lid.points.push_back(0.98 * pit.points[i] + 0.02 * pit.points[(i + 1) % 3]);
  lid.items.push_back({{0, 1, 2}, {}});
  EXPECT_GE(surface_deviation(lid.tree(), pit.tree(), 1e3).upper, farthest_point(lid, pit, 30));
}

TEST(SurfaceDeviation, OfAFlatPartIsKnownBeforeAnyCut) {
  // A triangle in three parts; other triangles over an edge of two of them, and over all three.
  const Surface floor{{{0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
                      {{{0, 1, 2}, {}}, {{0, 2, 3}, {}}, {{0, 3, 1}, {}}}};
  for (const double x : {0.3, 0.1}) {
    const Surface triangle{{{x, 0.1, 0.01}, {x, -0.1, 0.01}, {x - 0.25, 0.02, 0.01}}, {{{0, 1, 2}, {}}}};
    EXPECT_NEAR(surface_deviation(triangle.tree(), floor.tree(), 1e3).upper, 0.01, 1e-12) << x;
  }
}

TEST(TrianglesBeyond, AreThoseWithAPointThatFar) {
  const auto wave = [](double u, double v) { return 0.1 * std::sin(9 * u) * std::cos(7 * v); };
  const ProjectionTree from = graph(6, wave).tree(), to = graph(14, wave).tree();
  constexpr double limit = 0.02, accuracy = 1e-7;
  const auto distance = [&](const Vec3& p) {
    return (to.nearest_of(p, 1, [](const ProjectionTree::Item&) { return true; })->point - p).norm();
  };
  const std::vector<FarTriangle> far = triangles_beyond(from, to, limit, accuracy);
  std::size_t listed = 0, between_corners = 0;
  for (std::uint32_t i = 0; i < from.items().size(); ++i) {
    const ProjectionTree::Item& item = from.items()[i];
    const Vec3 &a = from.corner(item, 0), &b = from.corner(item, 1), &c = from.corner(item, 2);
    constexpr int steps = 40;
    double farthest = 0;
    for (int u = 0; u <= steps; ++u)
      for (int v = 0; u + v <= steps; ++v)
        farthest = std::max(farthest, distance(a + (b - a) * u / steps + (c - a) * v / steps));
    if (listed < far.size() && far[listed].item == i) {
      // Every point is within this distance of a sampled one.
      EXPECT_GT(farthest + ((b - a).norm() + (c - a).norm()) / steps, limit);
      between_corners += std::max({distance(a), distance(b), distance(c)}) <= limit;
      ++listed;
    } else {
      EXPECT_LE(farthest, limit + accuracy);
    }
  }
  EXPECT_EQ(listed, far.size());  // each once, ascending
  EXPECT_GT(between_corners, 5);  // invisible at the corners
  EXPECT_LT(listed, 60);          // of 72
}

TEST(SurfaceDeviation, DoesNotDependOnTheThreads) {
  const Surface wave = graph(60, [](double u, double v) { return 0.1 * std::sin(9 * u) * std::cos(7 * v); });
  const Surface coarse = graph(9, [](double u, double v) { return 0.1 * std::sin(9 * u) * std::cos(7 * v); });
  SurfaceDeviation alone;
  {
    const ThreadLimit one(1);
    alone = surface_deviation(coarse.tree(), wave.tree(), 1e-7);
  }
  const ThreadLimit many(8);
  const SurfaceDeviation d = surface_deviation(coarse.tree(), wave.tree(), 1e-7);
  EXPECT_EQ(d.lower, alone.lower);
  EXPECT_EQ(d.upper, alone.upper);
  EXPECT_EQ(d.rms, alone.rms);
  EXPECT_EQ(d.place, alone.place);
}

TEST(SurfaceDeviation, OfNothingAndFromNothing) {
  const Surface square = graph(1, flat);
  EXPECT_EQ(surface_deviation(ProjectionTree(), square.tree(), 1).upper, 0);
  EXPECT_TRUE(std::isinf(surface_deviation(square.tree(), ProjectionTree(), 1).lower));
  // A triangle reduced to a point.
  Surface point;
  point.points = {{0.5, 0.5, 2}};
  point.items = {{{0, 0, 0}, {}}};
  expect_between(surface_deviation(point.tree(), square.tree(), 1e-6), 2);
}

}  // namespace
}  // namespace tetwright
