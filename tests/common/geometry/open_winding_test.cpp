// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/open_winding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "common/random.h"
#include "tests/mesher/test_surfaces.h"

namespace tetwright::open_winding_test {
namespace {

Vec3 random_vector(Random& random) {
  const double x = random.uniform(), y = random.uniform();
  return 2 * Vec3(x, y, random.uniform()) - Vec3::Ones();
}

/// How often edges are used from their lower to their higher number, less how often the other way round.
std::map<std::array<Index, 2>, int> boundary(const std::vector<Triangle>& triangles) {
  std::map<std::array<Index, 2>, int> edges;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      if (a != b) edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  std::erase_if(edges, [](const auto& e) { return e.second == 0; });
  return edges;
}

void expect_closed(const TriangleMesh& mesh) {
  std::vector<Triangle> all = mesh.triangles, closing = closing_triangles(mesh.triangles);
  std::size_t open = 0;
  for (const auto& [edge, surplus] : boundary(all)) open += static_cast<std::size_t>(std::abs(surplus));
  EXPECT_LE(closing.size(), open);
  all.insert(all.end(), closing.begin(), closing.end());
  EXPECT_TRUE(boundary(all).empty());
}

/// A wavy sheet of n by n squares.
TriangleMesh sheet(Index n) {
  TriangleMesh mesh;
  for (Index j = 0; j <= n; ++j)
    for (Index i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
      mesh.points.emplace_back(x, y, 0.3 * x * (1 - x) * (0.4 - y));
    }
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i) {
      const Index p = j * (n + 1) + i;
      mesh.triangles.push_back({p, p + 1, p + n + 2});
      mesh.triangles.push_back({p, p + n + 2, p + n + 1});
    }
  return mesh;
}

double max_difference(const TriangleMesh& mesh) {
  const OpenWinding open(mesh.points, mesh.triangles);
  Random random(3);
  double largest = 0;
  for (std::size_t i = 0; i < 1200; ++i) {
    const Triangle& t = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
    constexpr std::array<double, 6> sizes{1e-6, 1e-3, 0.02, 0.2, 2, 100};
    const Vec3 p = mesh.points[t[0]] + sizes[i % sizes.size()] * random_vector(random);
    largest =
        std::max(largest, std::fabs(open.winding_number(p) - winding_number(mesh.points, mesh.triangles, p)));
  }
  return largest;
}

TEST(OpenWinding, TrianglesCloseAnySurface) {
  expect_closed(make_sphere(1));
  EXPECT_TRUE(closing_triangles(make_sphere(1).triangles).empty());
  expect_closed(sheet(1));
  expect_closed(sheet(7));
  expect_closed(punctured(make_sphere(1, Vec3::Zero(), 4), 20));
  TriangleMesh fins = sheet(4);  // three and four triangles at an edge, some twice, some oriented otherwise
  fins.points.emplace_back(0.5, 0.5, 1);
  fins.points.emplace_back(0.5, 0.5, -1);
  for (const Triangle& t : {Triangle{6, 7, 25}, Triangle{7, 6, 26}, Triangle{6, 7, 26}, Triangle{6, 7, 26},
                            Triangle{3, 3, 9}, Triangle{12, 13, 25}})
    fins.triangles.push_back(t);
  expect_closed(fins);
}

TEST(OpenWinding, AgreesWithTheExactSum) {
  constexpr double promised = 0.01;
  EXPECT_LT(max_difference(sheet(30)), promised);
  EXPECT_LT(max_difference(punctured(make_sphere(1, {5, 6, 7}, 5), 20)), promised);
  EXPECT_LT(max_difference(joined(sheet(30), turned_over(sheet(20)))), promised);
  EXPECT_LT(max_difference(make_sphere(1)), 1e-12);
  EXPECT_LT(max_difference(sheet(1)), promised);  // too few triangles for its boundary: all of them are added
}

/// The boundary of the sheet is in one plane, and so are the triangles that close it.
TEST(OpenWinding, IsExactOnBothSidesOfTheClosingTriangles) {
  const TriangleMesh mesh = sheet(20);
  const OpenWinding open(mesh.points, mesh.triangles);
  Random random(4);
  for (int i = 0; i < 300; ++i) {
    const double x = random.uniform(), y = random.uniform();
    for (const double z : {-1e-17, -1e-30, 1e-30, 1e-17}) {
      const Vec3 p(x, y, z);
      EXPECT_NEAR(open.winding_number(p), winding_number(mesh.points, mesh.triangles, p), 0.01);
    }
  }
}

}  // namespace
}  // namespace tetwright::open_winding_test
