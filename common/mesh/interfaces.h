// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/tet_mesh.h"

namespace tetwright {

/// The faces between two materials and those on the boundary, in ascending order of their sorted ids, each
/// listed from its smallest id on. Tets must be positive for the normals to be right, and ids in range; each
/// tet must have a material. A face of more than two tets, which only a broken mesh has, is left out: it has
/// no two sides.
///
/// With `candidates`, a flag for each point, only faces of three flagged points are looked at; time and
/// memory grow with their number then, beside one look at every tet and 8 bytes for each point. Without, as
/// mesh_faces(). Parallel; the result does not depend on the threads.
std::vector<InterfaceTriangle> find_interfaces(const TetMesh& mesh,
                                               const std::vector<std::uint8_t>* candidates = nullptr);

/// The pairs of regions there are, ascending (outside before any tag), each once.
std::vector<MaterialPair> interface_groups(const std::vector<InterfaceTriangle>& triangles);

/// "bone|skin", "bone|outside": names of the materials, or their tags where there is no name.
std::string pair_name(const MaterialPair& pair, const std::map<MaterialTag, std::string>& names = {});

}  // namespace tetwright
