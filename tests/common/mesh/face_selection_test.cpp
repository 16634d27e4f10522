// SPDX-License-Identifier: Apache-2.0
#include "tetwright/face_selection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "tests/simplify/meshes.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {
namespace {

constexpr int cube_edge = 4;

/// The cube [0, 4]^3 whose six sides are patches, the side z = 0 the group "floor"; material 2 above z = 2.
TetMesh cube_with_sides() {
  TetMesh mesh = grid_mesh(cube_edge);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double z = 0;
    for (const Index p : mesh.tets[t]) z += mesh.points[p].z() / 4;
    mesh.materials[t] = z < 2 ? 1 : 2;
  }
  mesh.interfaces = find_interfaces(mesh);
  for (InterfaceTriangle& t : mesh.interfaces) {
    if (t.other) continue;
    for (int axis = 0; axis < 3; ++axis)
      for (const int at : {0, cube_edge})
        if (std::all_of(t.ids.begin(), t.ids.end(), [&](Index p) { return mesh.points[p][axis] == at; }))
          t.patch = static_cast<std::uint16_t>(1 + 2 * axis + (at > 0));
  }
  mesh.patch_groups[{{1, std::nullopt}, 5}] = {3, "floor"};
  return mesh;
}

/// Boundary faces whose corners all fulfil a condition.
std::set<Triangle> faces_where(const TetMesh& mesh, const std::function<bool(const Vec3&)>& holds) {
  std::set<Triangle> faces;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (!t.other && std::all_of(t.ids.begin(), t.ids.end(), [&](Index p) { return holds(mesh.points[p]); }))
      faces.insert(t.ids);
  return faces;
}

std::set<Triangle> faces_in_group(const TetMesh& mesh, const std::string& name) {
  std::set<Triangle> faces;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    const auto group = mesh.patch_groups.find({t.pair(), t.patch});
    if (group != mesh.patch_groups.end() && group->second.name == name) faces.insert(t.ids);
  }
  return faces;
}

/// The faces that rules select.
std::set<Triangle> selected(const std::string& rules) {
  TetMesh mesh = cube_with_sides();
  const auto results = select_faces(mesh, {parse_face_selection("set", rules)});
  EXPECT_EQ(results.size(), 1u);
  const std::set<Triangle> faces = faces_in_group(mesh, "set");
  EXPECT_EQ(results[0].faces, faces.size());
  EXPECT_EQ(results[0].faces == 0, !results[0].nearest.empty());
  double area = 0;
  for (const Triangle& ids : faces)
    area +=
        (mesh.points[ids[1]] - mesh.points[ids[0]]).cross(mesh.points[ids[2]] - mesh.points[ids[0]]).norm() /
        2;
  EXPECT_NEAR(results[0].area, area, 1e-12);
  return faces;
}

TEST(FaceSelection, RulesSelectTheFacesWhoseCornersFulfilThem) {
  const TetMesh mesh = cube_with_sides();
  const auto expect = [&](const std::string& rules, const std::function<bool(const Vec3&)>& holds) {
    const std::set<Triangle> wanted = faces_where(mesh, holds);
    EXPECT_FALSE(wanted.empty()) << rules;
    EXPECT_EQ(selected(rules), wanted) << rules;
  };
  expect("plane:z=min", [](const Vec3& p) { return p.z() == 0; });
  expect("plane:y=max,0.5%", [](const Vec3& p) { return p.y() == 4; });
  expect("plane: x = 1 , 1.0", [](const Vec3& p) { return p.x() <= 2; });
  expect("plane:1,1,0=min,1.0", [](const Vec3& p) { return (p.x() + p.y()) / std::sqrt(2.0) <= 1; });
  expect("plane:0,0,2=8,0", [](const Vec3& p) { return p.z() == 4; });
  expect("plane:0,0,-1=min,15%", [](const Vec3& p) { return 4 - p.z() <= 0.15 * std::sqrt(48.0); });
  expect("box:0,0,0,2,2,4", [](const Vec3& p) { return p.x() <= 2 && p.y() <= 2; });
  expect("box:2,4,4,0,2,0", [](const Vec3& p) { return p.x() <= 2 && p.y() >= 2; });
  expect("sphere:0,0,0,2", [](const Vec3& p) { return p.norm() <= 2; });
  expect("cylinder:2,2,-1,2,2,1,2",
         [](const Vec3& p) { return p.z() <= 1 && std::hypot(p.x() - 2, p.y() - 2) <= 2; });
  expect("plane:z=min and box:0,0,0,2,2,2",
         [](const Vec3& p) { return p.z() == 0 && p.x() <= 2 && p.y() <= 2; });
}

TEST(FaceSelection, NormalsPointOut) {
  const TetMesh mesh = cube_with_sides();
  EXPECT_EQ(selected("normal:0,0,1,20"), faces_where(mesh, [](const Vec3& p) { return p.z() == 4; }));
  EXPECT_EQ(selected("normal:0,0,-3,0"), faces_where(mesh, [](const Vec3& p) { return p.z() == 0; }));
  EXPECT_EQ(selected("normal:1,1,1,60").size(), 3 * 2u * cube_edge * cube_edge);
  EXPECT_EQ(selected("normal:0,0,1,180").size(), 6 * 2u * cube_edge * cube_edge);
}

// The side x = 4 has two materials: a patch of each.
TEST(FaceSelection, PatchesEndAtCreasesAndMaterials) {
  const TetMesh mesh = cube_with_sides();
  EXPECT_EQ(selected("patch-at:2,2,7"), faces_where(mesh, [](const Vec3& p) { return p.z() == 4; }));
  EXPECT_EQ(selected("patch-at:4.5,1,1"),
            faces_where(mesh, [](const Vec3& p) { return p.x() == 4 && p.z() <= 2; }));
  EXPECT_EQ(selected("patch-at:4.5,1,3"),
            faces_where(mesh, [](const Vec3& p) { return p.x() == 4 && p.z() >= 2; }));
}

// The nearest face is selected however far it is, but not in silence.
TEST(FaceSelection, PointsFarFromTheirPatchAreNamed) {
  TetMesh mesh = cube_with_sides();
  const std::vector<SelectedFaces> found =
      select_faces(mesh, {parse_face_selection("far", "patch-at:2,2,7 and normal:0,0,1,5"),
                          parse_face_selection("near", "patch-at:4.05,1,1")});
  using FarPoints = std::vector<std::pair<std::string, double>>;
  EXPECT_EQ(found[0].far_points, (FarPoints{{"patch-at:2,2,7", 3.0}}));
  EXPECT_GT(found[0].faces, 0u);
  EXPECT_EQ(found[1].far_points, FarPoints());
}

// Other patches touch the point, too.
TEST(FaceSelection, APatchIsAlsoWholeAtACornerOrEdge) {
  for (const char* rule : {"patch-at:4,4,4", "patch-at:4,0,1", "patch-at:0,0,0", "patch-at:2,0,0"}) {
    const std::set<Triangle> faces = selected(rule);
    const TetMesh mesh = cube_with_sides();
    std::set<std::pair<MaterialPair, std::uint16_t>> patches;
    std::size_t in_patch = 0;
    for (const InterfaceTriangle& t : mesh.interfaces)
      if (faces.contains(t.ids)) patches.insert({t.pair(), t.patch});
    ASSERT_EQ(patches.size(), 1u) << rule;
    for (const InterfaceTriangle& t : mesh.interfaces) in_patch += patches.contains({t.pair(), t.patch});
    EXPECT_EQ(faces.size(), in_patch) << rule;
  }
}

TEST(FaceSelection, FacesWithoutAreaHaveNoNormal) {
  TetMesh mesh = cube_with_sides();
  for (Vec3& p : mesh.points)
    if (p == Vec3(1, 1, 0)) p = Vec3(0.5, 0.5, 0);  // on the diagonal of a square
  const auto result = select_faces(mesh, {parse_face_selection("down", "normal:0,0,-1,1"),
                                          parse_face_selection("large", "plane:0,0,1e200=1e200")});
  EXPECT_EQ(result[1].faces, 0u);
  double area = 0;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (faces_in_group(mesh, "down").contains(t.ids)) {
      const double twice = (mesh.points[t.ids[1]] - mesh.points[t.ids[0]])
                               .cross(mesh.points[t.ids[2]] - mesh.points[t.ids[0]])
                               .norm();
      EXPECT_GT(twice, 0);
      area += twice / 2;
    }
  EXPECT_NEAR(area, 16, 1e-12);
}

TEST(FaceSelection, AFaceIsInOneGroup) {
  TetMesh mesh = cube_with_sides();
  const auto results = select_faces(
      mesh, {parse_face_selection("corner", "sphere:0,0,0,2.9"),
             parse_face_selection("bottom", "plane:z=min"), parse_face_selection("again", "plane:z=min")});
  ASSERT_EQ(results.size(), 3u);
  const std::size_t floor = 2u * cube_edge * cube_edge;
  EXPECT_EQ(results[1].faces + results[1].in_earlier, floor);
  EXPECT_GT(results[1].in_earlier, 0u);
  EXPECT_EQ(results[2].faces, 0u);
  EXPECT_EQ(results[2].in_earlier, floor);
  EXPECT_EQ(results[2].nearest, "an earlier selection has the faces");
  ASSERT_EQ(results[1].taken.size(), 1u);
  EXPECT_EQ(results[1].taken[0], (std::pair<std::string, std::size_t>("floor", results[1].faces)));
  EXPECT_EQ(faces_in_group(mesh, "bottom").size(), results[1].faces);
  EXPECT_TRUE(faces_in_group(mesh, "floor").empty());
  for (const auto& [patch, group] : mesh.patch_groups) EXPECT_NE(group.name, "floor");
}

// Creases inside a set stay borders of patches.
TEST(FaceSelection, PatchesOfASetStayApart) {
  TetMesh mesh = cube_with_sides();
  select_faces(mesh, {parse_face_selection("both", "plane:0,1,1=min,3")});
  std::set<std::uint16_t> patches;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    const auto group = mesh.patch_groups.find({t.pair(), t.patch});
    if (group != mesh.patch_groups.end() && group->second.name == "both" && t.material == 1)
      patches.insert(t.patch);
  }
  EXPECT_EQ(patches.size(), 4u);  // y = 0, z = 0, x = 0 and x = 4
}

TEST(FaceSelection, SaysWhatIsNearest) {
  TetMesh mesh = cube_with_sides();
  const auto result = select_faces(mesh, {parse_face_selection("gap", "plane:z=5,0.5 and normal:0,0,1,10"),
                                          parse_face_selection("tilted", "plane:z=max and normal:0,1,1,15")});
  EXPECT_EQ(result[0].nearest, "the nearest face misses \"plane:z=5,0.5\" by 0.5");
  ASSERT_TRUE(result[0].nearest_place);
  EXPECT_EQ(result[0].nearest_place->z(), 4);
  EXPECT_EQ(result[1].nearest, "the nearest face misses \"normal:0,1,1,15\" by 30 degrees");
  TetMesh empty;
  EXPECT_EQ(select_faces(empty, {parse_face_selection("a", "plane:z=max")})[0].nearest,
            "the mesh has no boundary faces");
}

TEST(FaceSelection, BadRulesAreQuoted) {
  const auto expect = [](const std::string& rules, const std::string& said) {
    try {
      (void)parse_face_selection("set", rules);
      ADD_FAILURE() << rules;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  };
  expect("", "\"\" is no rule; rules are plane:z=min,0.5%, box:");
  expect("plain:z=min", "\"plain:z=min\" is no rule");
  expect("plane:z", "has no =, as in plane:z=min,0.5%");
  expect("plane:w=1", "has 1 number instead of 3");
  expect("plane:0,0,0=1", "has a normal of length 0");
  expect("plane:z=min,-1", "has a tolerance below 0");
  expect("plane:z=min,1,2", "has more than a coordinate and a tolerance");
  expect("plane:z=mid", "has \"mid\" where a number is expected");
  expect("box:1,2,3", "has 3 numbers instead of 6, as in box:0,0,0,1,1,1");
  expect("sphere:0,0,0,0", "has a radius that is not above 0");
  expect("cylinder:0,0,0,0,0,0,1", "has an axis of length 0");
  expect("normal:0,0,1,181", "has an angle that is not from 0 to 180 degrees");
  expect("normal:0,0,0,1", "has a direction of length 0");
  expect("patch-at:1,2,nan", "has \"nan\" where a number is expected");
  expect("patch-at:1,2,3 and ", "\"\" is no rule");
  EXPECT_THROW((void)parse_face_selection("", "plane:z=min"), UsageError);
  EXPECT_THROW((void)parse_face_selection("a|b", "plane:z=min"), UsageError);
  EXPECT_THROW((void)parse_face_selection("a:b", "plane:z=min"), UsageError);
}

}  // namespace
}  // namespace tetwright
