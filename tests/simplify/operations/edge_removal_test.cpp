// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/edge_removal.h"

#include "simplify/operations/face_removal.h"
#include "tests/simplify/rings.h"
#include "tests/simplify/workbench.h"

namespace tetwright::edge_removal_test {
namespace {

const FlipReach all{7, 5}, basic{3, 1};

/// Tries to remove the edge between two points from the first tet that has it.
Outcome remove_axis(Workbench& w, Index low, Index high, const FlipReach& reach) {
  for (Index t = 0; t < w.mesh.tet_slots(); ++t) {
    if (w.mesh.dead(t)) continue;
    const Tet p = w.mesh.points(t);
    for (int e = 0; e < 6; ++e) {
      const Index a = p[tet_edges[e][0]], b = p[tet_edges[e][1]];
      if (!((a == low && b == high) || (a == high && b == low))) continue;
      return w.carry_out(remove_edge(*w.ws, w.rules, t, e, reach));
    }
  }
  ADD_FAILURE() << "no such edge";
  return Outcome::no_candidate;
}

// n tets around an interior edge become 2 (n - 2); the volume and the hull do not change.
TEST(EdgeRemoval, EveryRingUpToSeven) {
  for (int n = 3; n <= 7; ++n) {
    Workbench w(ring_mesh(n, 1));
    make_bad(w);
    const double volume = w.mesh.total_volume();
    const Index low = w.at(0, 0, -1), high = w.at(0, 0, 1);
    EXPECT_EQ(remove_axis(w, low, high, basic), n == 3 ? Outcome::done : Outcome::no_candidate);
    if (n > 3) {
      ASSERT_EQ(remove_axis(w, low, high, all), Outcome::done) << n;
    }
    EXPECT_EQ(w.mesh.live_tets(), static_cast<std::size_t>(2 * (n - 2)));
    EXPECT_NEAR(w.mesh.total_volume(), volume, 1e-14);
    EXPECT_EQ(w.ws->counts.of(n == 3 ? Operation::flip32 : Operation::edge_removal, Outcome::done), 1u);
    w.expect_sound();
  }
  Workbench eight(ring_mesh(8, 1));
  make_bad(eight);
  EXPECT_EQ(remove_axis(eight, eight.at(0, 0, -1), eight.at(0, 0, 1), all), Outcome::too_large);
}

// The best of all triangulations of the ring is found: compared with all fans for five points.
TEST(EdgeRemoval, FindsTheBestTriangulation) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    TetMesh mesh = ring_mesh(5, 1);
    Random random(seed);
    for (std::size_t p = 2; p < mesh.points.size(); ++p) mesh.points[p] *= 0.6 + 0.8 * random.uniform();
    Workbench w(mesh);
    w.rules.objective.kind = Objective::Kind::shape;
    make_bad(w);
    float best = 0;
    for (int apex = 0; apex < 5; ++apex) {  // the five fans are all triangulations of a pentagon
      float worst = 1;
      for (int i = 1; i <= 3; ++i) {
        const auto at = [&](int k) { return mesh.points[2 + (apex + k) % 5] * w.mesh.space().scale(); };
        const Vec3 a = at(0), b = at(i), c = at(i + 1);
        worst = std::min({worst, w.rules.objective(a, b, c, mesh.points[1] * w.mesh.space().scale()),
                          w.rules.objective(a, c, b, mesh.points[0] * w.mesh.space().scale())});
      }
      best = std::max(best, worst);
    }
    const Outcome o = remove_axis(w, w.at(0, 0, -1), w.at(0, 0, 1), all);
    if (best == 0) {
      EXPECT_EQ(o, Outcome::quality);
      continue;
    }
    ASSERT_EQ(o, Outcome::done) << seed;
    float worst = 1;
    for (Index t = 0; t < w.mesh.tet_slots(); ++t)
      if (!w.mesh.dead(t)) worst = std::min(worst, w.mesh.quality(t));
    EXPECT_NEAR(worst, best, 1e-6) << seed;
  }
}

TEST(EdgeRemoval, TheBoundarysTwoToTwo) {
  // A square pyramid cut along one diagonal of its base, which is flat, so the volume does not change.
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0.5, 0.6}};
  mesh.tets = {{0, 1, 3, 4}, {0, 2, 1, 4}};
  mesh.materials = {1, 1};
  Workbench w(mesh);
  make_bad(w);
  const double volume = w.mesh.total_volume();
  ASSERT_EQ(remove_axis(w, w.at(0, 0, 0), w.at(1, 1, 0), basic), Outcome::done);
  EXPECT_EQ(w.ws->counts.of(Operation::flip22, Outcome::done), 1u);
  EXPECT_EQ(w.mesh.live_tets(), 2u);
  EXPECT_NEAR(w.mesh.total_volume(), volume, 1e-14);
  w.expect_sound();
  // The inverse flip.
  make_bad(w);
  ASSERT_EQ(remove_axis(w, w.at(1, 0, 0), w.at(0, 1, 0), basic), Outcome::done);
  w.expect_sound();
}

TEST(EdgeRemoval, ErrorBoundsWhatTheSurfaceLoses) {
  TetMesh mesh = ring_mesh(2, 1, true, std::numbers::pi * 0.8);  // the flip would cut off a ridge
  Workbench w(mesh);
  make_bad(w);
  w.rules.error.max = 1e-3;
  EXPECT_EQ(remove_axis(w, w.at(0, 0, -1), w.at(0, 0, 1), basic), Outcome::surface_error);
  w.expect_sound();
}

TEST(EdgeRemoval, AnInterfacesFourToFour) {
  Workbench w(ring_mesh(4, 1, false, 0, [](int i) { return MaterialTag(i < 2 ? 1 : 2); }));
  make_bad(w);
  ASSERT_EQ(remove_axis(w, w.at(0, 0, -1), w.at(0, 0, 1), basic), Outcome::done);
  EXPECT_EQ(w.ws->counts.of(Operation::flip44, Outcome::done), 1u);
  EXPECT_EQ(w.mesh.live_tets(), 4u);
  w.expect_sound();
}

TEST(EdgeRemoval, LongerChainsOfAnInterface) {
  Workbench w(ring_mesh(8, 1, false, 0, [](int i) { return MaterialTag(i < 4 ? 1 : 2); }));
  make_bad(w);
  ASSERT_EQ(remove_axis(w, w.at(0, 0, -1), w.at(0, 0, 1), all), Outcome::done);
  EXPECT_EQ(w.mesh.live_tets(), 12u);
  w.expect_sound();
}

TEST(EdgeRemoval, JunctionEdgesStay) {
  Workbench w(ring_mesh(6, 1, false, 0, [](int i) { return MaterialTag(i / 2); }));
  make_bad(w);
  EXPECT_EQ(remove_axis(w, w.at(0, 0, -1), w.at(0, 0, 1), all), Outcome::material_rule);
  w.expect_sound();
}

// A cavity of one tet. Removing one of its edges would create the opposite edge, which exists already, and
// fill the cavity.
TEST(EdgeRemoval, AnEdgeThatIsThereElsewhereIsNotMadeAgain) {
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    TetMesh mesh = grid_mesh(3);
    jitter(mesh, seed, 0.3);
    const std::size_t missing = 6 * 13 + seed % 6;  // in the cube in the middle
    const Tet cavity = mesh.tets[missing];
    std::array<Vec3, 4> corners;
    for (int k = 0; k < 4; ++k) corners[k] = mesh.points[cavity[k]];
    mesh.tets.erase(mesh.tets.begin() + static_cast<std::ptrdiff_t>(missing));
    mesh.materials.pop_back();
    for (const auto& e : tet_edges) {
      Workbench w(mesh);
      make_bad(w);
      const auto at = [&](const Vec3& p) { return w.at(p.x(), p.y(), p.z()); };
      const Outcome o = remove_axis(w, at(corners[e[0]]), at(corners[e[1]]), all);
      EXPECT_NE(o, Outcome::done);
      refused += o == Outcome::link_condition;
      w.expect_sound();
    }
  }
  EXPECT_GT(refused, 5);
}

TEST(EdgeRemoval, CountLimitsHold) {
  Workbench w(ring_mesh(3, 1));
  make_bad(w);
  w.rules.count.min = 3;
  EXPECT_EQ(remove_axis(w, w.at(0, 0, -1), w.at(0, 0, 1), all), Outcome::count);
  w.expect_sound();
  Workbench six(ring_mesh(6, 1));
  make_bad(six);
  six.rules.count.max = 7;
  EXPECT_EQ(remove_axis(six, six.at(0, 0, -1), six.at(0, 0, 1), all), Outcome::count);
  six.expect_sound();
}

}  // namespace
}  // namespace tetwright::edge_removal_test
