// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/contact_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "tests/mesher/test_surfaces.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright::contact_groups_test {
namespace {

/// A box whose top (high z) and bottom are groups; an empty name is no group. Other sides have none.
MaterialSurface slab(const std::string& name, MaterialTag tag, const Vec3& low, const Vec3& high,
                     const std::string& top, const std::string& bottom) {
  TriangleMesh mesh = make_box(low, high);
  mesh.groups = {{}, {0, top}, {0, bottom}};
  for (const auto& [a, b, c] : mesh.triangles) {
    const double z = (mesh.points[a].z() + mesh.points[b].z() + mesh.points[c].z()) / 3;
    mesh.triangle_groups.push_back(z > high.z() - 1e-9 ? 1 : z < low.z() + 1e-9 ? 2 : 0);
  }
  return {name, tag, std::move(mesh), name + ".stl"};
}

std::map<std::string, double> areas_of(const MesherInput& input) {
  std::map<std::string, double> areas;
  for (const MesherInput::Group& g : input.groups) areas[g.group.name] = g.area;
  return areas;
}

std::map<std::string, double> areas_of(const TetMesh& mesh) {
  std::map<std::string, double> areas;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    const auto group = mesh.patch_groups.find({t.pair(), t.patch});
    if (group == mesh.patch_groups.end()) continue;
    const Vec3& a = mesh.points[t.ids[0]];
    areas[group->second.name] += (mesh.points[t.ids[1]] - a).cross(mesh.points[t.ids[2]] - a).norm() / 2;
  }
  return areas;
}

void expect_areas(const std::map<std::string, double>& found, const std::map<std::string, double>& expected) {
  ASSERT_EQ(found.size(), expected.size()) << testing::PrintToString(found);
  for (const auto& [name, area] : expected) {
    ASSERT_TRUE(found.contains(name)) << name;
    EXPECT_NEAR(found.at(name), area, 1e-6) << name;
  }
}

const Diagnostic* joined_note(const MesherInput& input) {
  const auto found = std::find_if(input.findings.begin(), input.findings.end(), [](const Diagnostic& d) {
    return d.code == DiagnosticCode::patches_joined;
  });
  return found == input.findings.end() ? nullptr : &*found;
}

TEST(ContactGroups, SharedFacesAreNamedAfterBothBodies) {
  // The block covers half of the plate's top, and nothing of its own bottom is left.
  const MesherInput input = make_mesher_input({slab("plate", 1, {0, 0, 0}, {2, 1, 0.5}, "top", "bottom"),
                                               slab("block", 2, {0, 0, 0.5}, {1, 1, 1}, "top", "foot")});
  const std::map<std::string, double> expected{
      {"plate:top", 1}, {"bottom", 2}, {"block:top", 1}, {"plate:top+foot", 1}};
  expect_areas(areas_of(input), expected);
  const Diagnostic* note = joined_note(input);
  ASSERT_NE(note, nullptr);
  EXPECT_EQ(note->count, 1U);
  EXPECT_NE(note->done.find("\"plate:top+foot\""), std::string::npos) << note->done;
  expect_areas(areas_of(mesh_surfaces(input, {.resolution = 20}, nullptr).mesh), expected);
}

TEST(ContactGroups, NamesFollowTheOrderOfTheBodiesAndAreUnique) {
  const MesherInput input = make_mesher_input({slab("block", 1, {0, 0, 0.5}, {1, 1, 1}, "foot+lid", "foot"),
                                               slab("plate", 2, {0, 0, 0}, {1, 1, 0.5}, "lid", "")});
  expect_areas(areas_of(input), {{"foot+lid", 1}, {"foot+lid_2", 1}});
}

TEST(ContactGroups, AnOnlyNameIsKept) {
  const MesherInput input = make_mesher_input({slab("plate", 1, {0, 0, 0}, {2, 1, 0.5}, "top", ""),
                                               slab("block", 2, {0, 0, 0.5}, {1, 1, 1}, "", "")});
  expect_areas(areas_of(input), {{"top", 2}});
  EXPECT_EQ(joined_note(input), nullptr);
  expect_areas(areas_of(mesh_surfaces(input, {.resolution = 20}, nullptr).mesh), {{"top", 2}});
}

TEST(ContactGroups, BodiesThatCrossShareNothing) {
  // The later body keeps the common volume, with the plane in which both bottoms lie.
  const MesherInput input = make_mesher_input(
      {slab("a", 1, {0, 0, 0}, {1, 1, 1}, "", "below"), slab("b", 2, {0.5, 0, 0}, {1.5, 1, 1}, "", "under")});
  expect_areas(areas_of(input), {{"below", 1}, {"under", 1}});
  EXPECT_EQ(joined_note(input), nullptr);
  expect_areas(areas_of(mesh_surfaces(input, {.resolution = 20}, nullptr).mesh),
               {{"below", 0.5}, {"under", 1}});
}

TEST(ContactGroups, PatchesWithoutFacesStayExpected) {
  // The bottom of the core lies inside the block, which carves it, so that it is lost.
  const MesherInput input =
      make_mesher_input({slab("core", 1, {0.25, 0.25, 0.5}, {0.75, 0.75, 1.5}, "lid", "foot"),
                         slab("block", 2, {0, 0, 0}, {1, 1, 1}, "top", "")});
  EXPECT_TRUE(areas_of(input).contains("foot"));
  EXPECT_EQ(joined_note(input), nullptr);
}

}  // namespace
}  // namespace tetwright::contact_groups_test
