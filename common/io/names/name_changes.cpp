// SPDX-License-Identifier: Apache-2.0
#include "common/io/names/name_changes.h"

#include "common/io/names/mesh_parts.h"
#include "common/message_text.h"

namespace tetwright {

namespace {

void compare_numbers(std::int64_t own, std::int64_t written, std::vector<NameChange>& changes) {
  if (own != written) changes.push_back({std::to_string(own), std::to_string(written)});
}

void compare_names(const std::string& own, const std::string& written, std::vector<NameChange>& changes) {
  if (own != written) changes.push_back({in_quotes(own), in_quotes(written)});
}

}  // namespace

NameChanges name_changes(const TetMesh& mesh, const MeshParts& written) {
  NameChanges changes;
  for (const MeshParts::Material& m : written.materials) {
    compare_numbers(m.tag, m.number, changes.tags);
    if (const auto own = mesh.material_names.find(m.tag); own != mesh.material_names.end())
      compare_names(own->second, m.name, changes.material_names);
  }
  for (const MeshParts::Surface& s : written.surfaces) {
    if (s.group.number != 0 && s.number != 0)
      compare_numbers(s.group.number, s.number, changes.patch_numbers);
    if (!s.group.name.empty()) compare_names(s.group.name, s.name, changes.patch_names);
  }
  return changes;
}

void add_field_changes(const std::vector<MeshField>& fields, const std::vector<std::string>& written,
                       std::vector<NameChange>& changes) {
  for (std::size_t f = 0; f < fields.size(); ++f) compare_names(fields[f].name, written[f], changes);
}

}  // namespace tetwright
