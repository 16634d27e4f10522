// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/io/names/mesh_parts.h"
#include "common/mesh/boundary_groups.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// Physical groups of a mesh in MSH files.
struct MshGroups {
  explicit MshGroups(const TetMesh& mesh);

  BoundaryGroups faces;
  /// Names by tag, of the materials that have one. Different names stay different, and equal ones equal.
  std::map<MaterialTag, std::string> material_names;
  /// Unique names by the groups' numbers, of the groups that have one.
  std::map<std::int64_t, std::string> face_names;
};

/// Groups for name_changes(): tags of materials are kept, by comments if the format cannot hold one.
MeshParts msh_parts(const TetMesh& mesh);

}  // namespace tetwright
