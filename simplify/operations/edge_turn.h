// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/workspace.h"

namespace tetwright {

/// Whether the proposal, which is complete, would leave tets that overlap around one of its edit's narrow
/// edges: their dihedral angles there are more than a full turn. A surface that closes around a cavity of few
/// triangles can be turned inside out without any two of them meeting, and all tets stay positive.
///
/// Adds the ends whose stars it reads to the proposal's read set.
bool folds_over(Workspace& ws);

}  // namespace tetwright
