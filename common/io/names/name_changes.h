// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/tet_mesh.h"

namespace tetwright {

struct MeshParts;

/// A number or name of the input and its replacement in a file, as text; names are in quotes.
struct NameChange {
  std::string own, written;
};

/// Numbers and names of the input that a format cannot hold unchanged. Names that writers invent where there
/// is none are not among them.
struct NameChanges {
  std::vector<NameChange> tags, material_names, patch_numbers, patch_names, fields;
};

/// Changes between the mesh and `written`, the materials and surfaces in the format.
NameChanges name_changes(const TetMesh& mesh, const MeshParts& written);

/// Appends the fields whose names differ in `written`, which has one for each.
void add_field_changes(const std::vector<MeshField>& fields, const std::vector<std::string>& written,
                       std::vector<NameChange>& changes);

}  // namespace tetwright
