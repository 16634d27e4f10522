// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tetwright/parted_interfaces.h"
#include "tetwright/prepare.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Checks InterfaceRequests before any work.
///
/// \throws UsageError if one has no name, or the result would have cohesive elements of second order
void check_parting(const PrepareOptions& options);

/// Parts the interfaces of a result: those requested, and those that were joined in the input. Reports
/// requests without faces, and faces that stay joined. Cohesive ones take precedence, so that those of the
/// input stay.
///
/// \param joined from the input
void part_result(Prepared& result, std::span<const InterfaceToPart> joined, PrepareRun& run);

}  // namespace tetwright
