// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/features/surface_patches.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// The creases and corners of an input beside those of the mesh made of it.
struct CreaseComparison {
  double diagonal = 0;  ///< that shares are of, of the mesh's box, input units, as all lengths
  double length = 0;    ///< of the input's creases
  /// That no place on them is farther than from the mesh's creases: at most 1 % or 1e-9 of the diagonal more
  /// than some place is.
  double max_distance = 0;
  double p99_distance = 0;           ///< that 99 % of them are within
  Vec3 place = Vec3::Zero();         ///< the farthest one
  std::size_t corners = 0;           ///< of the input
  double max_corner_distance = 0;    ///< of one of them from the nearest point of the mesh's boundary
  std::size_t lost_corners = 0;      ///< farther than 0.1 % of the diagonal
  Vec3 lost_corner = Vec3::Zero();   ///< the first one
  Vec3 corner_place = Vec3::Zero();  ///< the farthest one

  /// All creases within 0.5 % of the diagonal and all corners within 0.1 %.
  bool same() const;
};

/// Compares 2,000 places to the diagonal with the segments of all of `found`, and corners with `points`,
/// whatever `found` calls a corner. Distances are infinite where there is nothing to be near.
CreaseComparison compare_creases(const CreaseCurves& expected, const std::vector<CreaseCurves>& found,
                                 std::span<const Vec3> points, double diagonal);

/// The same with the creases and junctions of a mesh and the points of its boundary. `mesh` has its
/// interfaces with their patches; where it has no creases the diagonal stands for their distance.
CreaseComparison compare_creases(const CreaseCurves& expected, const TetMesh& mesh);

}  // namespace tetwright
