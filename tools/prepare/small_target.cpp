// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/small_target.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>

#include "common/message_text.h"

namespace tetwright {

namespace {

/// Estimates below this say nothing: whether so few tets hold a body depends on its shape more than on its
/// volume and area.
constexpr double min_estimate = 150;
/// Share of the estimate below which a target is too small: rods, and labels of long voxels, hold with a
/// fifth to a quarter less.
constexpr double certain_share = 0.75;
/// Multiple of the estimate above which the number of tets in the result shows more than the estimate.
constexpr double max_reached = 2;
/// Materials with less than this share of the estimate are not named, nor more than so many.
constexpr double named_share = 0.1;
constexpr std::size_t max_named = 3;

/// Rounded up to two digits, so that the number named is enough for the estimate.
std::string two_digits_up(double count) {
  const double unit = std::pow(10.0, std::max(0.0, std::floor(std::log10(count)) - 1));
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", std::ceil(count / unit) * unit);
  return text;
}

double sum_of(const std::vector<MinTets>& needs) {
  double sum = 0;
  for (const MinTets& need : needs) sum += need.tets;
  return sum;
}

std::string two_digits(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", length);
  return text;
}

}  // namespace

std::optional<Diagnostic> small_target(double target, const std::vector<MinTets>& needs) {
  const double all = sum_of(needs);
  if (target >= certain_share * all || all < min_estimate) return {};
  std::vector<MinTets> most = needs;
  std::stable_sort(most.begin(), most.end(),
                   [](const MinTets& a, const MinTets& b) { return a.tets > b.tets; });
  std::string who;
  for (std::size_t i = 0; i < std::min(max_named, most.size()) && most[i].tets >= named_share * all; ++i)
    who += (who.empty() ? "" : ", ") + ("'" + most[i].name + "' " + two_digits_up(most[i].tets)) +
           (2 * most[i].tets_of_parts > most[i].tets
                ? " for the " + std::to_string(most[i].parts) + " parts of its boundary"
                : " at a mean thickness of " + two_digits(most[i].thickness));
  const std::string enough = two_digits_up(all);
  return Diagnostic{.code = DiagnosticCode::target_too_small,
                    .what = "--target-tets " + std::to_string(static_cast<std::size_t>(target)) +
                            " is too small for good shapes: the " +
                            (needs.size() == 1 ? "body takes" : "materials take") + " at least about " +
                            enough + " tets" + (who.empty() ? "" : " (" + printable(who) + ")"),
                    .remedy = "give " + enough + " or more, or leave thin or small parts out",
                    .asked = target};
}

bool target_decides(const PrepareRun& run) {
  const PrepareOptions& options = run.options;
  return run.task == Task::prepare && options.target.tets && !options.sizes.field && !options.cells.min_gap &&
         !options.cells.min_thickness;
}

void compare_with_target(std::vector<MinTets> needs, PrepareRun& run) {
  run.report.min_tets = std::move(needs);
  const std::optional<Diagnostic> found =
      small_target(static_cast<double>(*run.options.target.tets), run.report.min_tets);
  if (!found) return;
  run.progress.announce(found->what + "; " + found->remedy);
  run.report.diagnostics.push_back(*found);
}

void settle_small_target(PrepareRun& run, double target_slack, double poor_percent) {
  PrepareReport& report = run.report;
  const double asked = static_cast<double>(run.options.target.tets.value_or(0)),
               reached = static_cast<double>(report.result->tets);
  // The estimate is of tets above the default bound.
  const bool poor =
      run.options.shapes.bound() <= default_min_solid_angle && report.result->below_percent > poor_percent;
  const bool too_many = reached > (1 + target_slack) * asked;
  // The rule of thin walls names a better number.
  const bool for_walls =
      too_many && report.mesher && static_cast<double>(report.mesher->filling_tets) > asked;
  if ((poor || too_many) && !for_walls && reached <= max_reached * sum_of(report.min_tets)) return;
  std::erase_if(report.diagnostics,
                [](const Diagnostic& d) { return d.code == DiagnosticCode::target_too_small; });
}

}  // namespace tetwright
