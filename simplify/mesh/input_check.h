// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Checks that the arrays of a caller's mesh fit together: a material for each tet, indices in range, and a
/// value of each field, and of `frozen` unless it is empty, for each tet or point. Parallel.
/// \param name the mesh's name in messages
/// \throws InputError naming the first array or tet that does not fit
/// \throws UsageError if the size of `frozen` is wrong
void check_arrays(const TetMesh& mesh, const std::vector<std::uint8_t>& frozen, const std::string& name);

/// Checks that a caller's mesh has tets, that its arrays fit together, and that the memory suffices to work
/// on it. Parallel.
/// \throws InputError and UsageError as check_arrays(), InputError if there are no tets
/// \throws OutputError if the memory does not suffice
void check_mesh(const TetMesh& mesh, const std::vector<std::uint8_t>& frozen, const std::string& name);

}  // namespace tetwright
