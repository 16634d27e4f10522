// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "common/io/names/mesh_parts.h"
#include "common/mesh/boundary_groups.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Physical groups of a mesh in MSH files.
struct MshGroups {
  explicit MshGroups(const TetMesh& mesh);

  BoundaryGroups faces;
  /// Names by tag, for materials that have one. Different names stay different, equal names stay equal.
  std::map<MaterialTag, std::string> material_names;
  /// Unique names by group number, for groups that have one.
  std::map<std::int64_t, std::string> face_names;
};

/// Bins as physical groups, with numbers that no material has.
std::vector<BinDivision> msh_bins(const TetMesh& mesh, std::span<const TetBins> divisions);

/// Groups for name_changes(): tags of materials are kept; comments give those that the format cannot hold.
MeshParts msh_parts(const TetMesh& mesh);

}  // namespace tetwright
