// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/limiting_rules.h"

#include <gtest/gtest.h>

namespace tetwright::limiting_rules_test {
namespace {

void put(OperationCounts& counts, Operation operation, Outcome outcome, std::uint64_t n) {
  for (std::uint64_t i = 0; i < n; ++i) counts.add(operation, outcome);
}

TEST(LimitingRules, NamesTheMainRulesWithTheirShares) {
  OperationCounts c;
  put(c, Operation::collapse, Outcome::link_condition, 61);
  put(c, Operation::collapse, Outcome::surface_error, 30);
  put(c, Operation::collapse, Outcome::inverts, 5);
  put(c, Operation::collapse, Outcome::quality, 4);
  // Outcomes that are not refusals, and another operation.
  put(c, Operation::collapse, Outcome::done, 500);
  put(c, Operation::collapse, Outcome::conflict, 500);
  put(c, Operation::collapse, Outcome::stale, 500);
  put(c, Operation::flip23, Outcome::no_candidate, 500);
  put(c, Operation::flip23, Outcome::quality, 900);
  EXPECT_EQ(main_refusals(c, {Operation::collapse}), "link_condition 61 %, surface_error 30 %, inverts 5 %");
  EXPECT_EQ(main_refusals(c, {Operation::collapse, Operation::flip23}), "quality 90 %, link_condition 6 %");
}

TEST(LimitingRules, WithoutRefusalsThereAreNone) {
  OperationCounts c;
  EXPECT_EQ(main_refusals(c, {Operation::collapse}), "");
  put(c, Operation::collapse, Outcome::no_candidate, 3);
  EXPECT_EQ(main_refusals(c, {Operation::collapse}), "");
  EXPECT_EQ(rules_limiting_count({}, 100), "nothing: no operation was left to try");
  EXPECT_EQ(rules_limiting_shapes({}), "nothing: no operation was left to try");
}

TEST(LimitingRules, LooksAtTheLastIterationOfItsKind) {
  SimplifyReport report;
  const auto iteration = [&](const char* kind, Operation operation, Outcome outcome) {
    IterationReport it;
    it.kind = kind;
    put(it.counts, operation, outcome, 7);
    report.iterations.push_back(it);
  };
  iteration("simplify", Operation::collapse, Outcome::surface_error);
  EXPECT_EQ(rules_limiting_shapes(report), "surface_error 100 %");
  iteration("simplify", Operation::collapse, Outcome::link_condition);
  iteration("close", Operation::smooth, Outcome::inverts);
  iteration("close", Operation::smooth, Outcome::done);
  EXPECT_EQ(rules_limiting_count(report, 100), "link_condition 100 %");
  EXPECT_EQ(rules_limiting_count(report, 2), "max_iterations (all 2 were used); link_condition 100 %");
  EXPECT_EQ(rules_limiting_shapes(report), "inverts 100 %");
  iteration("improve", Operation::flip23, Outcome::quality);
  EXPECT_EQ(rules_limiting_shapes(report), "quality 100 %");
}

}  // namespace
}  // namespace tetwright::limiting_rules_test
