// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/geometry/box_tree.h"
#include "tetwright/prepare_steps.h"

namespace tetwright {

/// Reads the size field with its bounds and grading into `run.report.sizes`.
///
/// \param box bounding box of the input
/// \throws UsageError if the bounds contradict each other
/// \throws Error in the cases of read_size_field()
void read_sizes(PrepareRun& run, const Box3& box);

/// Checks that the size field covers these points of the body.
///
/// \throws InputError if it does not
void require_sizes_at(const PrepareRun& run, const std::vector<Vec3>& places);

}  // namespace tetwright
