#pragma once

#include <cstddef>

#include "common/features/surface_patches.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// The creases and corners of an input beside those of the mesh made of it.
struct CreaseFidelity {
  double diagonal = 0;              ///< of the bounding box of the mesh, input units, as all lengths
  double length = 0;                ///< of the input's creases
  double max_distance = 0;          ///< of a place on them from the mesh's creases
  double p99_distance = 0;          ///< that 99 % of them are within
  Vec3 place = Vec3::Zero();        ///< the farthest one
  std::size_t corners = 0;          ///< of the input
  double max_corner_distance = 0;   ///< of one of them from the nearest point of the mesh's boundary
  std::size_t lost_corners = 0;     ///< farther than 0.1 % of the diagonal
  Vec3 lost_corner = Vec3::Zero();  ///< the first one

  /// All creases within 0.5 % of the diagonal and all corners within 0.1 %.
  bool same() const;
};

/// Compares 2,000 places to the diagonal. `mesh` has its interfaces with their patches.
CreaseFidelity compare_creases(const CreaseCurves& expected, const TetMesh& mesh);

}  // namespace tetwright
