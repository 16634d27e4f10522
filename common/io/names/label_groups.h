// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Whether a face property or cell field with this name distinguishes parts of a surface. No format specifies
/// such a field; these are the names that programs write.
inline bool is_face_label(std::string_view name) {
  constexpr std::array<std::string_view, 19> names{
      "label",          "labels",     "patch",       "patch_id",  "f:patch_id", "PatchID", "group",
      "group_id",       "GroupIds",   "region",      "region_id", "RegionId",   "segment", "segment_id",
      "material_index", "MaterialID", "ModelFaceID", "medit:ref", "surface"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Groups of faces, from the numbers or names that label the faces.
class LabelGroups {
 public:
  /// Index of the group with this label. The label 0 is the group "none".
  std::uint32_t index_of(std::int64_t label) {
    const auto [known, added] = indices_.emplace(label, static_cast<std::uint32_t>(groups_.size()));
    if (added) groups_.push_back({label, {}});
    return known->second;
  }
  /// Index of the group with this name. The empty name is the group "none".
  std::uint32_t index_of_name(std::string_view name) {
    auto known = named_.find(name);
    if (known == named_.end()) {
      known = named_.emplace(name, static_cast<std::uint32_t>(groups_.size())).first;
      groups_.push_back({0, known->first});
    }
    return known->second;
  }
  const std::vector<SurfaceRegion>& groups() const { return groups_; }

 private:
  std::map<std::int64_t, std::uint32_t> indices_;
  std::map<std::string, std::uint32_t, std::less<>> named_;
  std::vector<SurfaceRegion> groups_;
};

/// Numbers that label the groups in a file: the groups' own numbers if all are above 0, have 32 bits and
/// differ; otherwise their positions in the list, from 1 on.
inline std::vector<std::int32_t> labels_of(const std::vector<SurfaceRegion>& groups) {
  std::vector<std::int32_t> own, positions;
  for (const SurfaceRegion& group : groups) {
    if (group.number > 0 && group.number <= std::numeric_limits<std::int32_t>::max())
      own.push_back(static_cast<std::int32_t>(group.number));
    positions.push_back(static_cast<std::int32_t>(positions.size()) + 1);
  }
  return std::set<std::int32_t>(own.begin(), own.end()).size() == groups.size() ? own : positions;
}

}  // namespace tetwright
