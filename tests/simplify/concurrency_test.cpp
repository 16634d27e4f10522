// SPDX-License-Identifier: Apache-2.0

// Run under the thread sanitizer: eight threads on one mesh, in batches so large that many proposals
// conflict. A second build that ignores reservations (test_without_reservations) must fail.
#include <gtest/gtest.h>

#include "tests/simplify/meshes.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"
#include "tetwright/simplify.h"

namespace tetwright::concurrency_test {
namespace {

TetMesh three_materials(std::uint64_t seed) {
  TetMesh mesh = grid_mesh({10, 10, 10}, [](int x, int y, int z) {
    return std::optional<MaterialTag>(z < 3 ? 3 : x + y < 10 ? 1 : 2);
  });
  jitter(mesh, seed, 0.3);
  return mesh;
}

void expect_kept(const TetMesh& before, const TetMesh& after) {
  for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
  for (const std::string& d : topology_differences(topology(before), topology(after))) ADD_FAILURE() << d;
}

TEST(Concurrency, EightThreadsLeaveASoundMesh) {
  const ThreadLimit eight(8);
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const TetMesh mesh = three_materials(seed);
    SimplifyOptions options;
    options.target_tets = 900;
    options.seed = seed;
    options.batch_size = 1024;
    options.schedule = seed == 2 ? Schedule::paper : Schedule::tuned;
    const TetMesh after = simplify(mesh, options);
    EXPECT_NEAR(static_cast<double>(after.tets.size()), 900, 9);
    expect_kept(mesh, after);
  }
}

TEST(Concurrency, EightThreadsImprove) {
  const ThreadLimit eight(8);
  const TetMesh mesh = three_materials(4);
  ImproveOptions options;
  options.batch_size = 1024;
  options.max_iterations = 12;
  expect_kept(mesh, improve(mesh, options));
}

}  // namespace
}  // namespace tetwright::concurrency_test
