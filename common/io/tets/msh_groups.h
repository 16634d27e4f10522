// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/io/names/mesh_parts.h"
#include "common/mesh/boundary_groups.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// The physical groups of a mesh as MSH files list them.
struct MshGroups {
  explicit MshGroups(const TetMesh& mesh);

  BoundaryGroups faces;
  /// By tag, of the materials that have a name. Names that differ stay different, and equal ones equal.
  std::map<MaterialTag, std::string> material_names;
  /// By the groups' numbers; without those that have no name, and no two are equal.
  std::map<std::int64_t, std::string> face_names;
};

/// The same for name_changes(): tags of materials are kept, by comments where the format cannot hold one.
MeshParts msh_parts(const TetMesh& mesh);

}  // namespace tetwright
