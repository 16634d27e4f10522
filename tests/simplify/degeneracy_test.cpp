// SPDX-License-Identifier: Apache-2.0

// The degenerate situations of section 5 of the paper and further ones, each simplified as far as possible
// and improved aggressively. No part may be lost or torn.
#include <gtest/gtest.h>

#include "tests/simplify/meshes.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/simplify.h"

namespace tetwright::degeneracy_test {
namespace {

using Tag = std::optional<MaterialTag>;

struct Case {
  const char* name;
  std::array<int, 3> size;
  Tag (*material)(int, int, int);
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const Case cases[] = {
    // A layer one cell (and one tet) thick, between two others and as a skin.
    {"single_tet_thick_layer", {8, 8, 5}, [](int, int, int z) { return Tag(z < 2    ? 1
                                                                           : z == 2 ? 2
                                                                                    : 3); }},
    {"skin",
     {7, 7, 7},
     [](int x, int y, int z) {
       const bool inner = std::min({x, y, z}) >= 1 && std::max({x, y, z}) <= 5;
       return Tag(inner ? 1 : 2);
     }},
    {"free_sheet", {9, 9, 1}, [](int, int, int) { return Tag(1); }},
    // Two blocks joined by a bar of one cell, in the open and between two bodies of another material.
    {"one_tet_bridge",
     {9, 4, 4},
     [](int x, int y, int z) { return x < 4 || x > 4 || (y == 1 && z == 1) ? Tag(1) : Tag(); }},
    {"bridge_through_another_material",
     {9, 4, 4},
     [](int x, int y, int z) { return Tag(x < 4 || x > 4 || (y == 1 && z == 1) ? 1 : 2); }},
    // A junction curve that closes after few edges: a column of one cell through an interface.
    {"small_junction_loop",
     {5, 5, 6},
     [](int x, int y, int z) {
       return Tag(x == 2 && y == 2 && z >= 2 && z < 4 ? 3 : z < 3 ? 1 : 2);
     }},
    {"three_columns_meet", {6, 6, 4}, [](int x, int y, int) { return Tag(x < 3   ? 1
                                                                         : y < 3 ? 2
                                                                                 : 3); }},
    {"four_materials_in_a_corner",
     {4, 4, 4},
     [](int x, int y, int z) {
       return Tag(z < 2 ? 1 : x < 2 ? 2 : y < 2 ? 3 : 4);
     }},
    // A cavity of one cell, empty and filled.
    {"cavity", {5, 5, 5}, [](int x, int y, int z) { return x == 2 && y == 2 && z == 2 ? Tag() : Tag(1); }},
    {"inclusion", {5, 5, 5}, [](int x, int y, int z) { return Tag(x == 2 && y == 2 && z == 2 ? 2 : 1); }},
    {"ring",
     {7, 7, 2},
     [](int x, int y, int) { return x >= 3 && x < 4 && y >= 3 && y < 4 ? Tag() : Tag(1); }},
    // Parts that touch along an edge or at a point.
    {"touching_in_an_edge", {4, 4, 3}, [](int x, int y, int) { return (x < 2) == (y < 2) ? Tag(1) : Tag(); }},
    // Parts that touch along an edge with both ends inside a slab: no point is split, only the edge is
    // nonmanifold.
    {"wedges_between_slabs",
     {4, 4, 3},
     [](int x, int y, int z) { return z != 1 || (x < 2) == (y < 2) ? Tag(1) : Tag(); }},
    {"touching_in_a_point",
     {4, 4, 4},
     [](int x, int y, int z) {
       const bool low = x < 2 && y < 2 && z < 2, high = x >= 2 && y >= 2 && z >= 2;
       return low || high ? Tag(1) : Tag();
     }},
    {"materials_touching_in_a_point",
     {4, 4, 4},
     [](int x, int y, int z) {
       const bool low = x < 2 && y < 2 && z < 2, high = x >= 2 && y >= 2 && z >= 2;
       return Tag(low || high ? 2 : 1);
     }},
};

/// Number of findings of each kind.
std::map<DiagnosticCode, std::size_t> counts(const TetMesh& mesh) {
  std::map<DiagnosticCode, std::size_t> out;
  for (const MeshFinding& f : check_mesh(mesh)) out[f.code] = f.count;
  return out;
}

class Degeneracy : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Cases, Degeneracy, testing::ValuesIn(cases),
                         [](const auto& c) { return c.param.name; });

TEST_P(Degeneracy, SurvivesTheTunedSchedule) {
  TetMesh mesh = grid_mesh(GetParam().size, GetParam().material);
  jitter(mesh, 31, 0.2);
  const auto before = counts(mesh);
  SimplifyOptions options;
  options.target_tets = 1;
  const TetMesh after = simplify(mesh, options);
  EXPECT_EQ(counts(after), before);
  for (const std::string& d : topology_differences(topology(mesh), topology(after))) ADD_FAILURE() << d;
  EXPECT_LT(after.tets.size(), mesh.tets.size());
}

TEST_P(Degeneracy, SurvivesThePapersSchedule) {
  TetMesh mesh = grid_mesh(GetParam().size, GetParam().material);
  jitter(mesh, 32, 0.2);
  SimplifyOptions options;
  options.target_tets = 1;
  options.schedule = Schedule::paper;
  const TetMesh after = simplify(mesh, options);
  EXPECT_EQ(counts(after), counts(mesh));
  for (const std::string& d : topology_differences(topology(mesh), topology(after))) ADD_FAILURE() << d;
}

TEST_P(Degeneracy, SurvivesImprovement) {
  TetMesh mesh = grid_mesh(GetParam().size, GetParam().material);
  jitter(mesh, 33, 0.5);
  const TetMesh after = improve(mesh, ImproveOptions());
  EXPECT_EQ(counts(after), counts(mesh));
  for (const std::string& d : topology_differences(topology(mesh), topology(after))) ADD_FAILURE() << d;
}

// The smallest meshes: nothing can be collapsed.
TEST(Degeneracy, SingleTetsAndPairs) {
  TetMesh one;
  one.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  one.tets = {{0, 1, 2, 3}};
  one.materials = {1};
  SimplifyOptions options;
  options.target_tets = 1;
  EXPECT_EQ(simplify(one, options).tets.size(), 1u);
  TetMesh pair = one;  // half of the volume must not vanish
  pair.points.emplace_back(1, 1, 1);
  pair.tets.push_back({1, 2, 3, 4});
  pair.materials.push_back(1);
  const TetMesh after = simplify(pair, options);  // two tets, or three around the long diagonal
  EXPECT_EQ(after.points.size(), 5u);
  EXPECT_LE(after.tets.size(), 2u);
  EXPECT_TRUE(check_mesh(after).empty());
  pair.materials[1] = 2;
  EXPECT_EQ(simplify(pair, options).tets.size(), 2u);
}

}  // namespace
}  // namespace tetwright::degeneracy_test
