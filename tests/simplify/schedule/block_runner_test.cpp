// Blocks of tasks that meet: what a taken lock does to an item. The other side is played by the test, so that
// nothing depends on when threads run.
#include "simplify/schedule/block_runner.h"

#include <gtest/gtest.h>

#include <atomic>

#include "common/error.h"
#include "common/parallel/parallel.h"
#include "tests/simplify/workbench.h"

namespace tetwright::block_test {
namespace {

constexpr std::size_t chunk_size = 4;

struct Block : Workbench {
  Block() : Workbench(grid_mesh(2)), runner(mesh, grid, ledger, 1, chunk_size, nullptr) {
    runner.reset_workspaces();
  }
  BlockRunner runner;
};

TEST(Block, WhatMeetsATakenLockIsTriedAgainAfterTheOthers) {
  Block b;
  const std::vector<Index> points = b.live_points();
  HeldLocks other(b.mesh.locks());
  const Index taken = points[5];
  ASSERT_TRUE(other.try_lock(taken));
  std::atomic<int> tries = 0, done = 0;
  b.runner.points(
      points,
      [&](Workspace& ws, Index p) {
        if (p == taken && ++tries == 4) other.release();
        if (!ws.points.try_lock(p)) return Outcome::lock_taken;
        ++done;
        return Outcome::done;
      },
      [] { return false; });
  EXPECT_EQ(tries, 4);
  EXPECT_EQ(static_cast<std::size_t>(done), points.size());
  const BlockRunner::Totals totals = b.runner.take_totals();
  EXPECT_EQ(totals.lock_conflicts, 3u);
  EXPECT_EQ(totals.skipped, 0u);
  EXPECT_TRUE(b.mesh.locks().all_free());
}

TEST(Block, WhatStaysLockedIsSkippedAndCounted) {
  Block b;
  const std::vector<ListedTet> tets = [&] {
    std::vector<ListedTet> list;
    for (Index t = 0; t < b.mesh.tet_slots(); ++t)
      if (b.mesh.tet(t).points[0] != no_index) list.push_back({t, b.mesh.tet(t).points});
    return list;
  }();
  HeldLocks other(b.mesh.locks());
  const Index taken = b.at(1, 1, 1);
  ASSERT_TRUE(other.try_lock(taken));
  const auto touching = static_cast<std::size_t>(
      std::count_if(tets.begin(), tets.end(), [&](const ListedTet& t) { return contains(t.points, taken); }));
  ASSERT_GT(touching, 0u);
  ASSERT_LT(touching, tets.size());
  std::atomic<std::size_t> done = 0;
  b.runner.tets(
      tets,
      [&](Workspace& ws, const ListedTet& item) {
        const Outcome o = validate(ws, item);
        done += o == Outcome::done;
        return o;
      },
      [] { return false; });
  EXPECT_EQ(done, tets.size() - touching);
  const BlockRunner::Totals totals = b.runner.take_totals();
  EXPECT_EQ(totals.skipped, touching);
  // Once, and eight times again; tasks may meet one another, too.
  EXPECT_GE(totals.lock_conflicts, 9 * touching);
  other.release();
  EXPECT_TRUE(b.mesh.locks().all_free());
}

TEST(Block, AnAttemptThatThrowsEndsTheBlockAndHoldsNoLock) {
  Block b;
  const std::vector<Index> points = b.live_points();
  for (const unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    b.runner.reset_workspaces();
    const auto run = [&] {
      b.runner.points(
          points,
          [&](Workspace& ws, Index p) {
            if (!ws.points.try_lock(p)) return Outcome::lock_taken;
            if (p == points[7]) throw InternalError("thrown by the test");
            return Outcome::done;
          },
          [] { return false; });
    };
    EXPECT_THROW(run(), InternalError);
    EXPECT_TRUE(b.mesh.locks().all_free());
  }
  b.expect_sound();
}

}  // namespace
}  // namespace tetwright::block_test
