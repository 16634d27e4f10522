// SPDX-License-Identifier: Apache-2.0
#include "tetwright/parted_interfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "common/mesh/disjoint_sets.h"
#include "common/random.h"
#include "tests/simplify/meshes.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/sheets.h"

namespace tetwright {
namespace {

constexpr int side_cells = 4;

Vec3 centre_of(const TetMesh& mesh, const Tet& tet) {
  return (mesh.points[tet[0]] + mesh.points[tet[1]] + mesh.points[tet[2]] + mesh.points[tet[3]]) / 4;
}

/// The cube [0, 4]^3 with a material for each tet.
template <class MaterialOf>
TetMesh cube_of(const MaterialOf& material_of) {
  TetMesh mesh = grid_mesh(side_cells);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    mesh.materials[t] = material_of(centre_of(mesh, mesh.tets[t]));
  mesh.material_names = {{1, "bone"}, {2, "implant"}, {3, "a|b: c"}};
  mesh.interfaces = find_interfaces(mesh);
  return mesh;
}

TetMesh two_halves() {
  return cube_of([](const Vec3& c) { return c.z() < 2 ? 1 : 2; });
}

/// One material with a square crack, or one from side to side.
TetMesh cracked(double radius) {
  TetMesh mesh = cube_of([](const Vec3&) { return 1; });
  std::vector<InterfaceTriangle> sheet;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size())) {
    const Vec3 c = (mesh.points[f.ids[0]] + mesh.points[f.ids[1]] + mesh.points[f.ids[2]]) / 3;
    const bool flat =
        std::all_of(f.ids.begin(), f.ids.end(), [&](Index p) { return mesh.points[p].z() == 2; });
    if (flat && std::max(std::fabs(c.x() - 2), std::fabs(c.y() - 2)) < radius)
      sheet.push_back({f.ids, 1, 1, 3});
  }
  append_sheets(mesh.interfaces, std::move(sheet));
  mesh.patch_groups[{{1, 1}, 3}] = {0, "crack"};
  return mesh;
}

InterfaceToPart between(MaterialTag a, MaterialTag b, bool cohesive = false) {
  return {std::pair(a, b), {}, cohesive};
}

Triangle ascending(Triangle ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// Checks a parted mesh, point by point and tet by tet, against the mesh before.
/// \param parted whether a face is parted, by its ids in ascending order
template <class Parted>
void expect_parted(const TetMesh& before, const TetMesh& after, const Parted& parted) {
  ASSERT_EQ(before.tets.size(), after.tets.size());
  EXPECT_EQ(before.materials, after.materials);
  // The tets at each point that are connected across faces that stay.
  std::map<Index, std::vector<Index>> tets_at;
  for (Index t = 0; t < before.tets.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k) {
      tets_at[before.tets[t][k]].push_back(t);
      EXPECT_EQ(before.points[before.tets[t][k]], after.points[after.tets[t][k]]);
    }
  const std::vector<MeshFace> faces = mesh_faces(before.tets, before.points.size());
  std::size_t points = 0;
  for (const auto& [p, tets] : tets_at) {
    std::map<Index, Index> number;
    for (const Index t : tets) number.emplace(t, static_cast<Index>(number.size()));
    DisjointSets sets(tets.size());
    for (const MeshFace& f : faces)
      if (f.count == 2 && std::find(f.ids.begin(), f.ids.end(), p) != f.ids.end() && !parted(f.ids))
        sets.unite(number.at(f.first), number.at(f.second));
    std::map<Index, Index> copy_of;  // of each set
    for (const Index t : tets) {
      const auto k = static_cast<std::size_t>(std::find(before.tets[t].begin(), before.tets[t].end(), p) -
                                              before.tets[t].begin());
      const Index copy = after.tets[t][k];
      EXPECT_EQ(copy_of.try_emplace(sets.root(number.at(t)), copy).first->second, copy);
    }
    std::set<Index> copies;
    for (const auto& [set, copy] : copy_of) copies.insert(copy);
    EXPECT_EQ(copies.size(), copy_of.size());
    EXPECT_TRUE(copies.contains(p));
    points += copies.size();
  }
  EXPECT_EQ(points, after.points.size());
  // The interfaces are those of the tets, and what stayed of the sheets.
  std::vector<InterfaceTriangle> found = interfaces_with_sheets(after);
  ASSERT_EQ(found.size(), after.interfaces.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].ids, after.interfaces[i].ids);
    EXPECT_EQ(found[i].pair(), after.interfaces[i].pair());
  }
}

void expect_same(const TetMesh& a, const TetMesh& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.tets, b.tets);
  ASSERT_EQ(a.interfaces.size(), b.interfaces.size());
  for (std::size_t i = 0; i < a.interfaces.size(); ++i) {
    EXPECT_EQ(a.interfaces[i].pair(), b.interfaces[i].pair());
    EXPECT_EQ(ascending(a.interfaces[i].ids), ascending(b.interfaces[i].ids));
    const auto group = [&](const TetMesh& mesh) {
      const auto known = mesh.patch_groups.find({mesh.interfaces[i].pair(), mesh.interfaces[i].patch});
      return known == mesh.patch_groups.end() ? SurfaceRegion{} : known->second;
    };
    EXPECT_EQ(group(a), group(b));
  }
}

TEST(PartedInterfaces, SidesHaveTheirOwnPointsAndNames) {
  const TetMesh before = two_halves();
  TetMesh mesh = before;
  const auto parted = part_interfaces(mesh, nullptr, std::vector{between(1, 2)});
  ASSERT_EQ(parted.size(), 1u);
  EXPECT_EQ(parted[0].name, "bone|implant");
  EXPECT_EQ(parted[0].sides, (std::array<std::string, 2>{"bone|implant:bone", "bone|implant:implant"}));
  EXPECT_EQ(parted[0].faces, 2u * side_cells * side_cells);
  EXPECT_EQ(parted[0].pairs.size(), (side_cells + 1u) * (side_cells + 1u));
  EXPECT_EQ(parted[0].joined_faces, 0u);
  EXPECT_TRUE(mesh.wedges.empty());
  for (const auto& [a, b] : parted[0].pairs) EXPECT_EQ(mesh.points[a], mesh.points[b]);
  expect_parted(before, mesh, [&](const Triangle& ids) {
    return std::all_of(ids.begin(), ids.end(), [&](Index p) { return before.points[p].z() == 2; });
  });
  std::map<std::string, std::size_t> faces;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    const auto known = mesh.patch_groups.find({t.pair(), t.patch});
    if (known != mesh.patch_groups.end()) ++faces[known->second.name];
    EXPECT_FALSE(t.other);
  }
  EXPECT_EQ(faces,
            (std::map<std::string, std::size_t>{{"bone|implant:bone", 2u * side_cells * side_cells},
                                                {"bone|implant:implant", 2u * side_cells * side_cells}}));
}

TEST(PartedInterfaces, NothingIsPartedWithoutFaces) {
  const TetMesh before = two_halves();
  TetMesh mesh = before;
  EXPECT_TRUE(
      part_interfaces(mesh, nullptr, std::vector{between(1, 3), InterfaceToPart{{}, "crack"}}).empty());
  EXPECT_EQ(mesh.points, before.points);
  EXPECT_EQ(mesh.interfaces, before.interfaces);
}

// Three bodies around the axis x = y = 2: its points need three copies.
TEST(PartedInterfaces, JunctionsHaveACopyForEachBody) {
  const TetMesh before = cube_of([](const Vec3& c) { return c.x() < 2 ? 1 : c.y() < 2 ? 2 : 3; });
  TetMesh mesh = before;
  const std::vector<InterfaceToPart> all{between(1, 2), between(1, 3), between(2, 3)};
  EXPECT_EQ(part_interfaces(mesh, nullptr, all).size(), 3u);
  const auto copies = [&](double x, double y, double z) {
    return std::count(mesh.points.begin(), mesh.points.end(), Vec3(x, y, z));
  };
  EXPECT_EQ(copies(2, 2, 1), 3);
  EXPECT_EQ(copies(2, 3, 1), 2);
  EXPECT_EQ(copies(3, 2, 1), 2);
  EXPECT_EQ(copies(1, 2, 1), 1);
  // Two of the three: body 3 keeps both together at the axis.
  mesh = before;
  EXPECT_EQ(part_interfaces(mesh, nullptr, std::vector{between(1, 2)}).size(), 1u);
  EXPECT_EQ(copies(2, 2, 1), 1);
  EXPECT_EQ(copies(2, 1, 1), 2);
}

TEST(PartedInterfaces, TheBorderOfACrackStays) {
  const TetMesh before = cracked(1);
  TetMesh mesh = before;
  const auto parted = part_interfaces(mesh, nullptr, std::vector{InterfaceToPart{{}, "crack", true}});
  ASSERT_EQ(parted.size(), 1u);
  EXPECT_EQ(parted[0].sides, (std::array<std::string, 2>{"crack:back", "crack:front"}));
  // Only the point in the middle has no border at it; faces without it stay.
  EXPECT_EQ(parted[0].pairs.size(), 1u);
  EXPECT_EQ(mesh.points.size(), before.points.size() + 1);
  EXPECT_EQ(parted[0].faces + parted[0].joined_faces, 8u);
  EXPECT_EQ(parted[0].faces, mesh.wedges.size());
  EXPECT_EQ(parted[0].degenerate_wedges, mesh.wedges.size());
  EXPECT_EQ(parted[0].joined_places.size(), std::min<std::size_t>(3, parted[0].joined_faces));
  EXPECT_EQ(sheets_of(mesh).size(), parted[0].joined_faces);
  EXPECT_EQ(wedges_by_interface(mesh).at("crack").size(), mesh.wedges.size());
  const std::size_t joined = join_parted_interfaces(mesh).points;
  EXPECT_EQ(joined, 1u);
  expect_same(before, mesh);
}

TEST(PartedInterfaces, WedgesLeadFromTheFirstSideToTheSecond) {
  TetMesh mesh = two_halves();
  part_interfaces(mesh, nullptr, std::vector{between(1, 2, true)});
  ASSERT_EQ(mesh.wedges.size(), 2u * side_cells * side_cells);
  for (const Wedge& w : mesh.wedges) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(mesh.points[w[k]], mesh.points[w[k + 3]]);
      EXPECT_NE(w[k], w[k + 3]);
    }
    const Vec3 normal = (mesh.points[w[1]] - mesh.points[w[0]]).cross(mesh.points[w[2]] - mesh.points[w[0]]);
    EXPECT_GT(normal.z(), 0);  // from bone, below, to implant
  }
  const auto by_interface = wedges_by_interface(mesh);
  ASSERT_EQ(by_interface.size(), 1u);
  EXPECT_EQ(by_interface.at("bone|implant").size(), 2u * side_cells * side_cells);
  const JoinedInterfaces joined = join_parted_interfaces(mesh);
  ASSERT_EQ(joined.parts.size(), 1u);
  EXPECT_TRUE(joined.parts[0].cohesive);
  EXPECT_EQ(joined.parts[0].materials, std::pair(1, 2));
  EXPECT_EQ(joined.other_wedges, 0u);
  EXPECT_TRUE(mesh.wedges.empty());
}

TEST(PartedInterfaces, RandomMaterialsComeBack) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    const TetMesh before =
        cube_of([&](const Vec3&) { return 1 + static_cast<int>(random.below(seed % 2 ? 3 : 4)); });
    std::vector<InterfaceToPart> rules;
    for (MaterialTag a = 1; a <= 4; ++a)
      for (MaterialTag b = a + 1; b <= 4; ++b)
        if (random.below(3) > 0) rules.push_back(between(a, b, random.below(2) > 0));
    TetMesh mesh = before;
    const auto parted = part_interfaces(mesh, nullptr, rules);
    std::map<Triangle, MaterialPair> pairs;
    for (const InterfaceTriangle& t : before.interfaces) pairs[ascending(t.ids)] = t.pair();
    expect_parted(before, mesh, [&](const Triangle& ids) {
      const auto known = pairs.find(ids);
      return known != pairs.end() && std::any_of(rules.begin(), rules.end(), [&](const auto& rule) {
               return known->second == MaterialPair(rule.materials->first, rule.materials->second);
             });
    });
    std::size_t wedges = 0, points = 0;
    for (const PartedInterface& p : parted) wedges += p.cohesive ? p.faces : 0;
    EXPECT_EQ(wedges, mesh.wedges.size());
    points = mesh.points.size() - before.points.size();
    EXPECT_EQ(join_parted_interfaces(mesh).points, points);
    expect_same(before, mesh);
  }
}

TEST(PartedInterfaces, GroupsOfAnInterfacePartByThemselves) {
  TetMesh mesh = two_halves();
  for (InterfaceTriangle& t : mesh.interfaces)
    if (t.other && mesh.points[t.ids[0]].x() + mesh.points[t.ids[1]].x() + mesh.points[t.ids[2]].x() < 6)
      t.patch = 7;
  mesh.patch_groups[{{1, 2}, 7}] = {0, "glued:loose"};
  const TetMesh before = mesh;
  const auto parted = part_interfaces(mesh, nullptr, std::vector{InterfaceToPart{{}, "glued:loose"}});
  ASSERT_EQ(parted.size(), 1u);
  EXPECT_EQ(parted[0].sides[0], "glued:loose:bone");
  EXPECT_EQ(parted[0].faces, 1u * side_cells * side_cells);
  const JoinedInterfaces joined = join_parted_interfaces(mesh);
  ASSERT_EQ(joined.parts.size(), 1u);
  EXPECT_EQ(joined.parts[0].group, "glued:loose");
  expect_same(before, mesh);
}

// A group over several pairs of materials has a name for each.
TEST(PartedInterfaces, GroupsOfSeveralPairsHaveSeveralNames) {
  TetMesh mesh = cube_of([](const Vec3& c) { return c.z() < 2 ? 1 : c.x() < 2 ? 2 : 3; });
  for (const MaterialTag other : {2, 3}) mesh.patch_groups[{{1, other}, 0}] = {0, "floor"};
  const TetMesh before = mesh;
  const auto parted = part_interfaces(mesh, nullptr, std::vector{InterfaceToPart{{}, "floor"}});
  ASSERT_EQ(parted.size(), 2u);
  EXPECT_EQ(parted[0].sides[0], "floor bone|a|b: c:bone");
  EXPECT_EQ(parted[1].sides[1], "floor bone|implant:implant");
  EXPECT_EQ(join_parted_interfaces(mesh).parts.size(), 2u);
  EXPECT_EQ(mesh.points, before.points);
}

TEST(PartedInterfaces, OnlyNamedFacesThatCoincideAreJoined) {
  const TetMesh before = two_halves();
  TetMesh parted = before;
  part_interfaces(parted, nullptr, std::vector{between(1, 2)});
  const auto joins = [](TetMesh mesh) { return join_parted_interfaces(mesh).points; };
  EXPECT_GT(joins(parted), 0u);
  TetMesh moved = parted;
  moved.points.back().z() += 1e-9;
  EXPECT_EQ(joins(moved), 0u);
  TetMesh renamed = parted;
  for (auto& [patch, region] : renamed.patch_groups)
    if (region.name == "bone|implant:bone") region.name = "bone|implant:skin";
  EXPECT_EQ(joins(renamed), 0u);
}

TEST(PartedInterfaces, WedgesWithoutNamesAreCounted) {
  TetMesh mesh = two_halves();
  part_interfaces(mesh, nullptr, std::vector{between(1, 2, true)});
  mesh.patch_groups.clear();
  const std::size_t wedges = mesh.wedges.size();
  const JoinedInterfaces joined = join_parted_interfaces(mesh);
  EXPECT_EQ(joined.other_wedges, wedges);
  EXPECT_TRUE(mesh.wedges.empty());
  EXPECT_EQ(joined.points, 0u);
}

TEST(PartedInterfaces, FieldsAndMidsideNodesAreCopied) {
  TetMesh mesh = two_halves();
  MeshField field{"x", 2, false, {}};
  for (const Vec3& p : mesh.points) field.values.insert(field.values.end(), {p.x(), p.y()});
  mesh.point_fields = {field};
  MidsideNodes midside = straight_midside_nodes(mesh);
  for (Vec3& p : midside.points) p += Vec3(0, 0, 0.01 * p.x());  // curved
  const TetMesh before = mesh;
  const MidsideNodes nodes_before = midside;
  const auto parted = part_interfaces(mesh, &midside, std::vector{between(1, 2)});
  ASSERT_EQ(mesh.point_fields[0].values.size(), 2 * mesh.points.size());
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    EXPECT_EQ(mesh.point_fields[0].values[2 * p], mesh.points[p].x());
    EXPECT_EQ(mesh.point_fields[0].values[2 * p + 1], mesh.points[p].y());
  }
  // Edges of the grid in the plane: two for each square and its diagonal, and those of the border.
  const std::size_t edges = 3u * side_cells * side_cells + 2 * side_cells;
  EXPECT_EQ(midside.points.size(), nodes_before.points.size() + edges);
  ASSERT_EQ(midside.of_faces.size(), mesh.interfaces.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e)
      EXPECT_EQ(midside.points[midside.of_tets[t][e]], nodes_before.points[nodes_before.of_tets[t][e]]);
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& edge = midside.edges[midside.of_faces[i][k]];
      EXPECT_EQ(edge, ascending_edge(mesh.interfaces[i].ids[k], mesh.interfaces[i].ids[(k + 1) % 3]));
    }
  const auto node = [&](Index i) -> Vec3 {
    return i < mesh.points.size() ? mesh.points[i] : midside.points[i - mesh.points.size()];
  };
  ASSERT_EQ(parted.size(), 1u);
  EXPECT_EQ(parted[0].pairs.size(), (side_cells + 1u) * (side_cells + 1u) + edges);
  for (const auto& [a, b] : parted[0].pairs) EXPECT_EQ(node(a), node(b));
  EXPECT_EQ(join_parted_interfaces(mesh).points, (side_cells + 1u) * (side_cells + 1u));
  EXPECT_EQ(mesh.point_fields[0].values, before.point_fields[0].values);
}

// A sheet in a material that is called like the side of a sheet.
TEST(PartedInterfaces, NamesOfMaterialsDoNotHideSheets) {
  TetMesh mesh = cracked(3);
  mesh.material_names = {{1, "back"}};
  const TetMesh before = mesh;
  part_interfaces(mesh, nullptr, std::vector{InterfaceToPart{{}, "crack"}});
  EXPECT_EQ(join_parted_interfaces(mesh).parts.size(), 1u);
  expect_same(before, mesh);
}

TEST(PartedInterfaces, MaterialsOfOneNameAreToldApart) {
  TetMesh mesh = two_halves();
  mesh.material_names = {{1, "bone"}, {2, "bone"}};
  const TetMesh before = mesh;
  const auto parted = part_interfaces(mesh, nullptr, std::vector{between(1, 2)});
  EXPECT_EQ(parted[0].sides, (std::array<std::string, 2>{"bone_1|bone_2:bone_1", "bone_1|bone_2:bone_2"}));
  EXPECT_EQ(join_parted_interfaces(mesh).parts.size(), 1u);
  expect_same(before, mesh);
}

// Formats that hold names of groups, but not of materials.
TEST(PartedInterfaces, SidesAreFoundWithoutNamesOfMaterials) {
  TetMesh mesh = two_halves();
  part_interfaces(mesh, nullptr, std::vector{between(1, 2)});
  mesh.material_names.clear();
  const JoinedInterfaces joined = join_parted_interfaces(mesh);
  ASSERT_EQ(joined.parts.size(), 1u);
  EXPECT_EQ(joined.parts[0].materials, std::pair(1, 2));
}

TEST(PartedInterfaces, ValuesThatDifferAreCounted) {
  TetMesh mesh = two_halves();
  mesh.point_fields = {{"x", 1, false, std::vector<double>(mesh.points.size(), 1)},
                       {"T", 1, false, std::vector<double>(mesh.points.size(), 1)}};
  part_interfaces(mesh, nullptr, std::vector{between(1, 2)});
  for (std::size_t p = mesh.points.size() - 3; p < mesh.points.size(); ++p)
    mesh.point_fields[1].values[p] = 2;
  const JoinedInterfaces joined = join_parted_interfaces(mesh);
  ASSERT_EQ(joined.lost_values.size(), 1u);
  EXPECT_EQ(joined.lost_values[0], (std::pair<std::string, std::size_t>("T", 3)));
}

TEST(PartedInterfaces, SidesThatDoNotCoincideAreNamed) {
  TetMesh mesh = two_halves();
  part_interfaces(mesh, nullptr, std::vector{between(1, 2)});
  for (InterfaceTriangle& t : mesh.interfaces) {
    const auto group = mesh.patch_groups.find({t.pair(), t.patch});
    if (group == mesh.patch_groups.end() || group->second.name != "bone|implant:bone") continue;
    t.patch = 0;  // one face leaves its group
    break;
  }
  const JoinedInterfaces joined = join_parted_interfaces(mesh);
  EXPECT_TRUE(joined.parts.empty());
  ASSERT_EQ(joined.apart.size(), 1u);
  EXPECT_EQ(joined.apart[0], (std::pair<std::string, std::size_t>("bone|implant", 1)));
}

}  // namespace
}  // namespace tetwright
