// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>

#include "mesher/features/feature_surface.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The patches of faces that are not on bodies: those on the border of a volume. Fitting creases numbers
/// faces anew.
class PatchesBesideBodies {
 public:
  PatchesBesideBodies(const TetMesh& mesh, const FeatureSurface& surface) {
    for (const InterfaceTriangle& t : mesh.interfaces)
      if (t.patch != 0 && surface.is_beside_bodies(t)) patches_[sorted(t.ids)] = t.patch;
  }
  void restore(TetMesh& mesh, const FeatureSurface& surface) const {
    for (InterfaceTriangle& t : mesh.interfaces) {
      if (!surface.is_beside_bodies(t)) continue;
      const auto known = patches_.find(sorted(t.ids));
      t.patch = known == patches_.end() ? std::uint16_t{0} : known->second;
    }
  }

 private:
  static Triangle sorted(Triangle ids) {
    std::sort(ids.begin(), ids.end());
    return ids;
  }
  std::map<Triangle, std::uint16_t> patches_;
};

}  // namespace tetwright
