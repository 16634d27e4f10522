// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/geometry/box_tree.h"
#include "tools/app/commands/command_run.h"

namespace tetwright {

/// What --size-field, --min-edge, --max-edge and --grading ask for, put into `run.sizes`; `box` and
/// `diagonal` are those of the input. Throws UsageError for bounds that contradict each other and what
/// read_size_field() throws.
void read_sizes(CommandRun& run, const Box3& box);

/// Throws InputError about a size field that does not reach all of these places of the body.
void require_sizes_at(const CommandRun& run, const std::vector<Vec3>& places);

}  // namespace tetwright
