// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/gap_opening.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace tetwright {

namespace {

/// Cells to a gap that stays open wherever it lies, with a margin, and dense tets for each squared finest
/// cell of its area, on both sides (both by DistanceTuning, and measured on boxes .01 apart: 45 to 60).
constexpr double cells_to_width = 1.25 * 1.02, tets_per_squared_cell = 60;
/// Share of the bounds that is counted with: other parts may be thin, too, but areas are 15 % too large.
constexpr double budget_share = 0.95;
/// Growth of the targets that are tried, the largest one, and how often cells are chosen for one of them.
constexpr double target_growth = 1.03, max_target = 1e7;
constexpr int max_tries = 8;
/// A target whose cells depend on no bound.
constexpr double typical_target = 10000;
/// Tets that count as cheap at any target (CellTuning::WallBudget).
constexpr double cheap_tets = 1e6;

/// Halvings of cells that open a gap; more than max_wall_refinement if none do.
int halvings(double cell, double width) {
  int count = 0;
  for (; count <= max_wall_refinement && cells_to_width * cell > width; ++count) cell /= 2;
  return count;
}

/// Rounded up to two digits, as people write them.
std::size_t rounded_up(double target) {
  const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(target)) - 1));
  return static_cast<std::size_t>(std::ceil(target / unit) * unit);
}

}  // namespace

GapOpening find_gap_opening(const MesherInput& surfaces, const MesherReport& report,
                            const PrepareOptions& options) {
  const auto is_meant = [](const ClosedGapReport& g) { return g.gap && !g.on_purpose && g.width > 0; };
  if (std::none_of(report.closed_gaps.begin(), report.closed_gaps.end(), is_meant)) return {};
  // The halvings and tets that all gaps need with cells of this size.
  const auto need = [&](double cell) {
    std::pair<int, double> sum{0, 0};
    for (const ClosedGapReport& g : report.closed_gaps) {
      if (!is_meant(g)) continue;
      const int count = halvings(cell, g.width);
      const double finest = std::ldexp(cell, -count);
      sum.first = std::max(sum.first, count);
      sum.second += tets_per_squared_cell * g.area / (finest * finest);
    }
    return sum;
  };
  const double base = static_cast<double>(report.estimate.tets);
  const CellOptions& cells = options.cells;
  const TargetOptions& target = options.target;
  if (target.tets && !cells.resolution && !cells.size && !cells.max_refinement) {
    double length = 0;
    for (int k = 0; k < 3; ++k) length = std::max(length, surfaces.high[k] - surfaces.low[k]);
    const double now = static_cast<double>(*target.tets);
    const auto opens = [&](double cell, double tets) {
      const auto [count, added] = need(cell);
      const double allowed = thin_tets_of_target(tets);
      const double cheap = std::max(std::min(cheap_tets, allowed), base * tets / now);
      const double limit = std::max(cheap, allowed);
      return count <= max_wall_refinement &&
             added <= budget_share * (count > default_wall_refinement ? cheap : limit);
    };
    // Cells are about proportional to the root of the target, where that is not small; choosing them takes
    // the patches of the surface.
    const double known = std::max(now, typical_target);
    const auto cell_for = [&](double tets) {
      return length / resolution_for_target(surfaces, static_cast<std::size_t>(tets), options.feature_angle);
    };
    const double known_cell = cell_for(known);
    int tries = 0;
    for (double tets = target_growth * now; tets <= max_target && tries < max_tries; tets *= target_growth) {
      if (!opens(known_cell * std::sqrt(known / tets), tets)) continue;
      ++tries;
      const std::size_t rounded = rounded_up(tets);
      if (opens(cell_for(static_cast<double>(rounded)), static_cast<double>(rounded))) return {rounded, {}};
    }
    return {};
  }
  const auto [count, added] = need(report.cell_size);
  const bool is_raised = count > cells.max_refinement.value_or(default_wall_refinement);
  if (cells.uniform || !is_raised || count > max_wall_refinement) return {};
  if (added > budget_share * std::max(max_thin_tets, base)) return {};
  return {{}, count};
}

}  // namespace tetwright
