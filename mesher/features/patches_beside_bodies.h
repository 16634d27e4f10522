// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
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
      if (known != patches_.end()) {
        t.patch = known->second;
        continue;
      }
      // Fitting creases may have split a face.
      unsigned planes = ~0u;
      for (const Index p : t.ids) planes &= surface.border_planes(mesh.points[p]);
      t.patch = static_cast<std::uint16_t>(planes == 0 ? 0 : 1 + std::countr_zero(planes));
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
