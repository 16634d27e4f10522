// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tetwright/simplify.h"

namespace tetwright {

/// Rules that refused most attempts of `operations`, with their percentages of all refusals, such as
/// "link_condition 61 %, surface_error 30 %". At most three rules, of which only the first may be below 5 %.
/// Conflicts between threads and elements without a candidate are not counted. Empty if nothing was refused.
std::string main_refusals(const OperationCounts& counts, const std::vector<Operation>& operations);

/// Explains why the number of tets stayed above its target: the refusals of collapses in the last iteration
/// of the block loop that has any, and `max_iterations` if the loop used them all.
std::string rules_limiting_count(const SimplifyReport& report, int max_iterations);

/// Explains why badly shaped tets are left: the refusals of all operations in the last round of improvement
/// that has any, or otherwise in the last such iteration of the block loop.
std::string rules_limiting_shapes(const SimplifyReport& report);

}  // namespace tetwright
