// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/io/names/mesh_parts.h"
#include "common/io/tets/msh_data.h"
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

/// Cohesive elements as physical groups, with numbers and names that no other group of tets has.
/// \param physical groups of the tets
/// \param names of these groups
template <class Numbers, class Names>
std::vector<CohesivePart> msh_cohesive(const TetMesh& mesh, const Numbers& physical, const Names& names) {
  if (mesh.wedges.empty()) return {};
  std::set<std::string> taken;
  std::set<std::int64_t> numbers(physical.begin(), physical.end());
  for (const auto& [number, name] : names) {
    taken.insert(name);
    numbers.insert(number);
  }
  return cohesive_parts(mesh, taken, numbers, {.form = msh_name});
}

/// Groups for name_changes(): tags of materials are kept; comments give those that the format cannot hold.
MeshParts msh_parts(const TetMesh& mesh);

}  // namespace tetwright
