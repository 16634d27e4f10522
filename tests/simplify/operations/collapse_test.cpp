// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/collapse.h"

#include "tests/simplify/workbench.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::collapse_test {
namespace {

using Tag = std::optional<MaterialTag>;

TEST(Collapse, RemovesAnInnerPointAndItsEdgesTets) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, 1);
  Workbench w(mesh);
  w.rules.acceptance.worse_probability = 1;
  const Index p = w.at(mesh.points[62].x(), mesh.points[62].y(), mesh.points[62].z());
  w.star(p);
  ASSERT_EQ(w.carry_out(collapse(*w.ws, w.rules)), Outcome::done);
  EXPECT_LT(w.mesh.live_tets(), mesh.tets.size());
  EXPECT_EQ(w.mesh.incident_tet(p), no_index);
  w.expect_sound();
}

// Collapses repeatedly while any collapse is possible. The mesh must stay valid throughout.
void collapse_all(Workbench& w) {
  w.rules.acceptance.worse_probability = 1;
  bool any = true;
  while (any) {
    any = false;
    for (Index p : w.live_points()) {
      if (w.mesh.incident_tet(p) == no_index) continue;
      w.star(p);
      any |= w.carry_out(collapse(*w.ws, w.rules)) == Outcome::done;
    }
    w.expect_sound();
  }
}

TEST(Collapse, ABallCollapsesToVeryFewTets) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, 2);
  Workbench w(mesh);
  collapse_all(w);
  EXPECT_LT(w.mesh.live_tets(), 60u);
  EXPECT_GE(w.mesh.live_tets(), 1u);
}

/// A shape and its invariants.
struct Shape {
  const char* name;
  std::array<int, 3> size;
  Tag (*material)(int, int, int);
};
void PrintTo(const Shape& shape, std::ostream* out) { *out << shape.name; }

const Shape shapes[] = {
    {"ring",
     {6, 6, 2},
     [](int x, int y, int) { return x >= 2 && x < 4 && y >= 2 && y < 4 ? Tag() : Tag(1); }},
    {"hollow", {5, 5, 5}, [](int x, int y, int z) { return x == 2 && y == 2 && z == 2 ? Tag() : Tag(1); }},
    {"inclusion",
     {5, 5, 5},
     [](int x, int y, int z) { return x == 2 && y == 2 && z == 2 ? Tag(2) : Tag(1); }},
    {"thin_layers", {4, 4, 5}, [](int, int, int z) { return Tag(z); }},
    {"skin",
     {5, 5, 5},
     [](int x, int y, int z) { return x % 4 == 0 || y % 4 == 0 || z % 4 == 0 ? Tag(1) : Tag(2); }},
    {"four_meet_in_a_point",
     {4, 4, 4},
     [](int x, int y, int z) {
       return Tag(z < 2 ? 1 : x < 2 ? 2 : y < 2 ? 3 : 4);
     }},
    {"four_sheets_at_a_curve", {4, 4, 4}, [](int x, int y, int) { return Tag((x < 2) == (y < 2) ? 1 : 2); }},
    {"touch_in_a_point",
     {4, 4, 4},
     [](int x, int y, int z) {
       return Tag((x < 2 && y < 2 && z < 2) || (x >= 2 && y >= 2 && z >= 2) ? 1 : 2);
     }},
    {"one_cube_bridge",
     {7, 3, 3},
     [](int x, int y, int z) { return x < 3 || x > 3 || (y == 1 && z == 1) ? Tag(1) : Tag(); }},
    {"bridge_inside",
     {7, 3, 3},
     [](int x, int y, int z) { return x < 3 || x > 3 || (y == 1 && z == 1) ? Tag(1) : Tag(2); }},
    {"ring_through_ring",
     {7, 7, 3},
     [](int x, int y, int z) {
       const bool ring =
           x >= 1 && x < 6 && y >= 1 && y < 6 && z == 1 && !(x >= 2 && x < 5 && y >= 2 && y < 5);
       return Tag(ring ? 2 : 1);
     }},
};

class CollapseShapes : public testing::TestWithParam<Shape> {};

// All possible collapses, however bad the shapes, preserve the topology of every part.
TEST_P(CollapseShapes, KeepTheirTopology) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    TetMesh mesh = grid_mesh(GetParam().size, GetParam().material);
    jitter(mesh, seed);
    const Topology before = topology(mesh);
    Workbench w(mesh);
    collapse_all(w);
    const TetMesh after = std::move(w.mesh).to_mesh();
    EXPECT_LT(after.tets.size(), mesh.tets.size() / 2);
    for (const std::string& d : topology_differences(before, topology(after))) ADD_FAILURE() << d;
    for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
  }
}

INSTANTIATE_TEST_SUITE_P(All, CollapseShapes, testing::ValuesIn(shapes),
                         [](const auto& shape) { return std::string(shape.param.name); });

TEST(Collapse, ALayerOneCubeThickSurvives) {
  // The layer's tets span from one side to the other: every edge across is a spanning edge.
  TetMesh mesh = grid_mesh({4, 4, 5}, [](int, int, int z) { return Tag(z == 2 ? 2 : z < 2 ? 1 : 3); });
  jitter(mesh, 4);
  Workbench w(mesh);
  collapse_all(w);
  const TetMesh after = std::move(w.mesh).to_mesh();
  double layer = 0;
  std::vector<std::pair<MaterialTag, MaterialTag>> touching;
  for (std::size_t t = 0; t < after.tets.size(); ++t) {
    const Tet& p = after.tets[t];
    if (after.materials[t] == 2)
      layer += tet_volume(after.points[p[0]], after.points[p[1]], after.points[p[2]], after.points[p[3]]);
    for (std::size_t u = 0; u < t; ++u) {
      int common = 0;
      for (Index a : after.tets[u]) common += std::count(p.begin(), p.end(), a) > 0;
      if (common > 0) touching.push_back(std::minmax(after.materials[t], after.materials[u]));
    }
  }
  EXPECT_GT(layer, 1);
  // The layer never tears: the parts below and above it do not even share a point.
  EXPECT_EQ(std::count(touching.begin(), touching.end(), std::pair<MaterialTag, MaterialTag>(1, 3)), 0);
  EXPECT_GT(std::count(touching.begin(), touching.end(), std::pair<MaterialTag, MaterialTag>(1, 2)), 0);
}

TEST(Collapse, OntoOneTargetProposedAndCarriedOut) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, 7);
  Workbench w(mesh);
  w.rules.acceptance.worse_probability = 1;
  int allowed = 0;
  std::size_t onto = 0;
  Index last = no_index;
  for (Index p = 0; p < mesh.points.size(); ++p)
    for (std::size_t b = 0; b < w.star(p).points.size(); ++b) {
      const Outcome trial = collapse_onto(*w.ws, w.rules, b);
      EXPECT_EQ(w.mesh.live_tets(), mesh.tets.size());
      if (trial != Outcome::done) continue;
      ++allowed;
      last = p;
      onto = b;
    }
  w.expect_sound();
  ASSERT_GT(allowed, 10);
  const Index b = w.star(last).points[onto];
  EXPECT_EQ(w.carry_out(collapse_onto(*w.ws, w.rules, onto)), Outcome::done);
  EXPECT_EQ(w.mesh.incident_tet(last), no_index);
  EXPECT_NE(w.mesh.incident_tet(b), no_index);
  EXPECT_LT(w.mesh.live_tets(), mesh.tets.size());
  w.expect_sound();
}

TEST(Collapse, CornersStay) {
  Workbench w(grid_mesh({4, 4, 4}, [](int x, int y, int z) {
    return Tag(z < 2 ? 1 : x < 2 ? 2 : y < 2 ? 3 : 4);
  }));
  w.rules.acceptance.worse_probability = 1;
  w.star(w.at(2, 2, 2));
  EXPECT_EQ(collapse(*w.ws, w.rules), Outcome::material_rule);
  w.expect_sound();
}

// The apex of a tet attached at one face collapses onto any of the three other points.
TEST(Collapse, AnEarIsCutOff) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  mesh.materials = {1, 1};
  Workbench w(mesh);
  w.star(w.at(1, 1, 1));
  ASSERT_EQ(w.carry_out(collapse(*w.ws, w.rules)), Outcome::done);
  EXPECT_EQ(w.mesh.live_tets(), 1u);
  w.expect_sound();
  w.star(w.at(0, 0, 0));  // the last one stays
  EXPECT_EQ(collapse(*w.ws, w.rules), Outcome::link_condition);
  w.expect_sound();

  mesh.materials[1] = 2;
  Workbench two(mesh);
  two.star(two.at(1, 1, 1));
  EXPECT_NE(collapse(*two.ws, two.rules), Outcome::done);
  two.expect_sound();
}

TEST(Collapse, AnErrorAboveEIsRefused) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, 5);
  Workbench w(mesh);
  w.rules.acceptance.worse_probability = 1;
  w.rules.error.max = 1e-3 * w.mesh.space().scale();  // far below an edge
  w.star(0);
  EXPECT_EQ(collapse(*w.ws, w.rules), Outcome::surface_error);
  w.expect_sound();
}

}  // namespace
}  // namespace tetwright::collapse_test
