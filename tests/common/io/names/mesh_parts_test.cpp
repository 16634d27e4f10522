// SPDX-License-Identifier: Apache-2.0
#include "common/io/names/mesh_parts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/mesh/interfaces.h"
#include "common/samples/samples.h"
#include "common/types.h"
#include "tests/common/small_meshes.h"

namespace tetwright::mesh_parts_test {
namespace {

TetMesh two_named(const std::string& first, const std::string& second) {
  TetMesh mesh = two_tets(-7);
  mesh.material_names = {{1, first}, {-7, second}};
  mesh.interfaces = find_interfaces(mesh);
  return mesh;
}

TEST(MeshParts, NamesOfMaterialsAndPairs) {
  const MeshParts parts =
      mesh_parts(two_named("Bone, left", ""), {[](const auto& n) { return plain_name(n); }});
  ASSERT_EQ(parts.materials.size(), 2u);
  EXPECT_EQ(parts.materials[0].tag, -7);
  EXPECT_EQ(parts.materials[0].name, "material__7");
  EXPECT_EQ(parts.materials[1].name, "Bone__left");
  EXPECT_EQ(parts.materials[0].tets, (std::vector<Index>{1}));
  ASSERT_EQ(parts.surfaces.size(), 3u);
  EXPECT_EQ(parts.surfaces[0].name, "material__7_outside");
  EXPECT_EQ(parts.surfaces[1].name, "material__7_Bone__left");
  EXPECT_EQ(parts.surfaces[1].faces.size(), 1u);
  EXPECT_EQ(parts.surfaces[0].faces.size() + parts.surfaces[2].faces.size(), 6u);
}

TEST(MeshParts, NoTwoNamesAreTheSame) {
  const auto names = [](bool ignore_case) {
    const MeshParts parts = mesh_parts(two_named("bone", "Bone"), {printable_name, ignore_case});
    return std::pair(parts.materials[0].name, parts.materials[1].name);
  };
  EXPECT_EQ(names(false), std::pair(std::string("Bone"), std::string("bone")));
  EXPECT_EQ(names(true), std::pair(std::string("Bone"), std::string("bone_2")));
  // A region of the input with the name of a pair keeps its name.
  TetMesh mesh = two_named("a", "b");
  const auto free = std::find_if(mesh.interfaces.begin(), mesh.interfaces.end(),
                                 [](const auto& t) { return t.material == 1 && !t.other; });
  ASSERT_NE(free, mesh.interfaces.end());
  free->patch = 1;
  mesh.patch_groups = {{{free->pair(), 1}, {0, "a|outside"}}};
  std::vector<std::string> all;
  for (const auto& s : mesh_parts(mesh, {printable_name}).surfaces) all.push_back(s.name);
  EXPECT_EQ(all, (std::vector<std::string>{"b|outside", "b|a", "a|outside_2", "a|outside"}));
}

TEST(MeshParts, PlainNames) {
  EXPECT_EQ(plain_name("a b-c.d"), "a_b_c_d");
  EXPECT_EQ(plain_name("9th"), "n9th");
  EXPECT_EQ(plain_name(""), "n");
  EXPECT_EQ(plain_name("K\xc3\xb6rper"), "K__rper");
  EXPECT_EQ(plain_name(std::string(200, 'x')).size(), 76u);
}

TEST(MeshParts, FacesOfTetsAreThoseOfTheInterfaces) {
  TetMesh mesh = std::get<TetMesh>(make_sample("two_materials"));
  mesh.interfaces = find_interfaces(mesh);
  const std::vector<TetFace> faces = faces_of_tets(mesh);
  ASSERT_EQ(faces.size(), mesh.interfaces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Tet& tet = mesh.tets[faces[i].tet];
    EXPECT_EQ(mesh.materials[faces[i].tet], mesh.interfaces[i].material);
    Triangle ids{};
    for (std::size_t k = 0; k < 3; ++k) ids[k] = tet[tet_faces[faces[i].face][k]];
    EXPECT_TRUE(std::is_permutation(ids.begin(), ids.end(), mesh.interfaces[i].ids.begin()));
  }
}

TEST(MeshParts, NumbersAbove0) {
  EXPECT_EQ(positive_numbers(tags_of({5, -1, 0, 2, 2}), 100),
            (std::map<std::int64_t, std::int64_t>{{-1, 1}, {0, 3}, {2, 2}, {5, 5}}));
  EXPECT_EQ(positive_numbers({2147483647}, 99'999'999),
            (std::map<std::int64_t, std::int64_t>{{2147483647, 1}}));
}

TEST(MeshParts, TheInterfacesAsASurface) {
  TetMesh mesh = two_named("a", "b");
  mesh.points.insert(mesh.points.begin(), Vec3(9, 9, 9));  // without a tet
  for (Tet& tet : mesh.tets)
    for (Index& v : tet) ++v;
  mesh.interfaces = find_interfaces(mesh);
  const TriangleMesh surface = interface_surface(mesh, printable_names());
  EXPECT_EQ(surface.points, two_tets().points);
  EXPECT_EQ(surface.groups, (std::vector<SurfaceRegion>{{1, "b|outside"}, {2, "b|a"}, {3, "a|outside"}}));
  EXPECT_EQ(surface.triangle_groups, (std::vector<std::uint32_t>{0, 0, 0, 1, 2, 2, 2}));
}

}  // namespace
}  // namespace tetwright::mesh_parts_test
