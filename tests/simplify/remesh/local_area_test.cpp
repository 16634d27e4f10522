// SPDX-License-Identifier: Apache-2.0
#include "simplify/remesh/local_area.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "simplify/operations/collapse.h"
#include "simplify/operations/insertion.h"
#include "simplify/operations/smoothing.h"
#include "tests/simplify/workbench.h"

namespace tetwright::local_area_test {
namespace {

struct Bench {
  explicit Bench(std::uint64_t seed)
      : work(crooked(seed)), runner(work.mesh, work.grid, work.ledger, 1, 0, nullptr) {
    work.rules.objective.kind = Objective::Kind::shape;
    for (Index t = 0; t < work.mesh.tet_slots(); ++t)
      if (!work.mesh.dead(t))
        work.mesh.set_quality(t, quality_of(work.mesh, work.rules, work.mesh.points(t)));
  }
  static TetMesh crooked(std::uint64_t seed) {
    TetMesh mesh = grid_mesh(6);
    jitter(mesh, seed, 0.5);
    return mesh;
  }
  std::vector<Index> bad(float limit) const {
    std::vector<Index> tets;
    for (Index t = 0; t < work.mesh.tet_slots(); ++t)
      if (!work.mesh.dead(t) && work.mesh.quality(t) <= limit) tets.push_back(t);
    return tets;
  }
  std::vector<TetSnapshot> listed(const std::vector<Index>& tets) const {
    std::vector<TetSnapshot> list;
    for (const Index t : tets) list.push_back({t, work.mesh.points(t)});
    return list;
  }
  Workbench work;
  BlockRunner runner;
};

std::vector<Index> numbers(const std::vector<TetSnapshot>& list) {
  std::vector<Index> tets;
  for (const TetSnapshot& t : list) tets.push_back(t.tet);
  return tets;
}

TEST(LocalArea, ListsWhatAScanFinds) {
  constexpr float limit = 0.5;
  Bench b(1);
  ChangeJournal journal;
  const std::vector<Index> all = b.bad(1);
  LocalArea area(b.work.mesh, b.runner, journal, all, all);
  ASSERT_GT(b.bad(limit).size(), 10u);
  for (int round = 0; round < 4; ++round) {
    const std::uint64_t before = area.operations();
    b.runner.tets_in_order(area.bad_tets(limit), [&](Workspace& ws, const TetSnapshot& item, int) {
      if (!exists(ws.mesh, item)) return Outcome::stale;
      for (const Index p : item.points) {
        Outcome o = ws.gather(p);
        if (o == Outcome::done) o = optimise(ws, b.work.rules);
        if (ws.count(Operation::optimise, o) == Outcome::done) return o;
      }
      return Outcome::no_candidate;
    });
    if (round == 0) {
      EXPECT_GT(area.operations(), before);
    }
    EXPECT_EQ(numbers(area.bad_tets(limit)), b.bad(limit));
    EXPECT_EQ(area.bad_points(limit), Neighbourhood().points_of(b.work.mesh, b.bad(limit)));
  }
}

/// Some tets of a bench, and the tets that share points with them.
struct Part {
  Part(const EditableMesh& mesh, Index count) {
    Neighbourhood near;
    for (Index t = 0; t < count; ++t) tets.push_back(t);
    points = near.points_of(mesh, tets);
    with_rim = near.tets_at(mesh, points);
    reach = near.points_of(mesh, with_rim);
  }
  std::vector<Index> tets, points, with_rim, reach;
};

bool has(const std::vector<Index>& list, Index i) { return std::binary_search(list.begin(), list.end(), i); }

TEST(LocalArea, ListsItsTetsAndTheirRim) {
  Bench b(2);
  const EditableMesh& mesh = b.work.mesh;
  const Part part(mesh, 100);
  ChangeJournal journal;
  LocalArea area(mesh, b.runner, journal, part.tets, part.with_rim);
  EXPECT_EQ(area.tet_count(), part.with_rim.size());
  EXPECT_EQ(area.first_points(), part.points);
  EXPECT_EQ(area.tets_at(part.points, LocalArea::Part::with_rim), part.with_rim);
  const std::vector<Index> inner = area.tets_at(part.points, LocalArea::Part::inner);
  EXPECT_GE(inner.size(), part.tets.size());
  EXPECT_LT(inner.size(), part.with_rim.size());
  EXPECT_TRUE(std::includes(inner.begin(), inner.end(), part.tets.begin(), part.tets.end()));
  for (const Index t : inner)
    for (const Index p : mesh.points(t)) EXPECT_TRUE(has(part.points, p));
  EXPECT_EQ(numbers(area.tets_around(b.listed(part.tets))), part.with_rim);
  EXPECT_EQ(area.points_around(b.listed(part.tets)), part.reach);
  EXPECT_EQ(numbers(area.bad_tets(1)), part.tets);  // tets of the rim only after a change
}

TEST(LocalArea, NoWorkBeyondTheRimWhateverHappensInIt) {
  Bench b(3);
  EditableMesh& mesh = b.work.mesh;
  BlockRules& rules = b.work.rules;
  rules.good_enough = 0;
  const Part part(mesh, 150);
  std::vector<std::pair<Index, Vec3>> beyond;
  for (const Index p : b.work.live_points())
    if (!has(part.reach, p)) beyond.push_back({p, mesh.position(p)});
  ASSERT_GT(beyond.size(), 20u);
  ChangeJournal journal;
  LocalArea area(mesh, b.runner, journal, part.tets, part.with_rim);
  std::size_t rim_tets = 0, gone = 0, came = 0;
  for (int round = 0; round < 12; ++round) {
    const std::vector<TetSnapshot> listed = area.bad_tets(1);
    for (const TetSnapshot& t : listed) {
      bool inner = true;
      for (const Index p : t.points) {
        EXPECT_TRUE(std::none_of(beyond.begin(), beyond.end(), [&](const auto& x) { return x.first == p; }));
        inner &= has(part.points, p);
      }
      rim_tets += !inner;
    }
    const std::size_t live = b.work.live_points().size();
    if (round % 2 == 0) {  // points are inserted in edges of all listed tets, and later removed
      b.runner.tets_in_order(listed, [&](Workspace& ws, const TetSnapshot& item, int) {
        if (!exists(ws.mesh, item)) return Outcome::stale;
        return insert_in_edge(ws, rules, item.tet, round / 2 % 6, InsertionPlace::centre, true);
      });
      came += b.work.live_points().size() - live;
    } else {
      b.runner.each_star(area.points_around(listed), Operation::collapse,
                         [&](Workspace& ws) { return collapse(ws, rules); });
      gone += live - b.work.live_points().size();
    }
    for (const auto& [p, position] : beyond) {
      ASSERT_NE(mesh.incident_tet(p), no_index);
      EXPECT_EQ(mesh.position(p), position);
    }
  }
  EXPECT_GT(rim_tets, 100u);
  EXPECT_GT(came, 50u);
  EXPECT_GT(gone, 50u);
}

}  // namespace
}  // namespace tetwright::local_area_test
