// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/refused_stars.h"

#include <gtest/gtest.h>

#include "simplify/operations/smoothing.h"
#include "simplify/schedule/improve_step.h"
#include "tests/simplify/workbench.h"

namespace tetwright::refused_stars_test {
namespace {

/// A cube with one inner point, which smoothing brings back to the middle.
const Vec3 displaced(1.3, 1.25, 1.2);
TetMesh displaced_middle() {
  TetMesh mesh = grid_mesh(2);
  for (Vec3& p : mesh.points)
    if (p == Vec3(1, 1, 1)) p = displaced;
  return mesh;
}

TetMesh jittered(int n) {
  TetMesh mesh = grid_mesh(n);
  jitter(mesh, 5);
  return mesh;
}

TEST(RefusedStars, HoldsFromTheNextBatchUntilTheStarChanges) {
  Workbench w(displaced_middle());
  RefusedStars refused(w.mesh);
  const Index p = w.at(displaced.x(), displaced.y(), displaced.z());
  refused.add(p);
  EXPECT_FALSE(refused.holds(p));  // others of this batch do not depend on the order in which it is decided
  w.mesh.begin_batch();
  EXPECT_TRUE(refused.holds(p));
  w.mesh.begin_batch();
  EXPECT_TRUE(refused.holds(p));
  w.star(p);
  ASSERT_EQ(w.carry_out(smooth(*w.ws, w.rules)), Outcome::done);
  EXPECT_FALSE(refused.holds(p));
  for (const Index q : w.star(p).points) EXPECT_GE(w.mesh.changed_in(q), w.mesh.batch());
}

TEST(RefusedStars, ForgetsAPointThatChangesInTheBatchInWhichItIsAdded) {
  Workbench w(displaced_middle());
  RefusedStars refused(w.mesh);
  const Index p = w.at(displaced.x(), displaced.y(), displaced.z());
  refused.add(p);  // while the batch is decided that carry_out() begins
  w.star(p);
  ASSERT_EQ(w.carry_out(smooth(*w.ws, w.rules)), Outcome::done);
  w.mesh.begin_batch();
  EXPECT_FALSE(refused.holds(p));
}

TEST(RefusedStars, IgnoresPointsInsertedLater) {
  Workbench w(jittered(2));
  RefusedStars refused(w.mesh);
  const auto later = static_cast<Index>(w.mesh.point_slots());
  refused.add(later);
  w.mesh.begin_batch();
  EXPECT_FALSE(refused.holds(later));
}

TEST(RefusedStars, AcceptsRefusalsThatFollowFromTheStar) {
  EXPECT_TRUE(lies_within_star(Outcome::quality));
  EXPECT_TRUE(lies_within_star(Outcome::surface_error));
  // Other surfaces, other stars and the number of tets change on their own.
  EXPECT_FALSE(lies_within_star(Outcome::self_intersection));
  EXPECT_FALSE(lies_within_star(Outcome::link_condition));
  EXPECT_FALSE(lies_within_star(Outcome::count));
  EXPECT_FALSE(lies_within_star(Outcome::stale));
}

struct Tries {
  std::uint64_t moves, removals;
  float worst;
};

/// Improves all tets of a jittered grid in one round.
Tries improve_all(bool whole_mesh, bool remember) {
  Workbench w(jittered(5));
  w.rules.objective.kind = Objective::Kind::shape;
  for (Index t = 0; t < w.mesh.tet_slots(); ++t)
    if (!w.mesh.dead(t)) w.mesh.set_quality(t, quality_of(w.mesh, w.rules, w.mesh.points(t)));
  BlockRunner runner(w.mesh, w.grid, w.ledger, 1, 0, nullptr);
  w.rules.count = {w.mesh.live_tets(), w.mesh.live_tets()};
  const BlockRules relaxed = relaxed_rules(w.rules, 1);
  ImproveRefusals refusals(w.mesh);
  std::vector<TetSnapshot> tets;
  for (Index t = 0; t < w.mesh.tet_slots(); ++t)
    if (!w.mesh.dead(t)) tets.push_back({t, w.mesh.points(t)});
  runner.tets_in_order(tets, [&](Workspace& ws, const TetSnapshot& item, int) {
    ImproveRefusals none(w.mesh);
    return improve_tet(ws, {w.rules, relaxed, {1, 0}, false, false, whole_mesh}, item,
                       remember ? refusals : none);
  });
  const OperationCounts counts = runner.take_totals().counts;
  float worst = 1;
  for (Index t = 0; t < w.mesh.tet_slots(); ++t)
    if (!w.mesh.dead(t)) worst = std::min(worst, w.mesh.quality(t));
  w.expect_sound();
  return {counts.tried(Operation::optimise), counts.tried(Operation::edge_removal), worst};
}

TEST(ImproveTet, TriesAMoveAgainOnlyIfTheStarHasChanged) {
  const Tries before = improve_all(false, false), now = improve_all(false, true);
  EXPECT_LT(4 * now.moves, 3 * before.moves);
  EXPECT_GE(now.worst, 0.9F * before.worst);
}

TEST(ImproveTet, LeavesEdgesToTheWorstTetAround) {
  const Tries before = improve_all(false, true), now = improve_all(true, true);
  EXPECT_LT(2 * now.removals, before.removals);
  EXPECT_GE(now.worst, 0.9F * before.worst);
}

}  // namespace
}  // namespace tetwright::refused_stars_test
