// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/tet_mesh.h"

namespace tetwright {

struct MeshParts;

/// What a file has in place of a number or name of the user's, as texts; names are in quotes.
struct NameChange {
  std::string own, written;
};

/// The numbers and names of the user's that a format cannot hold as they are. Those that writers make up,
/// where there is none, are not among them.
struct NameChanges {
  std::vector<NameChange> tags, material_names, patch_numbers, patch_names, fields;
};

/// `written` are the materials and surfaces of the mesh as the format's writer calls them.
NameChanges name_changes(const TetMesh& mesh, const MeshParts& written);

/// Appends the fields whose names are others in `written`, which has one for each.
void add_field_changes(const std::vector<MeshField>& fields, const std::vector<std::string>& written,
                       std::vector<NameChange>& changes);

}  // namespace tetwright
