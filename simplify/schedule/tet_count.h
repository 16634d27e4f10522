// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/constraints/edge_sizes.h"
#include "simplify/mesh/editable_mesh.h"

namespace tetwright {

/// Number of well-shaped tets with edges of one length, input units, that fill the mesh.
double tets_for_edge(const EditableMesh& mesh, double length);
/// Number of well-shaped tets with the target edge lengths that fill the mesh.
/// \pre sizes.has_target_length().
double tets_for_sizes(const EditableMesh& mesh, const EdgeSizes& sizes);

}  // namespace tetwright
