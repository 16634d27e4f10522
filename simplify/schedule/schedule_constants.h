// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tetwright {

/// Share of the tets by which the closing may leave the target count: collapses are what removes the last
/// slivers on flat boundaries. Keeps the count well within 1 %.
inline constexpr double closing_slack = 0.006;

// What both schedules share with the paper, or with what it leaves open.

inline constexpr double percent_step = 10;  ///< by which the share of bad tets grows each iteration
/// Initial probability of an action that leaves a worse tet, where the paper allows such "early in
/// computation": p0 of p0 ln(n/N) / ln(n0/N).
inline constexpr double first_annealing = 0.3;
/// E stops growing here, in working coordinates, in which every point is nearer than 2 to the origin along
/// each axis, for gamma 10: beyond it nothing is refused any more.
inline constexpr double max_useful_error = 200;
/// Consecutive iterations that each remove less than this share of the tets before a loop ends.
inline constexpr int max_idle_iterations = 3;
inline constexpr double idle_below = 0.003;

}  // namespace tetwright
