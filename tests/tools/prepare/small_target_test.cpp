// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/small_target.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "tools/prepare/request_shortfalls.h"

namespace tetwright::small_target_test {
namespace {

const std::vector<MinTets> body_and_skin = {{"body", 12.3, 95}, {"skin", 0.687, 4702}};

TEST(SmallTarget, NamesTheCountAndTheMaterialThatTakesMost) {
  const auto found = small_target(300, body_and_skin);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->what,
            "--target-tets 300 is too small for good shapes: the materials take at least about 4800 tets "
            "('skin' 4800 at a mean thickness of 0.69)");
  EXPECT_EQ(found->severity, Severity::note);
  EXPECT_EQ(found->asked, 300);
}

TEST(SmallTarget, SaysNothingOfAnEnoughTargetNorOfFewTets) {
  EXPECT_FALSE(small_target(4797, body_and_skin));
  // The estimate may be a fifth too high.
  EXPECT_FALSE(small_target(3700, body_and_skin));
  EXPECT_TRUE(small_target(3500, body_and_skin));
  EXPECT_FALSE(small_target(10, {{"ball", 1, 40}}));
  EXPECT_FALSE(small_target(10, {}));
}

TEST(SmallTarget, ManyPartsAreNamedAsSuch) {
  const auto found = small_target(300, {{"foam", 5.9, 1000, 800, 160}});
  ASSERT_TRUE(found);
  EXPECT_NE(found->what.find("('foam' 1000 for the 160 parts of its boundary)"), std::string::npos)
      << found->what;
}

/// Whether the note stays for a result, of 300 tets asked.
bool stays(std::size_t tets, double below_percent, std::optional<double> min_solid_angle = {},
           std::size_t filling_tets = 0) {
  PrepareOptions options;
  options.target.tets = 300;
  options.shapes.min_solid_angle = min_solid_angle;
  Progress progress;
  PrepareReport report;
  PrepareRun run(Task::prepare, options, progress, report);
  report.inputs = {"body.stl"};
  report.min_tets = body_and_skin;
  report.mesher.emplace().filling_tets = filling_tets;
  report.diagnostics.push_back(*small_target(300, body_and_skin));
  report.simplify.emplace();
  report.dense.emplace();
  report.result.emplace();
  report.result->tets = tets;
  report.result->below_percent = below_percent;
  report.result->min_solid_angle = 0.01;
  find_request_shortfalls({}, run);
  return std::any_of(report.diagnostics.begin(), report.diagnostics.end(),
                     [](const Diagnostic& d) { return d.code == DiagnosticCode::target_too_small; });
}

TEST(SmallTarget, IsForgottenIfTheResultIsGood) {
  EXPECT_TRUE(stays(300, 5));
  EXPECT_TRUE(stays(700, 0));
  EXPECT_FALSE(stays(300, 0));
  // Other reasons than the count.
  EXPECT_FALSE(stays(100, 0));
  EXPECT_FALSE(stays(300, 5, 0.3));
  // Where the result, or thin walls, show that it takes far more.
  EXPECT_TRUE(stays(9000, 5));
  EXPECT_FALSE(stays(12000, 5));
  EXPECT_FALSE(stays(1043, 0, {}, 1043));
}

TEST(SmallTarget, CountNamedIsEnough) {
  for (const double need : {151.0, 199.9, 1234.0, 98765.0, 1.5e7}) {
    const auto found = small_target(1, {{"wall", 1, need}});
    ASSERT_TRUE(found);
    const std::size_t begin = found->remedy.find("give ") + 5;
    const double named = std::stod(found->remedy.substr(begin));
    EXPECT_GE(named, need);
    EXPECT_LE(named, 1.1 * need);
    EXPECT_FALSE(small_target(named, {{"wall", 1, need}}));
  }
}

}  // namespace
}  // namespace tetwright::small_target_test
