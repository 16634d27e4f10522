// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "simplify/simplify.h"

namespace tetwright {

/// The rules that refused most attempts of `operations`, each with its share of all refusals, such as
/// "link_condition 61 %, surface_error 30 %": at most three, of which all but the first have a share of at
/// least 5 %. Conflicts between threads and elements without a candidate are not refusals. Empty if no rule
/// refused anything.
std::string main_refusals(const OperationCounts& counts, const std::vector<Operation>& operations);

/// Why the count of tets stayed above its target: the refusals of collapses in the last iteration of the
/// block loop that has any, and `max_iterations` if the loop used them all.
std::string rules_limiting_count(const SimplifyReport& report, int max_iterations);

/// Why badly shaped tets are left: the refusals of all operations in the last round of improvement that has
/// any, or else in the last such iteration of the block loop.
std::string rules_limiting_shapes(const SimplifyReport& report);

}  // namespace tetwright
