// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/tet_tree.h"

#include <gtest/gtest.h>

#include "common/random.h"
#include "tests/simplify/meshes.h"

namespace tetwright::tet_tree_test {
namespace {

Vec3 place_of(const TetMesh& mesh, const FoundTet& found) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 4; ++k) sum += found.weights[k] * mesh.points[mesh.tets[found.tet][k]];
  return sum;
}

TEST(TetTree, WeightsGiveThePlaceWithin) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, 1);
  const TetTree tree(mesh, TetTree::Order::place);
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(0.5 + 3 * random.uniform(), 0.5 + 3 * random.uniform(), 0.5 + 3 * random.uniform());
    const FoundTet found = tree.find(p, tree.all(), 0);
    ASSERT_NE(found.tet, no_index);
    EXPECT_LT((place_of(mesh, found) - p).norm(), 1e-14);
  }
}

TEST(TetTree, TheNearestWithinTheDistance) {
  const TetMesh mesh = grid_mesh(2);
  const TetTree tree(mesh, TetTree::Order::place);
  const Vec3 p(3, 1.25, 0.5);
  EXPECT_LT((place_of(mesh, tree.find(p, tree.all())) - Vec3(2, 1.25, 0.5)).norm(), 1e-15);
  EXPECT_NE(tree.find(p, tree.all(), 1.001).tet, no_index);
  EXPECT_EQ(tree.find(p, tree.all(), 0.999).tet, no_index);
  const TetMesh empty;
  const TetTree none(empty, TetTree::Order::place);
  EXPECT_EQ(none.find(p, none.all()).tet, no_index);
}

}  // namespace
}  // namespace tetwright::tet_tree_test
