// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/triangle_intersection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "common/random.h"

namespace tetwright::triangle_intersection_test {
namespace {

MeshTriangle triangle(Triangle ids, Vec3 a, Vec3 b, Vec3 c) { return {ids, {a, b, c}}; }

/// Checks that all 36 orders of the vertices and both orders of the triangles give the same result, and
/// returns it.
bool intersect_in_any_order(const MeshTriangle& f, const MeshTriangle& g) {
  const bool first = triangles_intersect(f, g);
  std::array<int, 3> p{0, 1, 2};
  do {
    std::array<int, 3> q{0, 1, 2};
    do {
      MeshTriangle x, y;
      for (int k = 0; k < 3; ++k) {
        x.ids[k] = f.ids[p[k]];
        x.points[k] = f.points[p[k]];
        y.ids[k] = g.ids[q[k]];
        y.points[k] = g.points[q[k]];
      }
      EXPECT_EQ(triangles_intersect(x, y), first);
      EXPECT_EQ(triangles_intersect(y, x), first);
    } while (std::next_permutation(q.begin(), q.end()));
  } while (std::next_permutation(p.begin(), p.end()));
  return first;
}

// ------------------------------------------------------------------------------------------ brute force
// An independent check for small integer coordinates: two convex hulls of points are disjoint if and only if
// a plane separates them. There is then a separating plane whose normal is a cross product of two differences
// of the points (or, in degenerate cases, a difference, or the cross product of a difference and such a
// normal).
using IntVec = std::array<std::int64_t, 3>;
IntVec minus(const IntVec& a, const IntVec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
IntVec cross(const IntVec& a, const IntVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::int64_t dot(const IntVec& a, const IntVec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

bool separated_along(const IntVec& n, const std::vector<IntVec>& f, const std::vector<IntVec>& g) {
  std::int64_t f_low = INT64_MAX, f_high = INT64_MIN, g_low = INT64_MAX, g_high = INT64_MIN;
  for (const IntVec& p : f) f_low = std::min(f_low, dot(n, p)), f_high = std::max(f_high, dot(n, p));
  for (const IntVec& p : g) g_low = std::min(g_low, dot(n, p)), g_high = std::max(g_high, dot(n, p));
  return f_high < g_low || g_high < f_low;
}

bool hulls_meet(const std::vector<IntVec>& f, const std::vector<IntVec>& g) {
  std::vector<IntVec> all = f, normals, differences;
  all.insert(all.end(), g.begin(), g.end());
  for (const IntVec& a : all)
    for (const IntVec& b : all)
      if (a != b) differences.push_back(minus(a, b));
  for (const IntVec& d : differences) {
    normals.push_back(d);
    for (const IntVec& e : differences) {
      const IntVec n = cross(d, e);
      if (n == IntVec{0, 0, 0}) continue;
      normals.push_back(n);
      normals.push_back(cross(n, d));
    }
  }
  return std::none_of(normals.begin(), normals.end(),
                      [&](const IntVec& n) { return separated_along(n, f, g); });
}

bool brute_force(const Triangle& f, const Triangle& g, const std::vector<IntVec>& points) {
  std::vector<IntVec> f_all, g_all, f_other, g_other;
  std::vector<Index> shared;
  for (Index i : f) {
    f_all.push_back(points[i]);
    if (std::find(g.begin(), g.end(), i) != g.end())
      shared.push_back(i);
    else
      f_other.push_back(points[i]);
  }
  for (Index i : g) {
    g_all.push_back(points[i]);
    if (std::find(f.begin(), f.end(), i) == f.end()) g_other.push_back(points[i]);
  }
  if (shared.empty()) return hulls_meet(f_all, g_all);
  if (shared.size() == 1) return hulls_meet(f_other, g_all) || hulls_meet(g_other, f_all);
  if (shared.size() == 3) return true;
  const IntVec a = points[shared[0]], ab = minus(points[shared[1]], a);
  const IntVec n = cross(ab, minus(f_other[0], a)), m = cross(ab, minus(g_other[0], a));
  return cross(n, m) == IntVec{0, 0, 0} && dot(n, m) > 0;
}

/// Compares random triangles among `ids` points on a tiny grid, so that touching and coplanar ones are
/// common.
void compare_with_brute_force(std::uint64_t seed, std::uint32_t size, std::uint32_t flat, std::uint32_t ids,
                              bool degenerate) {
  Random random(seed);
  int met = 0, apart = 0;
  for (int round = 0; round < 2500; ++round) {
    std::vector<IntVec> points(ids);
    for (IntVec& p : points)
      p = {random.below(size), random.below(size), flat ? random.below(flat) : random.below(size)};
    std::vector<Index> order(ids);
    std::iota(order.begin(), order.end(), 0u);
    random.shuffle<Index>(order);
    const Triangle f{order[0], order[1], order[2]};
    random.shuffle<Index>(order);
    const Triangle g{order[0], order[1], order[2]};
    const auto area = [&](const Triangle& t) {
      return cross(minus(points[t[1]], points[t[0]]), minus(points[t[2]], points[t[0]]));
    };
    const IntVec none{0, 0, 0};
    if (!degenerate && (area(f) == none || area(g) == none)) continue;
    const auto at = [&](Index i) {
      return Vec3(static_cast<double>(points[i][0]), static_cast<double>(points[i][1]),
                  static_cast<double>(points[i][2]));
    };
    const bool expected = brute_force(f, g, points);
    (expected ? met : apart)++;
    ASSERT_EQ(triangles_intersect({f, {at(f[0]), at(f[1]), at(f[2])}}, {g, {at(g[0]), at(g[1]), at(g[2])}}),
              expected)
        << "seed " << seed << " round " << round;
  }
  EXPECT_GT(met, 20);
  EXPECT_GT(apart, 20);
}

TEST(TriangleIntersection, AgreesWithBruteForceInSpace) { compare_with_brute_force(1, 4, 0, 8, false); }
TEST(TriangleIntersection, AgreesWithBruteForceInALargerSpace) {
  compare_with_brute_force(2, 12, 0, 7, false);
}
TEST(TriangleIntersection, AgreesWithBruteForceInOnePlane) { compare_with_brute_force(3, 5, 1, 9, false); }
TEST(TriangleIntersection, AgreesWithBruteForceInTwoLayers) { compare_with_brute_force(4, 4, 2, 6, false); }
TEST(TriangleIntersection, AgreesWithBruteForceWithManySharedPoints) {
  compare_with_brute_force(5, 4, 0, 4, false);
}
TEST(TriangleIntersection, DegenerateTrianglesAreSegmentsAndPoints) {
  // No shared vertices: the convex hulls decide, whatever the shape.
  Random random(6);
  for (int round = 0; round < 4000; ++round) {
    std::vector<IntVec> p(6);
    for (IntVec& q : p) q = {random.below(3), random.below(3), random.below(2)};
    const auto at = [&](int i) {
      return Vec3(static_cast<double>(p[i][0]), static_cast<double>(p[i][1]), static_cast<double>(p[i][2]));
    };
    const bool expected = hulls_meet({p[0], p[1], p[2]}, {p[3], p[4], p[5]});
    ASSERT_EQ(triangles_intersect(triangle({0, 1, 2}, at(0), at(1), at(2)),
                                  triangle({3, 4, 5}, at(3), at(4), at(5))),
              expected)
        << "round " << round;
  }
}

TEST(TriangleIntersection, NeighboursOfASurfaceDoNotIntersect) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0), e(2, 2, 0.5);
  EXPECT_FALSE(intersect_in_any_order(triangle({0, 1, 2}, a, b, c), triangle({3, 2, 1}, d, c, b)));
  EXPECT_FALSE(intersect_in_any_order(triangle({0, 1, 2}, a, b, c), triangle({1, 3, 4}, b, d, e)));
}

TEST(TriangleIntersection, FoldedOntoItselfIntersects) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0.5, 1, 0), d(0.5, 0.5, 0);
  EXPECT_TRUE(intersect_in_any_order(triangle({0, 1, 2}, a, b, c), triangle({0, 1, 3}, a, b, d)));
  // Off the plane by the smallest possible step.
  EXPECT_FALSE(intersect_in_any_order(triangle({0, 1, 2}, a, b, c),
                                      triangle({0, 1, 3}, a, b, Vec3(0.5, 0.5, 0x1p-1074))));
}

TEST(TriangleIntersection, SharedVertexCountsOnlyBeyondIt) {
  const Vec3 o(0, 0, 0);
  const MeshTriangle f = triangle({0, 1, 2}, o, Vec3(2, -1, 0), Vec3(2, 1, 0));
  EXPECT_FALSE(intersect_in_any_order(f, triangle({0, 3, 4}, o, Vec3(-1, 0, 1), Vec3(-1, 0, -1))));
  EXPECT_TRUE(intersect_in_any_order(f, triangle({0, 3, 4}, o, Vec3(1, 0, 1), Vec3(1, 0, -1))));
  // The edge opposite the shared vertex touches the other triangle in one point.
  EXPECT_TRUE(intersect_in_any_order(f, triangle({0, 3, 4}, o, Vec3(1, 0, 0), Vec3(1, 0, 1))));
}

TEST(TriangleIntersection, TouchingWithoutASharedVertexCounts) {
  const MeshTriangle f = triangle({0, 1, 2}, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  EXPECT_TRUE(intersect_in_any_order(
      f, triangle({3, 4, 5}, Vec3(0.25, 0.25, 0), Vec3(0.25, 0.25, 1), Vec3(1, 1, 1))));
  EXPECT_TRUE(intersect_in_any_order(f, triangle({3, 4, 5}, Vec3(0, 0, 0), Vec3(-1, 0, 1), Vec3(-1, 0, 2))));
  EXPECT_FALSE(intersect_in_any_order(
      f, triangle({3, 4, 5}, Vec3(0.25, 0.25, 0x1p-1074), Vec3(0.25, 0.25, 1), Vec3(1, 1, 1))));
}

TEST(TriangleIntersection, TheSameTriangleTwiceIntersects) {
  const MeshTriangle f = triangle({0, 1, 2}, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  EXPECT_TRUE(intersect_in_any_order(f, f));
}

TEST(TriangleIntersection, RepeatedIdsAreHarmless) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(0.5, 0.5, -1);
  const MeshTriangle f = triangle({0, 1, 2}, a, b, c);
  EXPECT_FALSE(intersect_in_any_order(f, triangle({0, 0, 1}, a, a, b)));
  EXPECT_FALSE(intersect_in_any_order(f, triangle({0, 0, 0}, a, a, a)));
  EXPECT_FALSE(intersect_in_any_order(f, triangle({0, 0, 3}, a, a, d)));
  EXPECT_TRUE(intersect_in_any_order(f, triangle({0, 0, 3}, a, a, Vec3(0.25, 0.25, 0))));
}

}  // namespace
}  // namespace tetwright::triangle_intersection_test
