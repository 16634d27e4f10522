// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/link_condition.h"

#include <set>

#include "simplify/operations/collapse.h"
#include "tests/simplify/contraction.h"
#include "tests/simplify/workbench.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::link_condition_test {
namespace {

using Tag = std::optional<MaterialTag>;

TetMesh as_mesh(const EditableMesh& mesh) { return contracted(mesh, no_index, no_index); }

bool manifold(const TetMesh& mesh) {
  std::set<Tet> distinct;
  for (Tet t : mesh.tets) {
    std::sort(t.begin(), t.end());
    if (!distinct.insert(t).second) return false;
  }
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size()))
    if (f.count > 2) return false;
  return true;
}

// Small meshes with random materials: collapses that the condition allows must keep the signature of every
// part.
TEST(LinkCondition, WhatPassesKeepsTheTopology) {
  int passed = 0, refused = 0, refused_rightly = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    std::vector<int> tags(27);
    for (int& tag : tags) tag = static_cast<int>(random.below(seed % 2 ? 2 : 3));
    TetMesh mesh = grid_mesh({3, 3, 3}, [&](int x, int y, int z) {
      return Tag(tags[static_cast<std::size_t>(x + 3 * y + 9 * z)]);
    });
    jitter(mesh, seed);
    Workbench w(mesh);
    // Collapse some points first, since links conflict in coarse meshes.
    w.rules.acceptance.worse_probability = 1;
    for (Index p : w.live_points()) {
      w.star(p);
      if (random.below(4)) w.carry_out(collapse(*w.ws, w.rules));
    }
    const Topology before = topology(as_mesh(w.mesh));
    for (Index a : w.live_points()) {
      if (w.mesh.incident_tet(a) == no_index) continue;
      const Star& star = w.star(a);
      const int dimension = star.dimension();
      if (dimension == 0) continue;
      for (std::size_t b = 0; b < star.points.size(); ++b) {
        if (star.edge_dimension(b) != dimension) continue;
        const bool allowed = w.ws->link_condition.holds(w.mesh, w.grid, star, b);
        const TetMesh after = contracted(w.mesh, a, star.points[b]);
        if (after.tets.empty()) {
          EXPECT_FALSE(allowed);
          continue;
        }
        const bool kept = manifold(after) && topology(after) == before;
        if (allowed) {
          ++passed;
          EXPECT_TRUE(kept) << "seed " << seed << ", " << a << " onto " << star.points[b];
        } else {
          ++refused;
          refused_rightly += !kept;
        }
      }
    }
  }
  // The condition is neither always true nor always false.
  EXPECT_GT(passed, 500);
  EXPECT_GT(refused_rightly, 20);
  // It is sufficient but not necessary, so it may refuse too much, but only rarely.
  EXPECT_LT(refused - refused_rightly, refused / 2) << refused;
}

// A tube three edges around: contracting one of them would pinch it off.
TEST(LinkCondition, ASpanOverAHoleIsRefused) {
  const auto ring = [](int x, int y, int) { return x == 1 && y == 1 ? Tag() : Tag(1); };
  Workbench w(grid_mesh({3, 3, 1}, ring));
  int allowed = 0;
  for (Index a : w.live_points()) {
    const Star& star = w.star(a);
    for (std::size_t b = 0; b < star.points.size(); ++b)
      if (star.edge_dimension(b) == star.dimension() && w.ws->link_condition.holds(w.mesh, w.grid, star, b)) {
        ++allowed;
        EXPECT_EQ(topology(contracted(w.mesh, a, star.points[b])), topology(as_mesh(w.mesh)));
      }
  }
  EXPECT_GT(allowed, 0);
}

}  // namespace
}  // namespace tetwright::link_condition_test
