// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The working coordinates of an EditableMesh: input coordinates after a shift and a scaling by a power of
/// two, both exact for every point of the input.
class WorkingSpace {
 public:
  WorkingSpace() = default;
  /// Chooses the shift and the scale. An axis is shifted by its lowest coordinate if all differences from it
  /// are exact. A body far from the origin then has the same resolution as one at the origin, and an exactly
  /// translated body gets the same working coordinates. The scale brings the largest coordinate into [1, 2).
  /// If differences overflow, valid() is false.
  /// \pre The points are finite.
  static WorkingSpace of(const std::vector<Vec3>& points);

  bool valid() const { return scale_ > 0; }
  /// Ratio of working to input lengths, a power of two.
  double scale() const { return scale_; }
  Vec3 to_input(const Vec3& working) const;
  Vec3 to_working(const Vec3& input) const;
  /// Rounds a position to a lattice of spacing 2^-30 (about 1e-9 of the mesh's size), then to the nearest
  /// position with exact input coordinates. Orientation signs therefore hold for the coordinates as written,
  /// and a mesh that was moved far away gives the same result.
  Vec3 snap(const Vec3& working) const;

 private:
  double scale_ = 1;
  Vec3 shift_ = Vec3::Zero();  ///< input coordinates
};

}  // namespace tetwright
