// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/tet_mesh.h"

namespace tetwright {

/// Faces between two materials and on the boundary, in ascending order of their sorted ids, each listed from
/// its smallest id on. A face of more than two tets, which only a broken mesh has, is left out: it has no two
/// sides. Parallel; the result does not depend on the number of threads.
/// \param candidates a flag for each point: only faces of three flagged points are examined. Time and memory
///   then grow with their number, beside one pass over the tets and 8 bytes for each point. Null: time and
///   memory of mesh_faces()
/// \pre ids in range, a material for each tet; tets positive for correct normals
std::vector<InterfaceTriangle> find_interfaces(const TetMesh& mesh,
                                               const std::vector<std::uint8_t>* candidates = nullptr);

/// Pairs of regions of the triangles, ascending (outside before any tag), each once.
std::vector<MaterialPair> interface_groups(const std::vector<InterfaceTriangle>& triangles);

/// "bone|skin", "bone|outside": names of the materials, or their tags if they have none.
std::string pair_name(const MaterialPair& pair, const std::map<MaterialTag, std::string>& names = {});

}  // namespace tetwright
