// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tetwright {

/// Max relative deviation of the closing from the target count: collapses are what removes the last slivers
/// on flat boundaries. Keeps the count well within 1 %.
inline constexpr double closing_slack = 0.006;

// Constants of both schedules, from the paper or for details that it leaves open.

inline constexpr double percent_step = 10;  ///< increment of the share of bad tets in each iteration
/// Initial probability of an action that leaves a worse tet, where the paper allows such "early in
/// computation": p0 of p0 ln(n/N) / ln(n0/N).
inline constexpr double first_annealing = 0.3;
/// Upper limit of E for gamma 10, in working coordinates, in which every coordinate is below 2 in magnitude:
/// beyond it nothing is refused any more.
inline constexpr double max_useful_error = 200;
/// Max consecutive iterations that each remove less than this share of the tets.
inline constexpr int max_idle_iterations = 3;
inline constexpr double idle_below = 0.003;

}  // namespace tetwright
