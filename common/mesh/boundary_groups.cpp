// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/boundary_groups.h"

#include <limits>
#include <set>

namespace tetwright {

BoundaryGroups::BoundaryGroups(const TetMesh& mesh) {
  std::set<MaterialPair> pairs;
  std::set<SurfaceRegion> of_user;
  const auto group_of = [&](const InterfacePatch& patch) {
    const auto known = mesh.patch_groups.find(patch);
    return known == mesh.patch_groups.end() ? SurfaceRegion{} : known->second;
  };
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (!of_patch_.try_emplace({t.pair(), t.patch}, 0).second) continue;
    if (const SurfaceRegion group = group_of({t.pair(), t.patch}))
      of_user.insert(group);
    else
      pairs.insert(t.pair());
  }
  // Group numbers in files are signed 32-bit integers.
  constexpr std::int64_t max_number = std::numeric_limits<std::int32_t>::max();
  std::set<std::int64_t> taken;
  for (const SurfaceRegion& group : of_user)
    if (group.number <= max_number) taken.insert(group.number);
  std::int64_t next = 0;
  const auto free_number = [&] {
    while (taken.contains(++next)) {
    }
    return next;
  };
  std::map<MaterialPair, std::size_t> of_pair;
  std::map<SurfaceRegion, std::size_t> of_group;
  for (const MaterialPair& pair : pairs) {
    of_pair[pair] = groups_.size();
    groups_.push_back({free_number(), {}, pair});
  }
  std::set<std::int64_t> given;
  for (const SurfaceRegion& group : of_user) {
    of_group[group] = groups_.size();
    const bool keeps = group.number > 0 && group.number <= max_number && given.insert(group.number).second;
    groups_.push_back({keeps ? group.number : free_number(), group, {}});
  }
  for (auto& [patch, index] : of_patch_) {
    const SurfaceRegion group = group_of(patch);
    index = group ? of_group.at(group) : of_pair.at(patch.first);
  }
}

}  // namespace tetwright
