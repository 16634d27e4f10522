// SPDX-License-Identifier: Apache-2.0

// The result depends only on the mesh, the options and the seed, not on the number of threads or their
// timing. A second build has threads that yield at random (test_yields).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "tests/simplify/meshes.h"
#include "tetwright/resources.h"
#include "tetwright/simplify.h"

namespace tetwright::determinism_test {
namespace {

#ifdef TETWRIGHT_INJECT_YIELDS
// Small, since pauses and the thread sanitizer take time.
constexpr int cells = 5;
const std::vector<unsigned> thread_counts{2, 8};
#else
constexpr int cells = 10;
const std::vector<unsigned> thread_counts{2, 3, 8, 16};
#endif
constexpr std::size_t target = static_cast<std::size_t>(cells * cells * cells) * 6 / 8;

TetMesh three_materials() {
  TetMesh mesh = grid_mesh({cells, cells, cells}, [](int x, int y, int z) {
    return std::optional<MaterialTag>(z < cells / 4 ? 3 : x + y < cells ? 1 : 2);
  });
  jitter(mesh, 11, 0.4);
  return mesh;
}

/// Empty if both are equal bit by bit, otherwise a description of the difference.
std::string difference(const TetMesh& a, const TetMesh& b) {
  if (a.points.size() != b.points.size() || a.tets.size() != b.tets.size())
    return "sizes: " + std::to_string(a.tets.size()) + " and " + std::to_string(b.tets.size()) + " tets";
  if (std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(Vec3)) != 0) return "points";
  if (a.tets != b.tets) return "tets";
  if (a.materials != b.materials) return "materials";
  return a.interfaces == b.interfaces ? "" : "interfaces";
}

enum class Work { tuned, paper, improve };
struct Case {
  const char* name;
  Work work;
  std::size_t batch_size;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

TetMesh run(const Case& c, unsigned threads, std::uint64_t seed, SimplifyReport* report = nullptr) {
  const ThreadLimit limit(threads);
  if (c.work == Work::improve) {
    ImproveOptions options;
    options.seed = seed;
    options.batch_size = c.batch_size;
    options.max_iterations = 8;
    return improve(three_materials(), options, report);
  }
  SimplifyOptions options;
  options.target_tets = target;
  options.seed = seed;
  options.batch_size = c.batch_size;
  options.schedule = c.work == Work::paper ? Schedule::paper : Schedule::tuned;
  return simplify(three_materials(), options, report);
}

// Batches below 33 points or tets are decided by one thread, except those of ordered blocks.
class Determinism : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Cases, Determinism,
                         testing::Values(Case{"tuned", Work::tuned, 0},
                                         Case{"tuned_small_batches", Work::tuned, 64},
                                         Case{"tuned_large_batches", Work::tuned, 4000},
                                         Case{"paper", Work::paper, 0}, Case{"improve", Work::improve, 0},
                                         Case{"improve_small_batches", Work::improve, 16}),
                         [](const auto& c) { return c.param.name; });

TEST_P(Determinism, AnyNumberOfThreadsGivesTheSameBytes) {
  SimplifyReport alone;
  const TetMesh expected = run(GetParam(), 1, 1, &alone);
  std::uint64_t batches = 0, conflicts = 0;
  for (const IterationReport& it : alone.iterations) {
    batches += it.batches;
    conflicts += it.conflicts;
  }
  EXPECT_GT(batches, 10u);
  EXPECT_GT(conflicts, 0u);
#ifdef TETWRIGHT_INJECT_YIELDS
  const auto is_by_several = [](const SimplifyReport& report) {
    return std::count_if(report.decided_by_worker.begin(), report.decided_by_worker.end(),
                         [](std::uint64_t n) { return n > 0; }) > 1;
  };
  bool by_several = false;
#endif
  for (const unsigned threads : thread_counts) {
    SimplifyReport report;
    const TetMesh mesh = run(GetParam(), threads, 1, &report);
    EXPECT_EQ(difference(mesh, expected), "") << threads << " threads";
    // The counts must be equal as well.
    ASSERT_EQ(report.iterations.size(), alone.iterations.size());
    for (std::size_t i = 0; i < report.iterations.size(); ++i) {
      EXPECT_EQ(report.iterations[i].tets_after, alone.iterations[i].tets_after);
      EXPECT_EQ(report.iterations[i].tets_by_quality, alone.iterations[i].tets_by_quality);
      EXPECT_EQ(report.iterations[i].counts.counts, alone.iterations[i].counts.counts);
      EXPECT_EQ(report.iterations[i].conflicts, alone.iterations[i].conflicts);
    }
    const std::vector<std::uint64_t>& decided = report.decided_by_worker;
    EXPECT_EQ(
        std::accumulate(decided.begin(), decided.end(), std::uint64_t{0}),
        std::accumulate(alone.decided_by_worker.begin(), alone.decided_by_worker.end(), std::uint64_t{0}));
#ifdef TETWRIGHT_INJECT_YIELDS
    by_several |= is_by_several(report);
#endif
  }
#ifdef TETWRIGHT_INJECT_YIELDS
  // At least two threads must have worked for a meaningful test. On a busy machine one may do all work of a
  // run.
  for (int more = 0; more < 20 && !by_several; ++more) {
    SimplifyReport report;
    EXPECT_EQ(difference(run(GetParam(), 8, 1, &report), expected), "");
    by_several = is_by_several(report);
  }
  EXPECT_TRUE(by_several);
#endif
}

#ifndef TETWRIGHT_INJECT_YIELDS
TEST_P(Determinism, AnotherSeedGivesAnotherResult) {
  EXPECT_NE(difference(run(GetParam(), 2, 1), run(GetParam(), 2, 2)), "");
}
#endif

}  // namespace
}  // namespace tetwright::determinism_test
