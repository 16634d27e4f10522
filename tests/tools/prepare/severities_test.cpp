// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare_steps.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

namespace tetwright::severities_test {
namespace {

Severity decided(DiagnosticCode code, const AcceptanceOptions& acceptance, bool on_purpose = false) {
  PrepareReport report;
  report.diagnostics.push_back({.code = code, .file = "a.ply", .what = "things", .count = 2});
  if (on_purpose) {
    report.mesher.emplace();
    report.mesher->closed_gaps.push_back({.name = "a", .on_purpose = true});
  }
  decide_severities(acceptance, report);
  decide_severities(acceptance, report);  // may be called again
  EXPECT_LE(report.diagnostics.size(), 2u);
  return report.diagnostics.front().severity;
}

TEST(Severities, OfEveryKind) {
  for (const DiagnosticKind& kind : diagnostic_kinds()) {
    const bool yields = kind.yields != Yields::never;
    EXPECT_TRUE(!yields || kind.severity == Severity::shortfall) << kind.name;
    if (kind.code == DiagnosticCode::notes_not_allowed) continue;
    EXPECT_EQ(decided(kind.code, {}), kind.severity) << kind.name;
    EXPECT_EQ(decided(kind.code, {.accept_changes = true}), yields ? Severity::note : kind.severity)
        << kind.name;
    EXPECT_EQ(decided(kind.code, {}, true),
              kind.yields == Yields::to_acceptance_or_purpose ? Severity::note : kind.severity)
        << kind.name;
  }
}

TEST(Severities, StrictMakesAShortfallOfNotes) {
  PrepareReport report;
  decide_severities({.strict = true}, report);
  EXPECT_FALSE(report.falls_short());
  report.diagnostics.push_back({.code = DiagnosticCode::points_merged,
                                .file = "a.ply",
                                .what = "points",
                                .count = 2,
                                .done = "merged"});
  decide_severities({}, report);
  EXPECT_FALSE(report.falls_short());
  EXPECT_EQ(notes_of(report), std::vector<std::string>{"a.ply: 2 points (merged)"});
  decide_severities({.strict = true}, report);
  EXPECT_TRUE(report.falls_short());
  EXPECT_EQ(shortfalls_of(report), std::vector<std::string>{"--strict: 1 note: a.ply: 2 points (merged)"});
}

TEST(Severities, EveryCodeIsInTheGuide) {
  std::ifstream in(TETWRIGHT_DATA "/guide/messages.md");
  ASSERT_TRUE(in);
  std::stringstream page;
  page << in.rdbuf();
  for (const DiagnosticKind& kind : diagnostic_kinds())
    EXPECT_NE(page.str().find("| `" + std::string(kind.name) + "` | " + name_of(kind.severity)),
              std::string::npos)
        << "data/guide/messages.md lacks " << kind.name << ", " << name_of(kind.severity) << ": "
        << kind.title;
}

}  // namespace
}  // namespace tetwright::severities_test
