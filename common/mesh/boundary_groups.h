// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Groups in which files list the faces of the boundary and the interfaces: the regions of the input, and
/// pairs of materials for faces without a region.
class BoundaryGroups {
 public:
  struct Group {
    std::int64_t number;               ///< above 0, unique
    SurfaceRegion surface_region;      ///< region of the input; none for a pair
    std::optional<MaterialPair> pair;  ///< for faces in no region
  };

  /// Regions keep their numbers if these are free and from 1 to 2^31 - 1. Pairs then get the smallest free
  /// numbers in ascending order (outside before any tag), followed by regions without a number.
  explicit BoundaryGroups(const TetMesh& mesh);

  /// Pairs in ascending order, then regions; only groups that have faces.
  const std::vector<Group>& all() const { return groups_; }
  /// Number of the group that contains a face of the mesh.
  std::int64_t number_of(const InterfaceTriangle& face) const {
    return groups_[of_patch_.at({face.pair(), face.patch})].number;
  }

 private:
  std::vector<Group> groups_;
  std::map<InterfacePatch, std::size_t> of_patch_;
};

}  // namespace tetwright
