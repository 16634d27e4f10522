// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/block_rules.h"

#include <limits>

#include "tests/simplify/workbench.h"

namespace tetwright::block_rules_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(BlockRules, AnErrorBoundGrowsWithTheLengthOfEdges) {
  ErrorBound bound;
  EXPECT_EQ(bound.limit(), 0);
  bound.max = 2;
  EXPECT_EQ(bound.limit(), 2);
  EXPECT_EQ(bound.limit(3), 6);
  bound.max.reset();
  EXPECT_EQ(bound.limit(3), infinity);
}

TEST(BlockRules, ADeviationNeverExceedsTheTolerance) {
  DeviationBound bound;
  EXPECT_EQ(bound.limit(3), infinity);
  EXPECT_EQ(bound.widened(3), std::nullopt);
  bound.max = 2;
  EXPECT_EQ(bound.limit(3), 6);
  EXPECT_EQ(bound.widened(3), 6);
  bound.tolerance = 5;
  EXPECT_EQ(bound.limit(3), 5);
  EXPECT_EQ(bound.widened(3), 5);
  EXPECT_EQ(bound.widened(2), 4);
  bound.max.reset();
  EXPECT_EQ(bound.limit(3), 5);
  EXPECT_EQ(bound.widened(3), 5);
}

TEST(BlockRules, GoodTetsAreAcceptedWhateverWasThere) {
  Workbench w(grid_mesh(2));
  BlockRules rules;
  EXPECT_EQ(w.ws->acceptance_limit(rules, 0.6f), 0.6f);
  rules.acceptance.good_enough = 0.2f;
  EXPECT_EQ(w.ws->acceptance_limit(rules, 0.6f), 0.2f);
  EXPECT_EQ(w.ws->acceptance_limit(rules, 0.1f), 0.1f);
  rules.acceptance = {.worse_probability = 1, .worse_floor = 0.5f, .good_enough = {}};
  EXPECT_EQ(w.ws->acceptance_limit(rules, 0.6f), 0.3f);
}

}  // namespace
}  // namespace tetwright::block_rules_test
