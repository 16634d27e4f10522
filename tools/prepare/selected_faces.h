// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/prepare.h"
#include "tetwright/prepare_steps.h"

namespace tetwright {

/// Makes the sets of PrepareOptions::selections groups of the result's boundary, and reports them. The
/// interfaces of the result are those before any is parted.
void select_faces_of(Prepared& result, PrepareRun& run);

}  // namespace tetwright
