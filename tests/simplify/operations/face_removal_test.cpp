// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/face_removal.h"
#include "simplify/operations/edge_removal.h"

#include "tests/simplify/rings.h"
#include "tests/simplify/workbench.h"

namespace tetwright::face_removal_test {
namespace {

const FlipReach all_flips{7, 5}, basic_flips{3, 1};

/// Two tets above and below a triangle, with their apices at the given heights.
TetMesh bipyramid(double height, MaterialTag below = 1) {
  TetMesh mesh;
  mesh.points = {{1, 0, 0}, {-0.5, 0.9, 0}, {-0.5, -0.9, 0}, {0, 0, height}, {0, 0, -height}};
  mesh.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  mesh.materials = {1, below};
  return mesh;
}

int inner_face(const Workbench& w, Index t) {
  for (int f = 0; f < 4; ++f)
    if (w.mesh.neighbour(t, f) != no_index) return f;
  return 0;
}

TEST(FaceRemoval, TwoToThree) {
  Workbench w(bipyramid(0.3));
  make_bad(w);
  ASSERT_EQ(w.carry_out(remove_face(*w.ws, w.rules, 0, inner_face(w, 0), basic_flips)), Outcome::done);
  EXPECT_EQ(w.mesh.live_tets(), 3u);
  EXPECT_EQ(w.ws->counts.of(Operation::flip23, Outcome::done), 1u);
  w.expect_sound();
}

TEST(FaceRemoval, IsRefusedWhereItDoesNotImprove) {
  Workbench w(bipyramid(0.9));
  EXPECT_EQ(w.carry_out(remove_face(*w.ws, w.rules, 0, inner_face(w, 0), all_flips)), Outcome::quality);
  w.expect_sound();
}

TEST(FaceRemoval, NeverCrossesAnInterfaceNorTheBoundary) {
  Workbench w(bipyramid(0.12, 2));
  make_bad(w);
  const int inner = inner_face(w, 0);
  EXPECT_EQ(w.carry_out(remove_face(*w.ws, w.rules, 0, inner, all_flips)), Outcome::material_rule);
  EXPECT_EQ(w.carry_out(remove_face(*w.ws, w.rules, 0, (inner + 1) % 4, all_flips)), Outcome::no_candidate);
  w.expect_sound();
}

// Face removal undoes edge removal: the ring of six lies between two points.
TEST(FaceRemoval, UndoesEdgeRemoval) {
  for (int n = 4; n <= 6; ++n) {
    TetMesh flat =
        ring_mesh(n, 0.25);  // a lens: tets around its short axis are good, those over its faces flat
    Workbench w(flat);
    make_bad(w);
    const Index low = w.at(0, 0, -0.25), high = w.at(0, 0, 0.25);
    const Tet p = w.mesh.points(0);
    for (int e = 0; e < 6; ++e) {
      const Index a = p[tet_edges[e][0]], b = p[tet_edges[e][1]];
      if ((a == low && b == high) || (a == high && b == low)) {
        ASSERT_EQ(w.carry_out(remove_edge(*w.ws, w.rules, 0, e, all_flips)), Outcome::done);
      }
    }
    ASSERT_EQ(w.mesh.live_tets(), static_cast<std::size_t>(2 * (n - 2)));
    w.rules.objective.kind = Objective::Kind::shape;
    for (Index t = 0; t < w.mesh.tet_slots(); ++t) {
      if (w.mesh.dead(t)) continue;
      const Tet& v = w.mesh.points(t);
      w.mesh.set_quality(t, w.rules.objective(w.mesh.position(v[0]), w.mesh.position(v[1]),
                                              w.mesh.position(v[2]), w.mesh.position(v[3])));
    }
    bool done = false;
    for (Index t = 0; t < w.mesh.tet_slots() && !done; ++t)
      for (int f = 0; f < 4 && !done && !w.mesh.dead(t); ++f) {
        done = w.carry_out(remove_face(*w.ws, w.rules, t, f, all_flips)) == Outcome::done;
      }
    EXPECT_TRUE(done) << n;
    EXPECT_EQ(w.mesh.live_tets(), static_cast<std::size_t>(n));
    EXPECT_EQ(w.ws->counts.of(Operation::face_removal, Outcome::done), 1u);
    w.expect_sound();
  }
}

}  // namespace
}  // namespace tetwright::face_removal_test
