// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/workspace.h"

namespace tetwright {

/// Whether the proposal would make tets overlap around one of its edit's narrow edges, so that their dihedral
/// angles sum to more than a full turn. The surface of a cavity with few triangles can turn inside out
/// without intersections of triangles, while all tets stay positive.
///
/// Adds the ends whose stars it reads to the proposal's read set.
/// \pre The proposal is complete.
bool folds_over(Workspace& ws);

}  // namespace tetwright
