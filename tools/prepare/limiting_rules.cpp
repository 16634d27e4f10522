// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/limiting_rules.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tetwright {

namespace {

// They must fit on one line, and smaller percentages do not help the reader.
constexpr std::size_t max_rules = 3;
constexpr double min_share = 0.05;

constexpr const char* nothing_left = "nothing: no operation was left to try";

bool is_rule(Outcome o) {
  return o != Outcome::done && o != Outcome::conflict && o != Outcome::stale && o != Outcome::no_candidate;
}

std::vector<Operation> all_operations() {
  std::vector<Operation> all;
  for (std::size_t o = 0; o < operation_count; ++o) all.push_back(static_cast<Operation>(o));
  return all;
}

/// Refusals in the last iteration that has any: of the block loop, or of the improvement after it.
std::string last_refusals(const SimplifyReport& report, bool of_loop,
                          const std::vector<Operation>& operations) {
  for (auto it = report.iterations.rbegin(); it != report.iterations.rend(); ++it) {
    if ((it->kind == "simplify") != of_loop) continue;
    if (std::string rules = main_refusals(it->counts, operations); !rules.empty()) return rules;
  }
  return {};
}

}  // namespace

std::string main_refusals(const OperationCounts& counts, const std::vector<Operation>& operations) {
  std::vector<std::pair<std::uint64_t, std::size_t>> rules;
  std::uint64_t all = 0;
  for (std::size_t r = 0; r < outcome_count; ++r) {
    if (!is_rule(static_cast<Outcome>(r))) continue;
    std::uint64_t refused = 0;
    for (const Operation o : operations) refused += counts.of(o, static_cast<Outcome>(r));
    all += refused;
    if (refused) rules.push_back({refused, r});
  }
  std::sort(rules.begin(), rules.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  std::string text;
  for (std::size_t i = 0; i < std::min(rules.size(), max_rules); ++i) {
    const double share = static_cast<double>(rules[i].first) / static_cast<double>(all);
    if (i > 0 && share < min_share) break;
    text += (i ? ", " : "") + std::string(outcome_names[rules[i].second]) + " " +
            std::to_string(std::lround(100 * share)) + " %";
  }
  return text;
}

std::string rules_limiting_count(const SimplifyReport& report, int max_iterations) {
  if (report.out_of_time) return "--time-limit";
  const auto iterations = std::count_if(report.iterations.begin(), report.iterations.end(),
                                        [](const IterationReport& it) { return it.kind == "simplify"; });
  const std::string rules = last_refusals(report, true, {Operation::collapse});
  if (iterations < max_iterations) return rules.empty() ? nothing_left : rules;
  return "max_iterations (all " + std::to_string(max_iterations) + " were used)" +
         (rules.empty() ? "" : "; " + rules);
}

std::string rules_limiting_shapes(const SimplifyReport& report) {
  if (report.out_of_time) return "--time-limit";
  std::string rules = last_refusals(report, false, all_operations());
  if (rules.empty()) rules = last_refusals(report, true, all_operations());
  return rules.empty() ? nothing_left : rules;
}

}  // namespace tetwright
