// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <string>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Name of a material: its own, or "material_TAG" if it has none.
inline std::string material_name(const std::map<MaterialTag, std::string>& names, MaterialTag tag) {
  const auto known = names.find(tag);
  return known != names.end() && !known->second.empty() ? known->second : "material_" + std::to_string(tag);
}

/// material_name(), with the tag behind it if another material has the same name: "bone_3".
inline std::string unique_material_name(const std::map<MaterialTag, std::string>& names, MaterialTag tag) {
  const std::string name = material_name(names, tag);
  const auto count =
      std::count_if(names.begin(), names.end(), [&](const auto& n) { return n.second == name; });
  return count > 1 ? name + "_" + std::to_string(tag) : name;
}

}  // namespace tetwright
