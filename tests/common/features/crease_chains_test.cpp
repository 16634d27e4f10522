// SPDX-License-Identifier: Apache-2.0
#include "common/features/crease_chains.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/common/features/parts.h"
#include "tests/mesher/test_surfaces.h"

namespace tetwright::crease_chains_test {
namespace {

using Fate = CreaseChain::Fate;
constexpr FeatureAngle automatic{};
constexpr double degree = std::numbers::pi / 180;

CreaseChains chains_of(const TriangleMesh& s, double min_area = 0, const FeatureAngle& angle = automatic,
                       std::span<const std::uint32_t> groups = {}) {
  return find_patches(s.points, s.triangles, {angle, min_area, true}, groups, "s.off").chains;
}

/// Expects that all chains have the fate.
void expect_all(const CreaseChains& chains, Fate fate, std::size_t count, double length) {
  EXPECT_EQ(chains.count(), count);
  EXPECT_EQ(chains.total(fate).count, count);
  EXPECT_NEAR(chains.total(fate).length, length, 1e-9);
  for (const CreaseChain& c : chains.longest) EXPECT_EQ(c.fate, fate);
}

TEST(CreaseChains, OfABoxAreItsEdges) {
  const TriangleMesh box = turned(unit_cube());
  const CreaseChains chains = chains_of(box);
  expect_all(chains, Fate::kept, 12, 12);
  ASSERT_EQ(chains.longest.size(), 12U);
  for (const CreaseChain& c : chains.longest) {
    EXPECT_NEAR(c.length, 1, 1e-12);
    EXPECT_NEAR(c.turn, 90 * degree, 1e-9);
    ASSERT_EQ(c.line.size(), 2U);
    EXPECT_LT((c.middle - (c.line[0] + c.line[1]) / 2).norm(), 1e-12);
    EXPECT_FALSE(c.distance);
  }
  // They are listed on request only, and not if the angle is off.
  EXPECT_EQ(find_patches(box.points, box.triangles, {automatic, 0}, {}, "s.off").chains.count(), 0U);
  EXPECT_EQ(chains_of(box, 0, {FeatureAngle::Rule::off, 0}).count(), 0U);
}

TEST(CreaseChains, MayBeClosed) {
  const CreaseChains chains = chains_of(turned(cylinder(64)));
  expect_all(chains, Fate::kept, 2, 2 * 64 * std::sin(std::numbers::pi / 64));
  for (const CreaseChain& c : chains.longest) {
    EXPECT_EQ(c.line.size(), 65U);
    EXPECT_EQ(c.line.front(), c.line.back());
    // The middle of a rim is opposite its first point.
    EXPECT_NEAR((c.middle - c.line.front()).norm(), 1, 1e-9);
  }
}

TEST(CreaseChains, EndAtJunctionsAndAreSortedByLength) {
  // The rim of a prism of six facets is in six chains between the edges of its sides; these are longer.
  const CreaseChains chains = chains_of(cylinder(6, 0.5, 3));
  expect_all(chains, Fate::kept, 18, 6 * 3 + 12 * 0.5);
  for (std::size_t i = 0; i < 18; ++i) EXPECT_NEAR(chains.longest[i].length, i < 6 ? 3 : 0.5, 1e-12) << i;
  EXPECT_NEAR(chains.longest[0].turn, 60 * degree, 1e-9);
}

TEST(CreaseChains, FadeOutWithinPatches) {
  // The fold turns by more than 35 degrees along 8 + 3 of 32.
  const FeatureAngle angle{FeatureAngle::Rule::degrees, 35};
  const CreaseChains faded = chains_of(folded_strip(8), 0, angle);
  ASSERT_EQ(faded.longest.size(), 1U);
  expect_all(faded, Fate::faded, 1, faded.longest[0].length);
  EXPECT_NEAR(faded.longest[0].length, 11, 1);
  EXPECT_NEAR(faded.longest[0].middle.y(), 5.5, 0.5);
  EXPECT_TRUE(faded.longest[0].line.empty());
  const CreaseChains kept = chains_of(folded_strip(20), 0, angle);
  expect_all(kept, Fate::kept, 1, kept.longest.at(0).length);
  EXPECT_NEAR(kept.longest[0].length, 23, 1);
}

TEST(CreaseChains, AreNoiseOnNoisyParts) {
  const CreaseChains chains = chains_of(terrain(24));
  // Four edges of the base, four between the walls, and the rims of the walls at the terrain.
  EXPECT_NEAR(chains.total(Fate::kept).length, 4 + 4 + 4, 0.5);
  EXPECT_GT(chains.total(Fate::noise).count, 20U);
  EXPECT_EQ(chains.count(), chains.total(Fate::kept).count + chains.total(Fate::noise).count);
  for (const CreaseChain& c : chains.longest)
    if (c.fate == Fate::noise) {
      EXPECT_GT(c.middle.z(), 0.9);
    }
}

TEST(CreaseChains, OfSmallPatchesAreSmall) {
  // All but one side of the small box are merged, which leaves it no edge.
  const TriangleMesh bump =
      extruded({{0.4, 0.4}, {0.41, 0.4}, {0.41, 0.41}, {0.4, 0.41}}, {0.405, 0.405}, 0.01);
  const TriangleMesh s = joined(unit_cube(), bump);
  expect_all(chains_of(s), Fate::kept, 24, 12.12);
  const CreaseChains chains = chains_of(s, 0.01);
  EXPECT_EQ(chains.total(Fate::kept).count, 12U);
  EXPECT_EQ(chains.total(Fate::small).count, 12U);
  EXPECT_NEAR(chains.total(Fate::small).length, 0.12, 1e-12);
  for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(chains.longest[i].fate, i < 12 ? Fate::kept : Fate::small);
}

TEST(CreaseChains, OfStaircasesAreGivenUp) {
  // Cubes apart from each other, each with six patches.
  TriangleMesh s;
  for (int i = 0; i < 50; ++i) {
    TriangleMesh cube = unit_cube();
    for (Vec3& p : cube.points) p.x() += 2 * i;
    s = joined(s, cube);
  }
  ASSERT_EQ(find_patches(s.points, s.triangles, {}, {}, "s.off").verdict, SurfacePatches::Verdict::staircase);
  const CreaseChains chains = chains_of(s);
  expect_all(chains, Fate::given_up, 600, 600);
  EXPECT_EQ(chains.longest.size(), CreaseChains::max_listed);
}

TEST(CreaseChains, AreGivenUpWhereTheMeshCannotHaveThem) {
  const TriangleMesh s = unit_cube();
  std::vector<std::uint32_t> groups;
  for (const Triangle& t : s.triangles)
    groups.push_back(s.points[t[0]].z() + s.points[t[1]].z() + s.points[t[2]].z() == 3 ? 1 : 0);
  CreaseChains chains = chains_of(s, 0, automatic, groups);
  EXPECT_EQ(chains.count(), 12U);
  EXPECT_EQ(chains.total(Fate::kept).count, 8U);
  EXPECT_EQ(chains.total(Fate::kept_groups).count, 4U);
  // The half beyond x = 0.5: of four edges all, two of which are between groups or not, of four others half.
  chains = find_crease_chains(
      s.points, s.triangles, {automatic, 0}, groups, [](const Vec3& p) { return p.x() > 0.55; }, 0.1);
  EXPECT_EQ(chains.total(Fate::kept_groups).count, 4U);
  EXPECT_EQ(chains.total(Fate::kept_groups).length, 4);
  EXPECT_NEAR(chains.total(Fate::given_up).length, 3 + 2 * 0.5, 1e-9);
  EXPECT_NEAR(chains.total(Fate::kept).length, 3 + 2 * 0.5, 1e-9);
  for (const CreaseChain& c : chains.longest) EXPECT_EQ(c.line.empty(), c.fate == Fate::given_up);
}

TEST(CreaseChains, HaveAnyNumberOfPatches) {
  TriangleMesh s = make_sphere(1, Vec3::Zero(), 7);
  Random random(1);
  for (Vec3& p : s.points) p *= 1 + 0.1 * (random.uniform() - 0.5);
  const CreaseChains chains =
      find_crease_chains(s.points, s.triangles, {{FeatureAngle::Rule::degrees, 1}, 0}, {});
  EXPECT_GT(chains.total(Fate::kept).count, 65535U);
}

}  // namespace
}  // namespace tetwright::crease_chains_test
