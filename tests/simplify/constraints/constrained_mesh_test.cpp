// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/constrained_mesh.h"

#include <gtest/gtest.h>

#include "tests/simplify/meshes.h"
#include "tetwright/error.h"

namespace tetwright::constrained_mesh_test {
namespace {

TEST(ConstrainedMesh, RefusesAMeshThatIsInsideOut) {
  TetMesh mesh = grid_mesh(2);
  for (Tet& t : mesh.tets) std::swap(t[0], t[1]);
  try {
    ConstrainedMesh(std::move(mesh), "scan.vtu", {}, false, true);
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("scan.vtu"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("add up to nothing or less"), std::string::npos);
  }
}

TEST(ConstrainedMesh, FreezesAndBoundsVolumesAsAsked) {
  const ConstrainedMesh open(grid_mesh(3), "mesh", {}, false, false);
  const ConstrainedMesh bounded(grid_mesh(3), "mesh", {}, true, true);
  std::size_t frozen = 0;
  for (Index p = 0; p < bounded.mesh.point_slots(); ++p) {
    EXPECT_FALSE(open.mesh.frozen(p));
    frozen += bounded.mesh.frozen(p);
  }
  EXPECT_EQ(frozen, 56u);  // all 4^3 points except 2^3
  const double volume = open.mesh.total_volume();
  const std::vector<VolumeChange> tenth{{0, 0.1 * volume}}, some{{0, 0.007 * volume}},
      more{{0, 0.009 * volume}};
  EXPECT_TRUE(open.ledger.allows(tenth));
  EXPECT_FALSE(bounded.ledger.allows(tenth));
  EXPECT_FALSE(bounded.ledger.allows(more));
  EXPECT_TRUE(bounded.ledger.allows(some));
}

}  // namespace
}  // namespace tetwright::constrained_mesh_test
