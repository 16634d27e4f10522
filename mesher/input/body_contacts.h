// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Joins closed bodies that meet: sets MesherInput::complex, contacts and overlaps, and replaces the surfaces
/// of the bodies by what they are in the complex. Nothing changes if no two surfaces come closer than the
/// tolerance.
/// \param progress may be null
/// \throws InputError for surfaces that cannot be joined, a body that the tolerance swallows, and bodies that
///   cross with OverlapRule::error
/// \throws UsageError for a tolerance that is not above 0
/// \throws Interrupted
void join_bodies(MesherInput& input, const ContactOptions& options, Progress* progress);

}  // namespace tetwright
