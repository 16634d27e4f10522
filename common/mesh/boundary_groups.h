// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/tet_mesh.h"

namespace tetwright {

/// The groups in which files list the faces of the boundary and of interfaces: those of the user, and for
/// faces in none of them the pairs of materials.
class BoundaryGroups {
 public:
  struct Group {
    std::int64_t number;               ///< above 0, no two are the same
    SurfaceRegion surface_region;      ///< of the user
    std::optional<MaterialPair> pair;  ///< of faces that are in no group of the user
  };

  /// Groups of the user keep their numbers where these are free and from 1 to 2^31 - 1. Pairs get the
  /// smallest numbers that are left, in ascending order (outside before any tag), then groups without a
  /// number.
  explicit BoundaryGroups(const TetMesh& mesh);

  /// Pairs in ascending order, then groups of the user; only those that have faces.
  const std::vector<Group>& all() const { return groups_; }
  /// The number of the group that a face of the mesh belongs to.
  std::int64_t number_of(const InterfaceTriangle& face) const {
    return groups_[of_patch_.at({face.pair(), face.patch})].number;
  }

 private:
  std::vector<Group> groups_;
  std::map<InterfacePatch, std::size_t> of_patch_;
};

}  // namespace tetwright
