// SPDX-License-Identifier: Apache-2.0

// Open surfaces that close together become one body, or several.
#include "mesher/input/patch_joining.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"
#include "tetwright/mesher_input.h"

namespace tetwright::patch_joining_test {
namespace {

/// Appends the sides of a box, of which `left_out` is none, each a surface; 0 to 5 are low x, high x and so
/// on.
void add_sides(const Vec3& low, const Vec3& high, std::vector<MaterialSurface>& surfaces, int left_out = 6) {
  const TriangleMesh box = make_box(low, high);
  for (int side = 0; side < 6; ++side) {
    if (side == left_out) continue;
    TriangleMesh own{.points = box.points};
    for (const Triangle& t : box.triangles)
      if (std::all_of(t.begin(), t.end(),
                      [&](Index p) { return box.points[p][side / 2] == (side % 2 ? high : low)[side / 2]; }))
        own.triangles.push_back(t);
    const std::string name = "p" + std::to_string(surfaces.size() + 1);
    surfaces.push_back({name, static_cast<MaterialTag>(surfaces.size() + 1), own, name + ".off"});
  }
}

std::vector<MaterialSurface> cube(int left_out = 6) {
  std::vector<MaterialSurface> surfaces;
  add_sides({0, 0, 0}, {1, 1, 1}, surfaces, left_out);
  return surfaces;
}

/// A box without one of its sides.
MaterialSurface open_box(const Vec3& low, const Vec3& high, int side, const std::string& name,
                         MaterialTag tag) {
  std::vector<MaterialSurface> sides;
  add_sides(low, high, sides, side);
  TriangleMesh all = sides[0].surface;
  for (std::size_t k = 1; k < sides.size(); ++k) all = joined(all, sides[k].surface);
  return {name, tag, all, name + ".off"};
}

MesherInput input_of(std::vector<MaterialSurface> surfaces, const RegionOptions& regions = {}) {
  return make_mesher_input(std::move(surfaces), {}, NestedRule::automatic, {}, regions);
}

const Diagnostic* found(const MesherInput& input, DiagnosticCode code) {
  for (const Diagnostic& f : input.findings)
    if (f.code == code) return &f;
  return nullptr;
}

TEST(PatchJoining, SixSquaresAreACube) {
  const MesherInput input = input_of(cube());
  ASSERT_EQ(input.bodies.size(), 1U);
  const MesherInput::Body& body = input.bodies[0];
  EXPECT_EQ(body.name, "p1");
  EXPECT_EQ(body.tag, 1);
  EXPECT_NEAR(body.surface.volume, 1, 1e-12);
  EXPECT_EQ(body.surface.closed, 12U);
  ASSERT_EQ(input.groups.size(), 6U);
  EXPECT_EQ(input.groups[5].group.name, "p6");
  EXPECT_NEAR(input.groups[5].area, 1, 1e-12);
  EXPECT_TRUE(input.holes.empty());
  const Diagnostic* joined = found(input, DiagnosticCode::surfaces_joined);
  ASSERT_TRUE(joined);
  EXPECT_EQ(joined->count, 6U);
  EXPECT_NE(joined->done.find("1 cell;"), std::string::npos) << joined->done;
  EXPECT_EQ(input_of(cube(), {.seeds = {{"air", {0.5, 0.5, 0.5}}}}).bodies[0].name, "air");
}

TEST(PatchJoining, ElevenSquaresAreTwoCubes) {
  std::vector<MaterialSurface> surfaces = cube();
  add_sides({1, 0, 0}, {3, 1, 1}, surfaces, 0);
  const MesherInput input = input_of(surfaces);
  ASSERT_EQ(input.bodies.size(), 2U);
  EXPECT_EQ(input.bodies[0].name, "p1_1");
  EXPECT_NEAR(input.bodies[0].surface.volume, 2, 1e-12);
  EXPECT_NEAR(input.bodies[1].surface.volume, 1, 1e-12);
  EXPECT_EQ(input.bodies[1].tag, 2);
  ASSERT_EQ(input.contacts.size(), 1U);
  EXPECT_NEAR(input.contacts[0].area, 1, 1e-12);
}

TEST(PatchJoining, TheOrderDecidesOnlyNames) {
  std::vector<MaterialSurface> surfaces = cube();
  add_sides({1, 0, 0}, {3, 1, 1}, surfaces, 0);
  const MesherInput input = input_of(surfaces);
  std::reverse(surfaces.begin(), surfaces.end());
  const MesherInput other = input_of(surfaces);
  ASSERT_EQ(other.bodies.size(), 2U);
  EXPECT_EQ(other.bodies[0].name, "p11_1");
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_EQ(input.bodies[b].surface.points, other.bodies[b].surface.points);
    EXPECT_EQ(input.bodies[b].surface.triangles, other.bodies[b].surface.triangles);
  }
}

TEST(PatchJoining, GapsWithinTheToleranceAreClosed) {
  for (const double gap : {1e-6, 1e-3}) {
    std::vector<MaterialSurface> surfaces = cube();
    for (Vec3& p : surfaces[5].surface.points) p.z() += gap;
    const MesherInput input = input_of(surfaces);
    EXPECT_EQ(input.bodies.size(), gap < 1e-4 ? 1U : 6U);
    EXPECT_EQ(input.bodies[0].surface.closed > 0, gap < 1e-4);
  }
}

TEST(PatchJoining, TheOutlineAloneIfAsked) {
  std::vector<MaterialSurface> surfaces = cube();
  add_sides({1, 0, 0}, {3, 1, 1}, surfaces, 0);
  for (Vec3& p : surfaces[5].surface.points) p.z() += 1e-6;
  const MesherInput input = input_of(surfaces, {RegionRule::outer});
  ASSERT_EQ(input.bodies.size(), 1U);
  EXPECT_EQ(input.bodies[0].name, "p1");
  EXPECT_NEAR(input.bodies[0].surface.volume, 3, 1e-5);
  EXPECT_EQ(input.bodies[0].surface.closed, input.bodies[0].surface.triangles.size());
}

TEST(PatchJoining, AMissingSideIsReported) {
  const MesherInput input = input_of(cube(5));
  EXPECT_EQ(input.bodies.size(), 5U);
  EXPECT_FALSE(found(input, DiagnosticCode::surfaces_joined));
  const Diagnostic* gap = found(input, DiagnosticCode::surfaces_not_joined);
  ASSERT_TRUE(gap);
  EXPECT_EQ(gap->count, 5U);
  EXPECT_EQ(gap->places[0].z(), 1);
}

TEST(PatchJoining, BodiesWithFlatHolesStayBodies) {
  const std::vector<MaterialSurface> halves{open_box({0, 0, 0}, {1, 1, 1}, 1, "a", 1),
                                            open_box({1, 0, 0}, {2, 1, 1}, 0, "b", 2)};
  const MesherInput input = input_of(halves);
  ASSERT_EQ(input.bodies.size(), 2U);
  EXPECT_NEAR(input.bodies[1].surface.volume, 1, 1e-12);
  EXPECT_FALSE(found(input, DiagnosticCode::surfaces_joined));
  EXPECT_FALSE(found(input, DiagnosticCode::surfaces_not_joined));
}

TEST(PatchJoining, ALidClosesABox) {
  std::vector<MaterialSurface> surfaces = cube();
  surfaces = {open_box({0, 0, 0}, {1, 1, 1}, 5, "box", 1), surfaces[5]};
  surfaces[1].tag = 2;
  const MesherInput input = input_of(surfaces);
  ASSERT_EQ(input.bodies.size(), 1U);
  EXPECT_EQ(input.bodies[0].name, "box");
  EXPECT_EQ(input.groups.size(), 2U);
}

TEST(PatchJoining, ClosedBodiesStayBodies) {
  std::vector<MaterialSurface> surfaces = cube();
  surfaces.push_back({"upper", 7, make_box({0, 0, 1}, {1, 1, 2}), "upper.off"});
  const MesherInput input = input_of(surfaces);
  ASSERT_EQ(input.bodies.size(), 2U);
  EXPECT_EQ(input.bodies[1].name, "upper");
  EXPECT_EQ(input.contacts.size(), 1U);
}

}  // namespace
}  // namespace tetwright::patch_joining_test
