// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "common/surface_region.h"

namespace tetwright {

/// Whether a face property or cell field of this name tells parts of a surface apart: no format says which
/// does, these are the names that programs write.
inline bool is_face_label(std::string_view name) {
  constexpr std::array<std::string_view, 19> names{
      "label",          "labels",     "patch",       "patch_id",  "f:patch_id", "PatchID", "group",
      "group_id",       "GroupIds",   "region",      "region_id", "RegionId",   "segment", "segment_id",
      "material_index", "MaterialID", "ModelFaceID", "medit:ref", "surface"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Numbers that label faces, as groups.
class LabelGroups {
 public:
  /// The index of a label's group. The label 0 is none.
  std::uint32_t index_of(std::int64_t label) {
    const auto [known, added] = indices_.emplace(label, static_cast<std::uint32_t>(groups_.size()));
    if (added) groups_.push_back({label, {}});
    return known->second;
  }
  const std::vector<SurfaceRegion>& groups() const { return groups_; }

 private:
  std::map<std::int64_t, std::uint32_t> indices_;
  std::vector<SurfaceRegion> groups_;
};

/// Numbers that label the groups in a file: their own, where these are above 0, of 32 bits and no two alike,
/// else their places, from 1 on.
inline std::vector<std::int32_t> labels_of(const std::vector<SurfaceRegion>& groups) {
  std::vector<std::int32_t> own, places;
  for (const SurfaceRegion& group : groups) {
    if (group.number > 0 && group.number <= std::numeric_limits<std::int32_t>::max())
      own.push_back(static_cast<std::int32_t>(group.number));
    places.push_back(static_cast<std::int32_t>(places.size()) + 1);
  }
  return std::set<std::int32_t>(own.begin(), own.end()).size() == groups.size() ? own : places;
}

}  // namespace tetwright
