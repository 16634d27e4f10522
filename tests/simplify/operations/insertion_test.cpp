// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/insertion.h"

#include "tests/simplify/rings.h"
#include "tests/simplify/workbench.h"

namespace tetwright::insertion_test {
namespace {

using Tag = std::optional<MaterialTag>;

class Insertion : public testing::TestWithParam<InsertionPlace> {};
INSTANTIATE_TEST_SUITE_P(Places, Insertion, testing::Values(InsertionPlace::centre, InsertionPlace::best));

TEST_P(Insertion, InATetMakesFour) {
  Workbench w(grid_mesh(2));
  make_bad(w);
  ASSERT_EQ(w.carry_out(insert_in_tet(*w.ws, w.rules, 5, GetParam())), Outcome::done);
  if (GetParam() == InsertionPlace::centre) {
    EXPECT_EQ(w.mesh.live_tets(), 48u + 3u);
  }
  w.expect_sound();
}

TEST_P(Insertion, InEveryFaceOfTheBoundaryAndTheInterface) {
  const auto halves = [](int x, int, int) { return Tag(x < 1 ? 1 : 2); };
  const TetMesh mesh = grid_mesh({2, 2, 2}, halves);
  int boundary = 0, interface = 0;
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (int f = 0; f < 4; ++f) {
      Workbench w(mesh);
      make_bad(w);
      const bool inner = w.mesh.region_across(t, f) == w.mesh.region(t);
      const bool outside = w.mesh.neighbour(t, f) == no_index;
      const double volume = w.mesh.total_volume();
      const Outcome o = w.carry_out(insert_in_face(*w.ws, w.rules, t, f, GetParam()));
      if (inner) {
        EXPECT_EQ(o, Outcome::no_candidate);
        continue;
      }
      ASSERT_EQ(o, Outcome::done);
      if (GetParam() == InsertionPlace::centre) {
        EXPECT_EQ(w.mesh.live_tets(), 48u + (outside ? 2u : 4u));
      }
      EXPECT_NEAR(w.mesh.total_volume(), volume, 1e-12);
      (outside ? boundary : interface) += 1;
      w.expect_sound();
    }
  EXPECT_EQ(boundary, 48);
  EXPECT_EQ(interface, 16);
}

TEST_P(Insertion, InEdgesOfEveryDimension) {
  const TetMesh mesh = grid_mesh({2, 2, 2}, [](int x, int, int) { return Tag(x < 1 ? 1 : 2); });
  std::array<int, 4> done{};
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (int e = 0; e < 6; ++e) {
      Workbench w(mesh);
      make_bad(w);
      ASSERT_EQ(w.ws->ring.gather(w.mesh, t, e), Outcome::done);
      const int dimension = w.ws->ring.dimension();
      const std::size_t around = w.ws->ring.tets.size();
      if (dimension == 3) {
        EXPECT_EQ(w.carry_out(insert_in_edge(*w.ws, w.rules, t, e, GetParam(), false)),
                  Outcome::no_candidate);
      }
      ASSERT_EQ(w.carry_out(insert_in_edge(*w.ws, w.rules, t, e, GetParam(), true)), Outcome::done);
      if (GetParam() == InsertionPlace::centre) {
        EXPECT_EQ(w.mesh.live_tets(), 48u + around);
      }
      ++done[dimension];
      w.expect_sound();
    }
  EXPECT_GT(done[1], 0);
  EXPECT_GT(done[2], 0);
  EXPECT_GT(done[3], 0);
}

// In a good mesh an additional point is no improvement.
TEST(InsertionJudges, ByTheOutcome) {
  Workbench w(grid_mesh(2));
  w.rules.objective.kind = Objective::Kind::shape;
  for (Index t = 0; t < 48; ++t) {
    const Tet& v = w.mesh.points(t);
    w.mesh.set_quality(t, w.rules.objective(w.mesh.position(v[0]), w.mesh.position(v[1]),
                                            w.mesh.position(v[2]), w.mesh.position(v[3])));
  }
  EXPECT_EQ(w.carry_out(insert_in_tet(*w.ws, w.rules, 0, InsertionPlace::centre)), Outcome::quality);
  w.expect_sound();
}

// Four tets around the centre of a bad one are worse still; together with the tets around it they may be
// better.
TEST(InsertionJudges, TakesTheTetsAroundABadOneToo) {
  std::size_t done = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    TetMesh mesh = grid_mesh(6);
    jitter(mesh, seed, 0.48);
    Workbench w(mesh);
    w.rules.objective.kind = Objective::Kind::shape;
    std::vector<std::pair<float, Index>> worst;
    for (Index t = 0; t < mesh.tets.size(); ++t) {
      const Tet& v = w.mesh.points(t);
      w.mesh.set_quality(t, w.rules.objective(w.mesh.position(v[0]), w.mesh.position(v[1]),
                                              w.mesh.position(v[2]), w.mesh.position(v[3])));
      worst.emplace_back(w.mesh.quality(t), t);
    }
    std::sort(worst.begin(), worst.end());
    worst.resize(20);
    for (const auto& [before, t] : worst) {
      if (w.mesh.dead(t) || w.mesh.quality(t) != before || before == 0) continue;
      EXPECT_EQ(w.carry_out(insert_in_tet(*w.ws, w.rules, t, InsertionPlace::centre)), Outcome::quality);
      if (w.carry_out(insert_in_tet(*w.ws, w.rules, t, InsertionPlace::best)) == Outcome::done) {
        ++done;
        EXPECT_GT(w.last.removed.size(), 1u);
        EXPECT_GT(w.star(w.last.new_point_id).worst, before);
      }
      w.expect_sound();
    }
  }
  EXPECT_GT(done, 2u);
}

TEST(InsertionLimits, CountAndRoom) {
  Workbench w(grid_mesh(2));
  make_bad(w);
  w.rules.count.max = 48;
  EXPECT_EQ(w.carry_out(insert_in_tet(*w.ws, w.rules, 5, InsertionPlace::centre)), Outcome::count);
  w.expect_sound();
  // Without free slots an insertion adds some.
  Workbench tight(grid_mesh(2));
  tight.mesh.compact(0, 0);
  tight.grid.build(tight.mesh);
  make_bad(tight);
  EXPECT_EQ(tight.mesh.free_tets().available(), 0u);
  for (Index t = 0; t < 10; ++t) {
    tight.mesh.set_quality(t, 0);
    EXPECT_EQ(tight.carry_out(insert_in_tet(*tight.ws, tight.rules, t, InsertionPlace::centre)),
              Outcome::done);
  }
  EXPECT_EQ(tight.mesh.live_tets(), 48u + 30u);
  tight.expect_sound();
}

}  // namespace
}  // namespace tetwright::insertion_test
