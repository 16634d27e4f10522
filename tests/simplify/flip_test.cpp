#include "simplify/flip.h"

#include "tests/simplify/workbench.h"

namespace tetwright {
namespace {

/// Two tets above and below a triangle, their far points at the given heights.
TetMesh bipyramid(double height, MaterialTag below = 1) {
  TetMesh mesh;
  mesh.points = {{1, 0, 0}, {-0.5, 0.9, 0}, {-0.5, -0.9, 0}, {0, 0, height}, {0, 0, -height}};
  mesh.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  mesh.materials = {1, below};
  return mesh;
}

void hold_tet(Workbench& w, Index t) {
  for (Index p : w.mesh.tet(t).points) ASSERT_TRUE(w.task->points.try_lock(p));
}

/// The face of tet t that has a neighbour.
int inner_face(const Workbench& w, Index t) {
  for (int f = 0; f < 4; ++f)
    if (w.mesh.neighbour(t, f) != no_index) return f;
  return 0;
}

// Tall tets are poor together with a flat common face: three around the axis would be poorer; flat ones the
// other way.
TEST(Flip, TwoToThreeWhereItHelpsAndBack) {
  Workbench w(bipyramid(0.12));
  // Flat tets above and below: the flip's three share a short edge and are no better.
  w.rules.objective.kind = Objective::Kind::shape;
  for (Index t = 0; t < 2; ++t) w.mesh.set_quality(t, 0);  // as if poor: any positive tets are better
  hold_tet(w, 0);
  ASSERT_EQ(flip23(*w.task, w.rules, 0, inner_face(w, 0)), Outcome::done);
  EXPECT_EQ(w.mesh.live_tets(), 3u);
  w.expect_sound();

  for (Index t = 0; t < w.mesh.tet_slots(); ++t)
    if (!w.mesh.dead(t)) w.mesh.set_quality(t, 0);
  Outcome o = Outcome::no_candidate;
  hold_tet(w, 0);
  for (int e = 0; e < 6 && o != Outcome::done; ++e) o = flip32(*w.task, w.rules, 0, e);
  ASSERT_EQ(o, Outcome::done);
  EXPECT_EQ(w.mesh.live_tets(), 2u);
  w.expect_sound();
}

TEST(Flip, IsRefusedWhereItDoesNotImprove) {
  Workbench w(bipyramid(0.9));
  hold_tet(w, 0);
  EXPECT_EQ(flip23(*w.task, w.rules, 0, inner_face(w, 0)), Outcome::quality);
  EXPECT_EQ(w.mesh.live_tets(), 2u);
  w.expect_sound();
}

TEST(Flip, NeverCrossesAnInterface) {
  Workbench w(bipyramid(0.12, 2));
  for (Index t = 0; t < 2; ++t) w.mesh.set_quality(t, 0);
  hold_tet(w, 0);
  EXPECT_EQ(flip23(*w.task, w.rules, 0, inner_face(w, 0)), Outcome::material_rule);
  w.expect_sound();
}

TEST(Flip, ATakenFarPointIsTold) {
  Workbench w(bipyramid(0.12));
  for (Index t = 0; t < 2; ++t) w.mesh.set_quality(t, 0);
  hold_tet(w, 0);
  Index far = 0;
  while (w.task->points.holds(far)) ++far;
  ASSERT_TRUE(w.mesh.locks().try_lock(far));
  EXPECT_EQ(flip23(*w.task, w.rules, 0, inner_face(w, 0)), Outcome::lock_taken);
  w.mesh.locks().unlock(far);
  w.expect_sound();
}

// Every tet, face and edge of a jittered grid: whatever happens, the mesh stays sound.
TEST(Flip, ManyInARow) {
  TetMesh mesh = grid_mesh(3);
  jitter(mesh, 11, 0.5);
  Workbench w(mesh);
  int flips23 = 0, flips32 = 0;
  Random random(5);
  for (int i = 0; i < 3000; ++i) {
    const Index t = random.below(static_cast<std::uint32_t>(w.mesh.tet_slots()));
    if (w.mesh.dead(t)) continue;
    hold_tet(w, t);
    Outcome o;
    if (random.below(2)) {
      o = flip23(*w.task, w.rules, t, static_cast<int>(random.below(4)));
      flips23 += o == Outcome::done;
    } else {
      o = flip32(*w.task, w.rules, t, static_cast<int>(random.below(6)));
      flips32 += o == Outcome::done;
    }
    w.task->release();
    if (o == Outcome::done) {
      ASSERT_TRUE(w.mesh.links_consistent());
    }
    // As if every tet were poor, so that flips go on in both directions.
    for (Index u = 0; u < w.mesh.tet_slots(); ++u) w.mesh.set_quality(u, 0);
  }
  EXPECT_GT(flips23, 10);
  EXPECT_GT(flips32, 10);
  w.expect_sound();
  const double s = w.mesh.scale();
  EXPECT_NEAR(w.mesh.total_volume() / (s * s * s), 27, 3);
}

}  // namespace
}  // namespace tetwright
