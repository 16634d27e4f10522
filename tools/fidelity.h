#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/tet_mesh.h"
#include "mesher/mesher.h"

namespace tetwright {

/// What is compared of a solid.
struct SolidNumbers {
  double volume = 0;  ///< input units cubed
  std::size_t components = 0, cavities = 0;
  std::ptrdiff_t handles = 0;
};

/// A material of a mesh beside the solid that it is meant to be.
struct MaterialFidelity {
  std::string name;
  MaterialTag tag = 0;
  bool by_surface = true;  ///< as in ExpectedSolid
  SolidNumbers expected, result;
  /// "256 handles instead of 0, volume 3.1 % less"; empty where the solid is the same.
  std::string difference;
  std::optional<Vec3> place;  ///< of the largest shell without a counterpart, input units

  bool same() const { return difference.empty(); }
  bool same_counts() const {
    return expected.components == result.components && expected.handles == result.handles &&
           expected.cavities == result.cavities;
  }
};

/// Whether a volume is within 1 % of the one that is meant.
bool is_same_volume(double volume, double meant);

/// Compares materials with what they are meant to be: components, handles and cavities must be equal, volumes
/// within 1 %. `mesh` has its interfaces.
std::vector<MaterialFidelity> compare_solids(const std::vector<ExpectedSolid>& expected, const TetMesh& mesh);

}  // namespace tetwright
