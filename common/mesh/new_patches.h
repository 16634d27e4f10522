// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <set>

#include "tetwright/error.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Gives out numbers of patches that a pair of materials does not have yet.
class NewPatches {
 public:
  explicit NewPatches(const TetMesh& mesh) {
    for (const InterfaceTriangle& t : mesh.interfaces) use(t.pair(), t.patch);
    for (const auto& [patch, region] : mesh.patch_groups) use(patch.first, patch.second);
  }
  /// \throws OutputError if there is none
  std::uint16_t add(const MaterialPair& pair) {
    std::uint32_t& next = next_.try_emplace(pair, 0).first->second;
    if (next > std::numeric_limits<std::uint16_t>::max())
      throw OutputError(
          "the faces between two materials, or of a boundary, would have more than 65,536 patches; "
          "make fewer sets of faces");
    return static_cast<std::uint16_t>(next++);
  }

 private:
  void use(const MaterialPair& pair, std::uint16_t patch) {
    std::uint32_t& next = next_.try_emplace(pair, 0).first->second;
    next = std::max(next, std::uint32_t{patch} + 1);
  }
  std::map<MaterialPair, std::uint32_t> next_;
};

/// Removes the regions of patches without faces.
inline void drop_unused_groups(TetMesh& mesh) {
  std::set<InterfacePatch> used;
  for (const InterfaceTriangle& t : mesh.interfaces) used.insert({t.pair(), t.patch});
  std::erase_if(mesh.patch_groups, [&](const auto& group) { return !used.contains(group.first); });
}

}  // namespace tetwright
