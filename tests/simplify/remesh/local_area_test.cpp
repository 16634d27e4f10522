#include "simplify/remesh/local_area.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

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
  std::vector<Index> poor(float limit) const {
    std::vector<Index> tets;
    for (Index t = 0; t < work.mesh.tet_slots(); ++t)
      if (!work.mesh.dead(t) && work.mesh.quality(t) <= limit) tets.push_back(t);
    return tets;
  }
  std::vector<ListedTet> listed(const std::vector<Index>& tets) const {
    std::vector<ListedTet> list;
    for (const Index t : tets) list.push_back({t, work.mesh.points(t)});
    return list;
  }
  Workbench work;
  BlockRunner runner;
};

std::vector<Index> numbers(const std::vector<ListedTet>& list) {
  std::vector<Index> tets;
  for (const ListedTet& t : list) tets.push_back(t.tet);
  return tets;
}

TEST(LocalArea, ListsWhatAScanFinds) {
  constexpr float limit = 0.5;
  Bench b(1);
  LocalArea area(b.work.mesh, b.runner, 1, b.listed(b.poor(limit)));
  ASSERT_GT(b.poor(limit).size(), 10u);
  for (int round = 0; round < 4; ++round) {
    const std::uint64_t before = area.operations();
    b.runner.tets_in_order(area.poor_tets(limit), [&](Workspace& ws, const ListedTet& item, int) {
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
    EXPECT_EQ(numbers(area.poor_tets(limit)), b.poor(limit));
  }
}

TEST(LocalArea, StaysWithinItsTetsAndTheirRim) {
  Bench b(2);
  std::vector<Index> tets;
  for (Index t = 0; t < 100; ++t) tets.push_back(t);
  std::set<Index> points, reach;
  for (const Index t : tets) points.insert(b.work.mesh.points(t).begin(), b.work.mesh.points(t).end());
  for (Index t = 0; t < b.work.mesh.tet_slots(); ++t) {
    const Tet& p = b.work.mesh.points(t);
    if (std::any_of(p.begin(), p.end(), [&](Index q) { return points.count(q) != 0; }))
      reach.insert(p.begin(), p.end());
  }
  ChangeJournal journal;
  LocalArea area(b.work.mesh, b.runner, journal, tets, {reach.begin(), reach.end()});
  EXPECT_EQ(area.tet_count(), 100u);
  EXPECT_EQ(area.first_points(), std::vector<Index>(points.begin(), points.end()));
  for (const Index t : area.tets_at(area.first_points(), LocalArea::Part::inner))
    for (const Index p : b.work.mesh.points(t)) EXPECT_TRUE(points.count(p));
  const std::vector<ListedTet> around = area.tets_around(b.listed(tets));
  EXPECT_GT(around.size(), tets.size());
  for (const ListedTet& t : around) {
    EXPECT_TRUE(std::any_of(t.points.begin(), t.points.end(), [&](Index p) { return points.count(p) != 0; }));
    for (const Index p : t.points) EXPECT_TRUE(reach.count(p));
  }
  for (const Index p : area.points_around(b.listed(tets))) EXPECT_TRUE(reach.count(p));
  for (const ListedTet& t : area.poor_tets(1)) EXPECT_LT(t.tet, 100u);
}

}  // namespace
}  // namespace tetwright::local_area_test
