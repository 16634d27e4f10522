// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/msh_groups.h"

#include <limits>

#include "common/io/tets/msh_data.h"
#include "common/unique_names.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

std::map<MaterialTag, std::string> material_names_to_write(const std::map<MaterialTag, std::string>& names) {
  std::map<MaterialTag, std::string> written;
  std::map<std::string, std::string> written_of;
  UniqueNames unique(msh_name);
  for (const bool unchanged : {true, false})  // unchanged names first, so that they are kept
    for (const auto& [tag, name] : names) {
      if ((msh_name(name) == name) != unchanged) continue;
      const auto [known, added] = written_of.try_emplace(name);
      if (added) known->second = unique.add(name);
      written[tag] = known->second;
    }
  return written;
}

/// Names of the groups. Regions of the input take precedence, and among them those whose names stay
/// unchanged.
std::map<std::int64_t, std::string> group_names_to_write(const BoundaryGroups& groups,
                                                         const std::map<MaterialTag, std::string>& names) {
  std::map<std::int64_t, std::string> written;
  UniqueNames unique(msh_name);
  for (const bool unchanged : {true, false})
    for (const BoundaryGroups::Group& g : groups.all()) {
      const std::string& name = g.surface_region.name;
      if (!name.empty() && (msh_name(name) == name) == unchanged) written[g.number] = unique.add(name);
    }
  // Groups whose numbers cannot be kept.
  for (const BoundaryGroups::Group& g : groups.all())
    if (const SurfaceRegion& of_user = g.surface_region;
        of_user.name.empty() && of_user.number != 0 && of_user.number != g.number)
      written[g.number] = unique.add(std::to_string(of_user.number));
  for (const BoundaryGroups::Group& g : groups.all())
    if (g.pair) written[g.number] = unique.add_pair(pair_name(*g.pair, names));
  return written;
}

}  // namespace

MshGroups::MshGroups(const TetMesh& mesh)
    : faces(mesh),
      material_names(material_names_to_write(mesh.material_names)),
      face_names(group_names_to_write(faces, material_names)) {}

std::vector<BinDivision> msh_bins(const TetMesh& mesh, std::span<const TetBins> divisions) {
  return parts_of_bins(
      divisions,
      names_of_parts(mesh, {.form = msh_name, .max_number = std::numeric_limits<MaterialTag>::max()})
          .materials,
      {.form = msh_name, .max_number = std::numeric_limits<MaterialTag>::max()});
}

MeshParts msh_parts(const TetMesh& mesh) {
  const MshGroups groups(mesh);
  const auto name_in = [](const auto& names, auto key) {
    const auto known = names.find(key);
    return known == names.end() ? std::string() : known->second;
  };
  MeshParts parts;
  for (const std::int64_t tag : tags_of(mesh.materials)) {
    const auto own = static_cast<MaterialTag>(tag);
    parts.materials.push_back({own, tag, name_in(groups.material_names, own), {}});
  }
  for (const BoundaryGroups::Group& g : groups.faces.all())
    parts.surfaces.push_back({g.surface_region, g.number, name_in(groups.face_names, g.number), {}});
  return parts;
}

}  // namespace tetwright
