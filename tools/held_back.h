#pragma once

#include <string>
#include <vector>

#include "simplify/simplify.h"

namespace tetwright {

/// The rules that refused most of what was tried, with their shares of all refusals, such as "link_condition
/// 61 %, surface_error 30 %": at most three, none but the first below 5 %. A taken lock, an element that had
/// changed and one that has no such operation are no rules and count for nothing. Empty where no rule refused
/// anything.
std::string main_refusals(const OperationCounts& counts, const std::vector<Operation>& operations);

/// What kept the count up: the refusals of collapses in the last iteration of the block loop that tried any,
/// and that the loop used up `max_iterations` if it did.
std::string count_held_back_by(const SimplifyReport& report, int max_iterations);

/// What kept poor tets poor: the refusals of all operations in the last round of improvement that tried any;
/// where there is none, of the block loop.
std::string shapes_held_back_by(const SimplifyReport& report);

}  // namespace tetwright
