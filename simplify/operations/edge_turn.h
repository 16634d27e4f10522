// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/workspace.h"

namespace tetwright {

/// Whether the proposal would make tets overlap around one of its edit's narrow edges, where their dihedral
/// angles would then sum to more than a full turn. A surface around a cavity of few triangles can turn inside
/// out without an intersection of triangles, while all tets stay positive.
///
/// Adds the ends whose stars it reads to the proposal's read set.
/// \pre The proposal is complete.
bool folds_over(Workspace& ws);

}  // namespace tetwright
