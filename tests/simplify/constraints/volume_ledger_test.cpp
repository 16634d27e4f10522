// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/volume_ledger.h"

#include "simplify/operations/collapse.h"
#include "simplify/operations/smoothing.h"
#include "tests/simplify/workbench.h"

namespace tetwright::volume_ledger_test {
namespace {

using Changes = std::vector<VolumeChange>;

TEST(VolumeLedger, CommitsWithinItsBoundsAndBackTowardsThem) {
  const EditableMesh mesh(
      grid_mesh({4, 4, 4}, [](int x, int, int) { return std::optional<MaterialTag>(x < 2 ? 1 : 2); }),
      "mesh");
  const double half = mesh.total_volume() / 2;
  VolumeLedger ledger;
  ledger.open(mesh, 0.1);
  EXPECT_EQ(ledger.utilization(), 0);
  const Changes large{{0, 0.06 * half}, {1, -0.06 * half}};
  EXPECT_TRUE(ledger.allows(large));
  EXPECT_EQ(ledger.utilization(), 0);  // allows() records nothing
  ledger.commit(large);
  EXPECT_NEAR(ledger.utilization(), 0.6, 1e-12);
  EXPECT_FALSE(ledger.allows(Changes{{0, 0.05 * half}, {outside_id, -1}}));
  EXPECT_FALSE(
      ledger.allows(Changes{{0, -0.01 * half}, {1, -0.05 * half}}));  // one of two violations suffices
  EXPECT_FALSE(ledger.allows(large));
  EXPECT_NEAR(ledger.utilization(), 0.6, 1e-12);
  const Changes back{{0, -0.06 * half}, {1, 0.06 * half}};
  EXPECT_TRUE(ledger.allows(back));
  ledger.commit(back);
  EXPECT_NEAR(ledger.utilization(), 0, 1e-12);
  // A volume already outside its bounds may return, but not deviate more.
  ledger.commit(Changes{{0, 0.2 * half}});
  EXPECT_TRUE(ledger.allows(Changes{{0, -0.05 * half}}));
  EXPECT_FALSE(ledger.allows(Changes{{0, 0.001 * half}}));
  const VolumeLedger open;
  EXPECT_TRUE(open.allows(Changes{{0, 1e9}}));
}

// A coarsened mesh keeps the volumes that it had before.
TEST(VolumeLedger, KeepsInitialVolumesThatAreNotTheCurrentOnes) {
  TetMesh input =
      grid_mesh({4, 4, 4}, [](int x, int, int) { return std::optional<MaterialTag>(x < 2 ? 1 : 2); });
  for (Vec3& p : input.points) p = Vec3(5, 6, 7) + 3 * p;
  const EditableMesh mesh(std::move(input), "mesh");
  const double volume = 27 * 32;                                    // of each material, input units cubed
  const double half = mesh.total_volume() / 2;                      // the same in working coordinates
  const std::map<MaterialTag, double> initial{{1, 1.04 * volume}};  // 2 has its current one
  VolumeLedger ledger;
  ledger.open(mesh, 0.1, &initial);
  EXPECT_NEAR(ledger.utilization(0), 0.4 / 1.04, 1e-12);
  EXPECT_NEAR(ledger.utilization(1), 0, 1e-12);
  // From 4 % below, 6 % may be lost and 14 % gained; without initial volumes 10 %.
  EXPECT_FALSE(ledger.allows(Changes{{0, -0.07 * half}}));
  EXPECT_TRUE(ledger.allows(Changes{{0, -0.06 * half}}));
  EXPECT_TRUE(ledger.allows(Changes{{0, 0.13 * half}}));
  EXPECT_TRUE(ledger.allows(Changes{{1, 0.09 * half}}));
  EXPECT_FALSE(ledger.allows(Changes{{1, 0.11 * half}}));
  // Outside the bounds a volume may only return.
  const std::map<MaterialTag, double> larger{{1, 1.5 * volume}, {2, 0.5 * volume}, {9, 1}};
  ledger.open(mesh, 0.1, &larger);
  EXPECT_GT(ledger.utilization(0), 1);
  EXPECT_GT(ledger.utilization(1), 1);
  EXPECT_TRUE(ledger.allows(Changes{{0, 0.01 * half}, {1, -0.01 * half}}));
  EXPECT_FALSE(ledger.allows(Changes{{0, -0.01 * half}}));
  EXPECT_FALSE(ledger.allows(Changes{{1, 0.01 * half}}));
}

// A protruding corner may be removed while the volume bound permits, but not afterwards. An operation refused
// because of the count commits nothing.
TEST(VolumeLedger, HoldsCollapsesBack) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, 1);
  for (double share : {1e-9, 0.5}) {
    Workbench w(mesh);
    w.ledger.open(w.mesh, share);
    w.rules.acceptance.worse_probability = 1;
    std::size_t done = 0, volume = 0;
    for (Index p : w.live_points()) {
      if (w.mesh.incident_tet(p) == no_index || w.star(p).interface_triangles.empty()) continue;
      const Outcome o = w.carry_out(collapse(*w.ws, w.rules));
      done += o == Outcome::done;
      volume += o == Outcome::volume;
    }
    EXPECT_EQ(volume > 0, share < 0.1);
    EXPECT_EQ(done > 10, share > 0.1);
    w.expect_sound();
  }
  Workbench w(mesh);
  w.ledger.open(w.mesh, 0.5);
  w.rules.acceptance.worse_probability = 1;
  w.rules.count.min = w.mesh.live_tets();
  for (Index p : w.live_points())
    if (!w.star(p).interface_triangles.empty()) {
      EXPECT_NE(w.carry_out(collapse(*w.ws, w.rules)), Outcome::done);
    }
  EXPECT_NEAR(w.ledger.utilization(), 0, 1e-12);
}

}  // namespace
}  // namespace tetwright::volume_ledger_test
