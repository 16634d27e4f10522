// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/surface_nesting.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/mesher/prepared.h"
#include "tests/mesher/test_surfaces.h"

namespace tetwright::surface_nesting_test {
namespace {

constexpr double unit_sphere = 4 * std::numbers::pi / 3;

/// Concentric spheres around the origin, oriented outwards if the sign is 1, and the winding numbers between
/// them.
struct Nest {
  std::vector<int> signs;  ///< for the radii 3, 2, 1 and so on
  NestedRule rule = NestedRule::automatic;

  TriangleMesh mesh() const {
    TriangleMesh all;
    double radius = static_cast<double>(signs.size());
    for (int sign : signs) {
      const TriangleMesh sphere = make_sphere(radius--, {0.1, 0.2, 0.3});
      all = joined(all, sign > 0 ? sphere : turned_over(sphere));
    }
    return all;
  }
  SurfaceRepair input() const { return repair_surface(mesh(), "", rule); }
};

std::vector<long> windings(const SurfaceRepair& input, std::size_t spheres) {
  std::vector<long> all;
  for (std::size_t k = 0; k < spheres; ++k) {
    const double at = static_cast<double>(spheres - k) - 0.5;
    all.push_back(std::lround(winding_at(input.surface, Vec3(0.1, 0.2, 0.3 + at))));
  }
  return all;
}

TEST(SurfaceNesting, AHollowSphereStaysHollow) {
  const SurfaceRepair right = Nest{{1, -1}}.input();
  EXPECT_EQ(windings(right, 2), (std::vector<long>{1, 0}));
  EXPECT_EQ(findings_text(right), "");
  EXPECT_NEAR(right.surface.volume, 7 * unit_sphere, 0.3);
  const SurfaceRepair inverted = Nest{{-1, 1}}.input();
  EXPECT_EQ(windings(inverted, 2), (std::vector<long>{1, 0}));
  EXPECT_EQ(findings_text(inverted), "1 components oriented inwards; ");
}

TEST(SurfaceNesting, WoundAlikeItIsPartOfTheSolid) {
  for (const int sign : {1, -1}) {
    const SurfaceRepair input = Nest{{sign, sign}}.input();
    EXPECT_EQ(windings(input, 2), (std::vector<long>{1, 1}));
    EXPECT_EQ(found(input, "enclosed components oriented like their enclosers"), 1u);
    EXPECT_NEAR(input.surface.volume, 8 * unit_sphere, 0.3);
  }
}

TEST(SurfaceNesting, ThreeSpheres) {
  EXPECT_EQ(windings(Nest{{1, -1, 1}}.input(), 3), (std::vector<long>{1, 0, 1}));
  EXPECT_EQ(windings(Nest{{-1, 1, -1}}.input(), 3), (std::vector<long>{1, 0, 1}));
  EXPECT_EQ(windings(Nest{{1, 1, -1}}.input(), 3), (std::vector<long>{1, 1, 0}));
  EXPECT_EQ(windings(Nest{{1, -1, -1}}.input(), 3), (std::vector<long>{1, 0, 0}));
  EXPECT_EQ(windings(Nest{{1, 1, 1}}.input(), 3), (std::vector<long>{1, 1, 1}));
}

TEST(SurfaceNesting, CavityTakesTurns) {
  for (const std::vector<int>& signs : {std::vector<int>{1, 1, 1}, {-1, -1, 1}, {1, -1, 1}, {-1, -1, -1}})
    EXPECT_EQ(windings(Nest{signs, NestedRule::cavity}.input(), 3), (std::vector<long>{1, 0, 1}));
  EXPECT_EQ(
      found(Nest{{1, 1}, NestedRule::cavity}.input(), "enclosed components oriented like their enclosers"),
      1u);
  EXPECT_EQ(findings_text(Nest{{1, -1}, NestedRule::cavity}.input()), "");
}

TEST(SurfaceNesting, SolidFillsCavities) {
  for (const std::vector<int>& signs : {std::vector<int>{1, 1, 1}, {-1, 1, -1}, {1, -1, 1}}) {
    const SurfaceRepair input = Nest{signs, NestedRule::solid}.input();
    EXPECT_EQ(windings(input, 3), (std::vector<long>{1, 1, 1}));
  }
  EXPECT_EQ(found(Nest{{1, -1}, NestedRule::solid}.input(), "cavities"), 1u);
}

TEST(SurfaceNesting, MaterialSplitsThemOutOutermostFirst) {
  const SurfaceRepair input = Nest{{1, -1, 1, -1}, NestedRule::material}.input();
  EXPECT_EQ(windings(input, 4), (std::vector<long>{1, 1, 1, 1}));
  ASSERT_EQ(input.nested.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const double radius = 3 - static_cast<double>(k);
    EXPECT_NEAR(input.nested[k].volume, unit_sphere * radius * radius * radius,
                0.02 * unit_sphere * radius * radius * radius);
    EXPECT_EQ(input.nested[k].closed, input.nested[k].triangles.size());
    EXPECT_NEAR(input.nested[k].high.x(), 0.1 + radius, 1e-9);
    EXPECT_NEAR(winding_at(input.nested[k], {0.1, 0.2, 0.3}), 1, 1e-9);
  }
  EXPECT_EQ(found(input, "enclosed components"), 3u);
  EXPECT_NEAR(input.surface.volume, 64 * unit_sphere, 3);
}

// The probe of each is inside the other one, but they intersect, so neither encloses the other.
TEST(SurfaceNesting, OverlappingSpheresOfOppositeSenseBecomeOne) {
  for (const double apart : {0.3, 1.0, 1.6})
    for (const double radius : {1.0, 0.8})
      for (const NestedRule rule : {NestedRule::automatic, NestedRule::cavity, NestedRule::solid}) {
        const TriangleMesh a = make_sphere(1), b = make_sphere(radius, {apart, 0.01, 0.02});
        const SurfaceRepair input = repair_surface(joined(a, turned_over(b)), "", rule);
        EXPECT_EQ(input.surface.closed, a.triangles.size() + b.triangles.size());
        EXPECT_EQ(found(input, "components oriented inwards"), 1u);
        EXPECT_NEAR(input.surface.volume, enclosed_volume(a) + enclosed_volume(b), 1e-9);
        EXPECT_GT(winding_at(input.surface, {0.5 * apart, 0.3, 0.1}), 0.9);
        EXPECT_GT(winding_at(input.surface, {apart + 0.9 * radius, 0.05, 0.05}), 0.9);
      }
}

// The first corner and the bounding box are inside the sphere, the last corner is not.
TEST(SurfaceNesting, WhatSticksOutIsNotEnclosed) {
  const TriangleMesh sphere = make_sphere(1), box = make_box({-0.2, -0.2, -0.2}, {0.7, 0.7, 0.7});
  for (const TriangleMesh& mesh : {joined(sphere, turned_over(box)), joined(turned_over(box), sphere)})
    for (const NestedRule rule : {NestedRule::automatic, NestedRule::cavity, NestedRule::material}) {
      const SurfaceRepair input = repair_surface(mesh, "", rule);
      EXPECT_NEAR(winding_at(input.surface, {0.69, 0.68, 0.67}), 1, 1e-9);
      EXPECT_NEAR(winding_at(input.surface, {0.1, 0.2, 0.3}), 2, 1e-9);
      EXPECT_TRUE(input.nested.empty());
    }
}

// The body in the shell crosses the wall of the cavity and must fill the part that it covers.
TEST(SurfaceNesting, WhatReachesIntoACavityIsKept) {
  const TriangleMesh shell = joined(make_sphere(3), turned_over(make_sphere(2)));
  const SurfaceRepair input = repair_surface(joined(shell, make_sphere(0.5, {2, 0, 0})), "");
  EXPECT_NEAR(winding_at(input.surface, {1.7, 0.01, 0.02}), 1, 1e-9);
  EXPECT_NEAR(winding_at(input.surface, {1.3, 0.01, 0.02}), 0, 1e-9);
  EXPECT_GT(winding_at(input.surface, {2.3, 0.01, 0.02}), 0.9);
}

TEST(SurfaceNesting, CavitiesOfScansWithHoles) {
  TriangleMesh outer = make_sphere(2), inner = make_sphere(1);
  outer.triangles.resize(outer.triangles.size() - 30);
  inner.triangles.resize(inner.triangles.size() - 30);
  for (const TriangleMesh& cavity : {make_sphere(1), inner}) {
    const TriangleMesh shell = joined(outer, turned_over(cavity));
    for (const TriangleMesh& mesh : {shell, turned_over(shell)}) {
      const SurfaceRepair input = repair_surface(mesh, "");
      EXPECT_LT(winding_at(input.surface, {-0.1, -0.2, 0.1}), 0.2);
      EXPECT_GT(winding_at(input.surface, {-1.5, 0.1, 0.1}), 0.8);
    }
  }
}

TEST(SurfaceNesting, ABowlHasAnOutsideASheetHasNone) {
  TriangleMesh bowl = make_sphere(1), sheet;
  std::erase_if(bowl.triangles, [&](const Triangle& t) { return bowl.points[t[0]].z() > 0.2; });
  const SurfaceRepair turned = repair_surface(turned_over(bowl), "");
  EXPECT_EQ(found(turned, "components oriented inwards"), 1u);
  EXPECT_GT(winding_at(turned.surface, {0, 0, -0.5}), 0.5);
  sheet.points = {{0, 0, 0.1}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}};
  sheet.triangles = {{0, 2, 1}, {0, 3, 2}};
  const SurfaceRepair kept = repair_surface(sheet, "");
  EXPECT_EQ(found(kept, "open components whose outside is unclear"), 1u);
  EXPECT_EQ(found(kept, "components oriented inwards"), 0u);
  EXPECT_LT(winding_at(kept.surface, {0.4, 0.5, -0.01}), 0);
}

// Rows of boxes, each with a cavity: finding enclosers must not test all pairs.
TEST(SurfaceNesting, ManyComponents) {
  constexpr int side = 60;
  TriangleMesh mesh;
  const auto append = [&](const TriangleMesh& part) {
    const auto shift = static_cast<Index>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), part.points.begin(), part.points.end());
    for (const auto& [a, b, c] : part.triangles) mesh.triangles.push_back({a + shift, b + shift, c + shift});
  };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const Vec3 low(2.0 * i, 0, 2.0 * j);
      append(make_box(low, low + Vec3(1, 1, 1)));
      append(turned_over(make_box(low + Vec3(0.25, 0.25, 0.25), low + Vec3(0.75, 0.75, 0.75))));
    }
  const SurfaceRepair input = repair_surface(mesh, "");
  EXPECT_EQ(findings_text(input), "");
  EXPECT_NEAR(input.surface.volume, side * side * (1 - 0.125), 1e-6);
}

}  // namespace
}  // namespace tetwright::surface_nesting_test
