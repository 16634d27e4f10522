// What the thread sanitizer watches: eight threads on one mesh, with chunks so small that their stars meet
// all the time. Built a second time with the locks taken out (test_without_locks), it must fail.
#include <gtest/gtest.h>

#include "common/mesh_check.h"
#include "common/parallel.h"
#include "common/topology.h"
#include "simplify/simplify.h"
#include "tests/simplify/meshes.h"

namespace tetwright {
namespace {

TEST(Concurrency, EightThreadsMeetAndTheMeshStaysSound) {
  const ThreadLimit eight(8);
  std::uint64_t conflicts = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    TetMesh mesh = grid_mesh(
        {12, 12, 12}, [](int x, int y, int) { return std::optional<MaterialTag>(x + y < 12 ? 1 : 2); });
    jitter(mesh, seed);
    const Topology before = topology(mesh);
    SimplifyOptions options;
    options.target_tets = 1500;
    options.seed = seed;
    options.chunk_size = 16;
    SimplifyReport report;
    const TetMesh after = simplify(mesh, options, &report);
    EXPECT_NEAR(static_cast<double>(after.tets.size()), 1500, 15);
    for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
    for (const std::string& d : topology_differences(before, topology(after))) ADD_FAILURE() << d;
    for (const auto& it : report.iterations) conflicts += it.lock_conflicts;
  }
  EXPECT_GT(conflicts, 0u);
}

}  // namespace
}  // namespace tetwright
