// What the thread sanitizer watches: eight threads on one mesh, with chunks so small that their stars meet
// all the time. Built a second time with the locks taken out (test_without_locks), it must fail.
#include <gtest/gtest.h>

#include "common/parallel.h"
#include "common/predicates.h"
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
    SimplifyOptions options;
    options.target_tets = 1500;
    options.seed = seed;
    options.chunk_size = 16;
    SimplifyReport report;
    const TetMesh after = simplify(mesh, options, &report);
    EXPECT_NEAR(static_cast<double>(after.tets.size()), 1500, 15);
    for (const Tet& t : after.tets)
      ASSERT_EQ(orient3d(after.points[t[0]], after.points[t[1]], after.points[t[2]], after.points[t[3]]), 1);
    for (const auto& it : report.iterations) conflicts += it.lock_conflicts;
  }
  EXPECT_GT(conflicts, 0u);
}

}  // namespace
}  // namespace tetwright
