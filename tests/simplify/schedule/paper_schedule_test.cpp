// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>

#include "tests/simplify/meshes.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"
#include "tetwright/simplify.h"

namespace tetwright::paper_schedule_test {
namespace {

TEST(PaperSchedule, ReachesTheTargetByFigure3) {
  TetMesh mesh =
      grid_mesh({16, 16, 16}, [](int x, int, int) { return std::optional<MaterialTag>(x < 8 ? 1 : 2); });
  jitter(mesh, 3);
  SimplifyOptions options;
  options.target_tets = 1000;
  options.schedule = Schedule::paper;
  SimplifyReport report;
  const TetMesh after = simplify(mesh, options, &report);
  EXPECT_NEAR(static_cast<double>(after.tets.size()), 1000, 10);
  for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
  for (const std::string& d : topology_differences(topology(mesh), topology(after))) ADD_FAILURE() << d;

  // Percent and E follow Figure 3 until the count is reached; there is no closing improvement.
  ASSERT_GE(report.iterations.size(), 2u);
  const double volume = 16.0 * 16 * 16;
  EXPECT_NEAR(report.iterations[0].max_error, std::cbrt(volume / 1000), 0.02 * std::cbrt(volume / 1000));
  bool reached = false;
  for (std::size_t i = 0; i < report.iterations.size(); ++i) {
    const IterationReport& it = report.iterations[i];
    EXPECT_EQ(it.kind, "simplify");
    EXPECT_EQ(std::accumulate(it.tets_by_quality.begin(), it.tets_by_quality.end(), std::size_t{0}),
              it.tets_before);
    // The cutoff is Quality(t) of the tet at that percentage, which is therefore in the cutoff's bin.
    const auto bins = it.tets_by_quality.size();
    const auto own = std::min(bins - 1, static_cast<std::size_t>(it.cutoff * static_cast<double>(bins)));
    const auto worse = std::accumulate(it.tets_by_quality.begin(),
                                       it.tets_by_quality.begin() + static_cast<std::ptrdiff_t>(own), 0.0);
    const double chosen = it.percent / 100 * static_cast<double>(it.tets_before);
    EXPECT_LE(worse, chosen + 1);
    EXPECT_GE(worse + static_cast<double>(it.tets_by_quality[own]), chosen - 1);
    EXPECT_EQ(it.percent, std::min(100.0, 10.0 * static_cast<double>(i + 1)));
    if (i == 0) continue;
    const IterationReport& last = report.iterations[i - 1];
    reached |= last.tets_before <= 1000;
    const double growth = reached ? 1 : std::max(1.0, std::cbrt(static_cast<double>(last.tets_after) / 1000));
    EXPECT_NEAR(it.max_error, growth * last.max_error, 1e-9 * it.max_error);
  }
}

TEST(PaperSchedule, OneThreadAndOneSeedGiveTheSameBytes) {
  const ThreadLimit one(1);
  TetMesh mesh = grid_mesh(8);
  jitter(mesh, 4);
  SimplifyOptions options;
  options.target_tets = 300;
  options.schedule = Schedule::paper;
  const TetMesh a = simplify(mesh, options), b = simplify(mesh, options);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.tets, b.tets);
}

}  // namespace
}  // namespace tetwright::paper_schedule_test
