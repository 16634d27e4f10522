// SPDX-License-Identifier: Apache-2.0
#include "tetwright/diagnostic.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>

namespace tetwright::diagnostic_test {
namespace {

TEST(Diagnostic, CodesAreDistinctWordsWithHyphens) {
  std::set<std::string> names;
  for (const DiagnosticKind& kind : diagnostic_kinds()) {
    EXPECT_TRUE(std::regex_match(kind.name, std::regex("[a-z]+(-[a-z]+)*"))) << kind.name;
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_STRNE(kind.title, "");
    EXPECT_STRNE(kind.cause, "") << kind.name;
    EXPECT_STRNE(kind.remedy, "") << kind.name;
    // Errors that end a run have many messages for one code.
    EXPECT_EQ(std::string(kind.message).empty(), kind.code >= DiagnosticCode::usage) << kind.name;
    EXPECT_EQ(&kind_of(kind.code), &kind);
  }
}

TEST(Diagnostic, BeginsWithTheSeverityOfItsKind) {
  const Diagnostic d{.code = DiagnosticCode::points_merged, .what = "points", .count = 2, .done = "merged"};
  EXPECT_EQ(d.severity, Severity::note);
  EXPECT_EQ(diagnostic_text(d), "2 points (merged)");
  const Diagnostic missed{
      .code = DiagnosticCode::solid_changed, .what = "another solid", .remedy = "finer cells"};
  EXPECT_EQ(missed.severity, Severity::shortfall);
  EXPECT_EQ(diagnostic_text(missed), "another solid; finer cells");
}

}  // namespace
}  // namespace tetwright::diagnostic_test
