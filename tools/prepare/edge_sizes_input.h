// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/geometry/box_tree.h"
#include "tetwright/prepare_steps.h"

namespace tetwright {

/// Puts the size field, its bounds and its grading into `run.report.sizes`; `box` is that of the input.
/// Throws UsageError for bounds that contradict each other and what read_size_field() throws.
void read_sizes(PrepareRun& run, const Box3& box);

/// Throws InputError about a size field that does not reach all of these places of the body.
void require_sizes_at(const PrepareRun& run, const std::vector<Vec3>& places);

}  // namespace tetwright
