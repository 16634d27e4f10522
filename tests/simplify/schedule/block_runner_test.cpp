// SPDX-License-Identifier: Apache-2.0

// Batches with conflicting proposals: which proposals win, which are decided again, and what a batch must not
// do. tets_in_order() runs items in the given order, so the test controls which are in one batch. Here an
// item's number is that of a point.
#include "simplify/schedule/block_runner.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "simplify/operations/collapse.h"
#include "simplify/operations/edge_removal.h"
#include "simplify/operations/face_removal.h"
#include "simplify/operations/insertion.h"
#include "simplify/operations/smoothing.h"
#include "tests/simplify/workbench.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright::block_runner_test {
namespace {

TetMesh jittered(int n, std::uint64_t seed) {
  TetMesh mesh = grid_mesh(n);
  jitter(mesh, seed);
  return mesh;
}

struct Block : Workbench {
  explicit Block(const TetMesh& input, std::size_t batch_size)
      : Workbench(input), runner(mesh, grid, ledger, 1, batch_size, nullptr) {
    rules.acceptance.worse_probability = 1;
  }
  void in_order(const std::vector<Index>& points, const BlockRunner::TetAttempt& attempt) {
    std::vector<TetSnapshot> items;
    for (Index p : points) items.push_back({p, dead_tet});
    runner.tets_in_order(items, attempt);
  }
  Outcome collapse_point(Workspace& worker, Index p) const {
    Outcome o = worker.gather(p);
    if (o == Outcome::done) o = collapse(worker, rules);
    return worker.count(Operation::collapse, o);
  }
  BlockRunner runner;
};

/// Everything that an operation may change: the contents of each slot.
struct Contents {
  std::vector<Tet> tets;
  std::vector<std::array<Index, 4>> neighbours;
  std::vector<float> qualities;
  std::vector<Vec3> positions;
  std::size_t live;
  bool operator==(const Contents&) const = default;
};

Contents contents(const EditableMesh& mesh) {
  Contents c;
  c.live = mesh.live_tets();
  for (Index t = 0; t < mesh.tet_slots(); ++t) {
    c.tets.push_back(mesh.points(t));
    if (mesh.dead(t)) continue;
    c.neighbours.push_back(
        {mesh.neighbour(t, 0), mesh.neighbour(t, 1), mesh.neighbour(t, 2), mesh.neighbour(t, 3)});
    c.qualities.push_back(mesh.quality(t));
  }
  for (Index p = 0; p < mesh.point_slots(); ++p)
    if (mesh.incident_tet(p) != no_index) c.positions.push_back(mesh.position(p));
  return c;
}

TEST(BlockRunner, WhatNeedsWhatAnEarlierOneChangesLosesAndIsDecidedAnew) {
  Block b(grid_mesh(4), 4);
  const Index first = b.at(2, 2, 2), second = b.at(3, 3, 3);  // neighbours
  std::mutex mutex;
  std::map<Index, std::vector<bool>> met;  // whether each found the other when decided
  b.in_order({first, second}, [&](Workspace& ws, const TetSnapshot& item, int stage) {
    EXPECT_EQ(stage, 0);
    const Outcome o = b.collapse_point(ws, item.tet);
    const std::lock_guard guard(mutex);
    const std::vector<Index>& link = ws.star.points;
    met[item.tet].push_back(std::find(link.begin(), link.end(), item.tet == first ? second : first) !=
                            link.end());
    return o;
  });
  EXPECT_EQ(met[first], (std::vector<bool>{true}));
  EXPECT_EQ(met[second], (std::vector<bool>{true, false}));  // finally in the mesh that the first one left
  EXPECT_EQ(b.mesh.incident_tet(first), no_index);
  EXPECT_EQ(b.mesh.incident_tet(second), no_index);
  const BlockRunner::Totals totals = b.runner.take_totals();
  EXPECT_EQ(totals.conflicts, 1u);
  EXPECT_EQ(totals.repeats, 1u);
  EXPECT_EQ(totals.batches, 2u);
  EXPECT_EQ(totals.counts.of(Operation::collapse, Outcome::done), 2u);
  EXPECT_EQ(totals.counts.of(Operation::collapse, Outcome::conflict), 1u);
  EXPECT_EQ(std::accumulate(totals.decided.begin(), totals.decided.end(), std::uint64_t{0}), 3u);
  EXPECT_EQ(b.runner.take_totals().batches, 0u);
  b.expect_sound();
}

TEST(BlockRunner, OverlappingWriteSetsWinInOneBatch) {
  Block b(grid_mesh(6), 4);
  const Index first = b.at(2, 3, 3), second = b.at(3, 2, 3);
  std::map<Index, Index> onto{{first, b.at(1, 3, 3)}, {second, b.at(4, 2, 3)}};
  b.in_order({first, second}, [&](Workspace& ws, const TetSnapshot& item, int) {
    Outcome o = ws.gather(item.tet);
    const auto at = std::find(ws.star.points.begin(), ws.star.points.end(), onto.at(item.tet));
    if (o == Outcome::done)
      o = collapse_onto(ws, b.rules, static_cast<std::size_t>(at - ws.star.points.begin()));
    EXPECT_EQ(o, Outcome::done);
    return ws.count(Operation::collapse, o);
  });
  const BlockRunner::Totals totals = b.runner.take_totals();
  EXPECT_EQ(totals.conflicts, 0u);
  EXPECT_EQ(totals.batches, 1u);
  EXPECT_EQ(totals.counts.of(Operation::collapse, Outcome::done), 2u);
  b.expect_sound();
}

/// Proposals for each point and tet of a mesh, by an operation that depends on its number.
std::vector<Proposal> proposals_of(Workbench& w) {
  std::vector<Proposal> out;
  Workspace& ws = *w.ws;
  const auto keep = [&](Outcome o) {
    if (o == Outcome::done) out.push_back(ws.proposal);
    ws.proposal.clear();
    return o == Outcome::done;
  };
  ws.proposal.clear();
  for (Index p : w.live_points()) {
    if (ws.gather(p) != Outcome::done) continue;
    keep(p % 3 == 0 ? collapse(ws, w.rules) : p % 3 == 1 ? smooth(ws, w.rules) : optimise(ws, w.rules));
  }
  for (Index t = 0; t < w.mesh.tet_slots(); ++t) {
    if (w.mesh.dead(t)) continue;
    for (int k = 0; k < 4; ++k)
      if (keep(t % 4 == 0   ? remove_face(ws, w.rules, t, k, full_reach)
               : t % 4 == 1 ? remove_edge(ws, w.rules, t, k, full_reach)
               : t % 4 == 2 ? insert_in_face(ws, w.rules, t, k, InsertionPlace::best)
                            : insert_in_edge(ws, w.rules, t, k, InsertionPlace::centre, true)))
        break;
  }
  return out;
}

// Threads may commit in any order.
TEST(BlockRunner, WinnersOfABatchCommitInAnyOrder) {
  std::size_t won = 0, shared = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    TetMesh mesh = grid_mesh({6, 6, 6}, [](int x, int y, int) {
      return std::optional<MaterialTag>(x < 3 ? 1 : y < 3 ? 2 : 3);
    });
    jitter(mesh, seed, 0.4);
    std::optional<Contents> first;
    for (std::uint64_t order = 0; order < 4; ++order) {
      Workbench w(mesh);
      w.rules.acceptance.worse_probability = 1;
      std::vector<Proposal> proposals = proposals_of(w);
      Random choice(seed);
      for (std::size_t i = proposals.size(); i > 1; --i)
        std::swap(proposals[i - 1], proposals[choice.below(static_cast<std::uint32_t>(i))]);
      std::vector<Proposal*> all, winners;
      for (Proposal& p : proposals) all.push_back(&p);
      w.begin_batch(all);
      std::vector<int> marked(w.mesh.point_slots(), 0);
      for (Proposal* p : all) {
        if (!w.mesh.reservations().free(p->read_set())) continue;
        if (std::any_of(winners.begin(), winners.end(),
                        [&](const Proposal* q) { return !SurfaceGrid::apart(q->edit, p->edit); }))
          continue;
        ASSERT_TRUE(w.admit(*p));
        winners.push_back(p);
        shared +=
            std::any_of(p->write_set.begin(), p->write_set.end(), [&](Index q) { return marked[q] != 0; });
        for (Index q : p->write_set) marked[q] = 1;
      }
      won += winners.size();
      Random random(order);
      if (order == 1) std::reverse(winners.begin(), winners.end());
      if (order > 1)
        for (std::size_t i = winners.size(); i > 1; --i)
          std::swap(winners[i - 1], winners[random.below(static_cast<std::uint32_t>(i))]);
      for (const Proposal* p : winners) commit(w.mesh, w.grid, *p, w.commit_workspace);
      w.end_batch();
      w.expect_sound();
      const Contents now = contents(w.mesh);
      if (first) {
        EXPECT_TRUE(now == *first) << "seed " << seed << ", order " << order;
      } else {
        first = now;
      }
    }
  }
  EXPECT_GT(won, 400u);
  EXPECT_GT(shared, 100u);
}

TEST(BlockRunner, AnAttemptThatThrowsLeavesTheMeshAsItWas) {
  for (const unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    Block b(jittered(4, 2), 1000);
    const std::vector<Index> points = b.live_points();
    const Contents before = contents(b.mesh);
    const auto run = [&](Index bad) {
      b.in_order(points, [&](Workspace& ws, const TetSnapshot& item, int) {
        if (item.tet == bad) throw InternalError("thrown by the test");
        return b.collapse_point(ws, item.tet);
      });
    };
    EXPECT_THROW(run(points[70]), InternalError);
    EXPECT_TRUE(contents(b.mesh) == before);
    b.expect_sound();
    run(no_index);  // and the runner can be used again
    EXPECT_LT(b.mesh.live_tets(), before.live / 2);
    b.expect_sound();
  }
}

TEST(BlockRunner, StopEndsABlockAtAnExactCount) {
  Block b(grid_mesh(4), 1000);
  make_bad(b);
  const std::size_t wanted = b.mesh.live_tets() + 3 * 7;
  std::vector<TetSnapshot> tets;
  for (Index t = 0; t < b.mesh.tet_slots(); ++t)
    if (!b.mesh.dead(t)) tets.push_back({t, b.mesh.points(t)});
  b.runner.tets(
      tets,
      [&](Workspace& ws, const TetSnapshot& item, int) {
        return exists(b.mesh, item) ? insert_in_tet(ws, b.rules, item.tet, InsertionPlace::centre)
                                    : Outcome::stale;
      },
      [&] { return b.mesh.live_tets() >= wanted; });
  EXPECT_EQ(b.mesh.live_tets(), wanted);
  EXPECT_EQ(b.runner.take_totals().counts.of(Operation::insert_in_tet, Outcome::done), 7u);
  b.expect_sound();
}

TEST(BlockRunner, BoundsHoldForABatchAsAWhole) {
  Block b(jittered(4, 3), 1000);
  b.rules.count.min = b.mesh.live_tets() - 20;  // each alone would be allowed
  b.in_order(b.live_points(),
             [&](Workspace& ws, const TetSnapshot& item, int) { return b.collapse_point(ws, item.tet); });
  EXPECT_GE(b.mesh.live_tets(), b.rules.count.min);
  EXPECT_GT(b.runner.take_totals().counts.of(Operation::collapse, Outcome::count), 0u);
  b.expect_sound();

  // Distant points that do not move but report a loss of a third of the allowed volume.
  Block v(grid_mesh(6), 1000);
  v.ledger.open(v.mesh, 0.1);
  const double third = v.mesh.total_volume() * 0.1 / 3.1;
  std::vector<Index> points;
  for (double x : {0, 3, 6})
    for (double y : {0, 3, 6}) points.push_back(v.at(x, y, 3));
  v.in_order(points, [&](Workspace& ws, const TetSnapshot& item, int) {
    EXPECT_EQ(ws.gather(item.tet), Outcome::done);
    ws.proposal.change = Proposal::Change::move;
    ws.proposal.centre = item.tet;
    ws.proposal.position = ws.star.centre_position;
    ws.proposal.claim_star(ws.star);
    ws.proposal.volumes = {{0, third}};
    return ws.count(Operation::smooth, ws.within_bounds(v.rules, 0));
  });
  const OperationCounts counts = v.runner.take_totals().counts;
  EXPECT_EQ(counts.of(Operation::smooth, Outcome::done), 3u);
  EXPECT_EQ(counts.of(Operation::smooth, Outcome::volume), 6u);
  EXPECT_NEAR(v.ledger.utilization(), 3 / 3.1, 1e-9);
  v.expect_sound();
}

TEST(BlockRunner, ATurnGoesOnWithTheNextStage) {
  Block b(jittered(4, 4), 4);
  b.rules.acceptance.good_enough = 0;
  const std::vector<Index> points = b.live_points();
  std::mutex mutex;
  std::map<Index, std::vector<int>> stages;
  b.in_order(points, [&](Workspace& ws, const TetSnapshot& item, int stage) {
    {
      const std::lock_guard guard(mutex);
      stages[item.tet].push_back(stage);
    }
    Outcome o = ws.gather(item.tet);
    if (o == Outcome::done) o = smooth(ws, b.rules);
    if (o == Outcome::done && stage < 2) ws.proposal.next_stage = stage + 1;
    return ws.count(Operation::smooth, o);
  });
  std::size_t to_the_end = 0, again = 0;
  for (const auto& [p, seen] : stages) {
    EXPECT_EQ(seen.front(), 0);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    for (std::size_t i = 1; i < seen.size(); ++i) {
      EXPECT_LE(seen[i], seen[i - 1] + 1);
      again += seen[i] == seen[i - 1];  // it had lost before
    }
    to_the_end += seen.back() == 2;
  }
  EXPECT_EQ(stages.size(), points.size());
  EXPECT_GT(to_the_end, 5u);
  EXPECT_GT(again, 0u);
  EXPECT_EQ(b.runner.take_totals().conflicts, again);
  b.expect_sound();
}

// The first item waits until another worker decides one as well. Other tests of threads would pass with a
// single worker.
TEST(BlockRunner, WorkersDecideSideBySide) {
  const ThreadLimit four(4);
  // oneTBB does not guarantee a second thread in any single loop, even if threads are free.
  constexpr int max_loops = 30;
  std::int64_t workers = 0;
  for (int loop = 0; loop < max_loops && workers < 2; ++loop) {
    Block b(grid_mesh(4), 64);
    std::mutex mutex;
    std::condition_variable another;
    std::set<const Workspace*> seen;
    bool waited = false;
    b.in_order(b.live_points(), [&](Workspace& ws, const TetSnapshot&, int) {
      std::unique_lock lock(mutex);
      seen.insert(&ws);
      another.notify_all();
      if (!std::exchange(waited, true))
        another.wait_for(lock, std::chrono::seconds(2), [&] { return seen.size() > 1; });
      return Outcome::no_candidate;
    });
    const std::vector<std::uint64_t> decided = b.runner.take_totals().decided;
    EXPECT_EQ(decided.size(), 4u);
    workers = std::count_if(decided.begin(), decided.end(), [](std::uint64_t n) { return n > 0; });
  }
  EXPECT_GT(workers, 1);
}

TEST(BlockRunner, EveryItemOfAShuffledBlockIsDecided) {
  for (const std::size_t batch_size : {0u, 1u, 7u, 1000u}) {
    Block b(grid_mesh(6), batch_size);
    const std::vector<Index> points = b.live_points();
    std::mutex mutex;
    std::map<Index, int> decided;
    b.runner.points(
        points,
        [&](Workspace&, Index p) {
          const std::lock_guard guard(mutex);
          ++decided[p];
          return Outcome::no_candidate;
        },
        [] { return false; });
    EXPECT_EQ(decided.size(), points.size());
    for (const auto& [p, n] : decided) EXPECT_EQ(n, 1);
  }
}

}  // namespace
}  // namespace tetwright::block_runner_test
