// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tetwright/mesher.h"
#include "tetwright/prepare_steps.h"

namespace tetwright {

/// Says that a target is too small, with the number that holds the materials; nothing if it is large enough
/// or the estimate too small to be reliable.
std::optional<Diagnostic> small_target(double target, const std::vector<MinTets>& needs);

/// Whether the number of tets is that of the target: no other option decides it or leaves thin parts out.
bool target_decides(const PrepareRun& run);

/// Puts the needs of the materials into the report. If the target is too small for them, announces that
/// before the work begins and reports it.
void compare_with_target(std::vector<MinTets> needs, PrepareRun& run);

/// Removes the report of a small target if the result is good, or shows better what it takes.
/// \param target_slack share of the target by which the result may miss it
/// \param poor_percent tets below the bound from which on shapes are poor
/// \pre `run.report` has the statistics of the result
void settle_small_target(PrepareRun& run, double target_slack, double poor_percent);

}  // namespace tetwright
