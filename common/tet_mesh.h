#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// A tetrahedral mesh of one or more materials: a plain value, the currency between all parts.
///
/// A tet (a, b, c, d) is positive when (b-a) x (c-a) . (d-a) > 0. Readers hand over what the file says;
/// meshes made by mesher/ and simplify/ hold the invariants of mesh_check.h.
struct TetMesh {
  std::vector<Vec3> points;                           ///< input units
  std::vector<Tet> tets;                              ///< indices into points
  std::vector<MaterialTag> materials;                 ///< one tag for each tet
  std::map<MaterialTag, std::string> material_names;  ///< only materials that have a name
};

}  // namespace tetwright
