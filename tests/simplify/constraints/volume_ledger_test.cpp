#include "simplify/constraints/volume_ledger.h"

#include "simplify/operations/collapse.h"
#include "simplify/operations/smoothing.h"
#include "tests/simplify/workbench.h"

namespace tetwright::volume_ledger_test {
namespace {

using Changes = std::vector<VolumeChange>;

TEST(VolumeLedger, BooksWithinItsBoundsAndBackTowardsThem) {
  const EditableMesh mesh(
      grid_mesh({4, 4, 4}, [](int x, int, int) { return std::optional<MaterialTag>(x < 2 ? 1 : 2); }),
      "mesh");
  const double half = mesh.total_volume() / 2;
  VolumeLedger ledger;
  ledger.open(mesh, 0.1);
  EXPECT_EQ(ledger.strain(), 0);
  EXPECT_TRUE(ledger.book(Changes{{0, 0.06 * half}, {1, -0.06 * half}}));
  EXPECT_NEAR(ledger.strain(), 0.6, 1e-12);
  EXPECT_FALSE(ledger.book(Changes{{0, 0.05 * half}, {outside_id, -1}}));
  EXPECT_FALSE(ledger.book(Changes{{0, -0.01 * half}, {1, -0.05 * half}}));  // one of two is enough
  EXPECT_NEAR(ledger.strain(), 0.6, 1e-12);
  EXPECT_TRUE(ledger.book(Changes{{0, -0.06 * half}, {1, 0.06 * half}}));
  EXPECT_NEAR(ledger.strain(), 0, 1e-12);
  ledger.book(Changes{{0, 0.09 * half}});
  ledger.take_back(Changes{{0, 0.09 * half}});
  EXPECT_NEAR(ledger.strain(), 0, 1e-12);
  VolumeLedger open;
  EXPECT_TRUE(open.book(Changes{{0, 1e9}}));
}

// A corner that sticks out may go while there is volume to lose, and stays after; what fails at the count is
// taken back.
TEST(VolumeLedger, HoldsCollapsesBack) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, 1);
  for (double share : {1e-9, 0.5}) {
    Workbench w(mesh);
    w.ledger.open(w.mesh, share);
    w.rules.accept_worse = 1;
    std::size_t done = 0, volume = 0;
    for (Index p : w.live_points()) {
      if (w.mesh.incident_tet(p) == no_index || w.star(p).interface_triangles.empty()) continue;
      const Outcome o = collapse(*w.ws, w.rules);
      done += o == Outcome::done;
      volume += o == Outcome::volume;
    }
    EXPECT_EQ(volume > 0, share < 0.1);
    EXPECT_EQ(done > 10, share > 0.1);
    w.expect_sound();
  }
  Workbench w(mesh);
  w.ledger.open(w.mesh, 0.5);
  w.rules.accept_worse = 1;
  w.rules.min_tets = w.mesh.live_tets();
  for (Index p : w.live_points())
    if (!w.star(p).interface_triangles.empty()) {
      EXPECT_NE(collapse(*w.ws, w.rules), Outcome::done);
    }
  EXPECT_NEAR(w.ledger.strain(), 0, 1e-12);
}

}  // namespace
}  // namespace tetwright::volume_ledger_test
