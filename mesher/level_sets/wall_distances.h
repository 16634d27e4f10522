// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "common/geometry/morton.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Replaces the distances of a level set in voxels near thin walls and gaps (see ThinWalls). Lengths are in
/// voxels. All functions may be called concurrently.
class WallDistances {
 public:
  virtual ~WallDistances() = default;

  /// How many times cells are halved at a voxel; -1 if its distances are not replaced.
  virtual int depth(const std::array<int, 3>& voxel) const = 0;
  /// The voxels whose distances are replaced, ascending Morton keys.
  virtual std::vector<MortonKey> covered() const = 0;
  /// The covered voxels that contain a thin wall or gap, ascending.
  virtual const std::vector<MortonKey>& core() const = 0;
  /// The signed distance at a point of a covered voxel, clamped to the band.
  virtual double changed_distance(const Vec3& point, int depth, Vec3& gradient) const = 0;
  /// As above for the true surface, except in closed gaps and omitted walls.
  virtual double true_distance(const Vec3& point, int depth, Vec3& gradient) const = 0;
  /// The thickness of a wall with parallel sides that has a side within a voxel of the point and that cells
  /// of this depth cannot resolve; infinity if there is none.
  virtual double parallel_thickness(const Vec3& point, int depth) const = 0;
};

}  // namespace tetwright
