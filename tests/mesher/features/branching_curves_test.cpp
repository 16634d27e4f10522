// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/branching_curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tetwright {
namespace {

/// The points of a curve; its edges are given as such, so that no faces are needed but for regions.
LabelledComplex complex_of(std::vector<Vec3> points) {
  LabelledComplex complex;
  complex.points = std::move(points);
  return complex;
}

std::vector<std::uint8_t> no_ends(const LabelledComplex& complex) {
  return std::vector<std::uint8_t>(complex.points.size(), 0);
}

TEST(BranchingCurves, AreChainsOfTheSpacingAskedFor) {
  const LabelledComplex complex = complex_of({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}});
  const std::vector<std::array<Index, 2>> edges{{0, 1}, {1, 2}};
  BranchingCurves curves(complex, edges, no_ends(complex));
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_DOUBLE_EQ(curves.length(0), 4);
  curves.divide([](Index, double) { return 0.5; }, 0.1);
  ASSERT_EQ(curves.vertices().size(), 9u);
  for (const BranchingCurves::Vertex& v : curves.vertices())
    for (const Index w : v.next) EXPECT_NEAR((curves.vertices()[w].position - v.position).norm(), 0.5, 1e-9);
  EXPECT_EQ(curves.vertices()[curves.ends(0)[0]].position, Vec3(0, 0, 0));
  EXPECT_EQ(curves.vertices()[curves.ends(0)[1]].position, Vec3(3, 1, 0));
}

TEST(BranchingCurves, SpacingMayVary) {
  const LabelledComplex complex = complex_of({{0, 0, 0}, {4, 0, 0}});
  const std::vector<std::array<Index, 2>> edges{{0, 1}};
  BranchingCurves curves(complex, edges, no_ends(complex));
  curves.divide([](Index, double along) { return along < 2 ? 0.25 : 1; }, 0.125);
  std::size_t first_half = 0;
  for (const BranchingCurves::Vertex& v : curves.vertices()) first_half += v.position.x() < 2 - 1e-9;
  EXPECT_EQ(first_half, 8u);
  EXPECT_EQ(curves.vertices().size(), 11u);
}

TEST(BranchingCurves, EndWhereFurtherSheetsMeet) {
  const LabelledComplex complex = complex_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const std::vector<std::array<Index, 2>> edges{{0, 1}, {1, 2}};
  const BranchingCurves curves(complex, edges, {0, 1, 0});
  EXPECT_EQ(curves.size(), 2u);
}

TEST(BranchingCurves, BranchInOneVertex) {
  const LabelledComplex complex = complex_of({{0, 0, 0}, {2, 0, 0}, {-2, 0, 0}, {0, 2, 0}});
  const std::vector<std::array<Index, 2>> edges{{0, 1}, {0, 2}, {0, 3}};
  BranchingCurves curves(complex, edges, no_ends(complex));
  ASSERT_EQ(curves.size(), 3u);
  curves.divide([](Index, double) { return 1.0; }, 0.5);
  std::size_t branching = 0;
  for (const BranchingCurves::Vertex& v : curves.vertices()) branching += v.next.size() == 3;
  EXPECT_EQ(branching, 1u);
  for (Index c = 0; c < 3; ++c) EXPECT_NE(curves.branches(c)[0], curves.branches(c)[1]);
}

TEST(BranchingCurves, MayBeClosed) {
  std::vector<Vec3> points;
  std::vector<std::array<Index, 2>> edges;
  for (Index k = 0; k < 12; ++k) {
    const double angle = k * std::numbers::pi / 6;
    points.emplace_back(std::cos(angle), std::sin(angle), 0);
    edges.push_back(ascending_edge(k, (k + 1) % 12));
  }
  const LabelledComplex complex = complex_of(points);
  BranchingCurves curves(complex, edges, no_ends(complex));
  ASSERT_EQ(curves.size(), 1u);
  for (const double spacing : {0.5, 100.0}) {
    curves.divide([&](Index, double) { return spacing; }, 0.1);
    EXPECT_GE(curves.vertices().size(), 3u);
    for (const BranchingCurves::Vertex& v : curves.vertices()) EXPECT_EQ(v.next.size(), 2u);
  }
}

TEST(BranchingCurves, LocateTheNearestVertex) {
  const LabelledComplex complex = complex_of({{0, 0, 0}, {4, 0, 0}});
  const std::vector<std::array<Index, 2>> edges{{0, 1}};
  BranchingCurves curves(complex, edges, no_ends(complex));
  curves.divide([](Index, double) { return 1.0; }, 0.25);
  EXPECT_FALSE(curves.locate({2, 1, 0}, 0.5));
  const auto found = curves.locate({2.2, 0.3, 0.4}, 1);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->along, 2.2, 1e-12);
  EXPECT_NEAR(found->distance, 0.5, 1e-12);
  EXPECT_NEAR(curves.vertices()[curves.nearest_vertex(*found)].position.x(), 2, 1e-9);
}

TEST(BranchingCurves, KnowTheRegionsAround) {
  LabelledComplex complex = complex_of({{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}});
  complex.faces = {{{0, 1, 2}, 1, 2}, {{0, 1, 3}, 2, outside_region}};
  const std::vector<std::array<Index, 2>> edges{{0, 1}};
  BranchingCurves curves(complex, edges, no_ends(complex));
  curves.divide([](Index, double) { return 0.5; }, 0.25);
  for (const BranchingCurves::Vertex& v : curves.vertices()) {
    EXPECT_EQ(v.regions, (std::vector<RegionIndex>{outside_region, 1, 2}));
    EXPECT_TRUE(v.is_on_boundary());
  }
}

}  // namespace
}  // namespace tetwright
