// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/types.h"

namespace tetwright {

/// The working coordinates of an EditableMesh: input coordinates after a shift and a scaling by a power of
/// two, both exact for every point of the input.
class WorkingSpace {
 public:
  WorkingSpace() = default;
  /// Shifts along each axis on which the differences from the lowest coordinate are exact for all points (a
  /// body far away then has as many bits to move in as one at the origin, and one that was moved exactly gets
  /// the same working coordinates), and scales the largest coordinate to [1, 2). The points
  /// must be finite; where their differences overflow, valid() is false.
  static WorkingSpace of(const std::vector<Vec3>& points);

  bool valid() const { return scale_ > 0; }
  /// Lengths in working coordinates are input lengths times this power of two.
  double scale() const { return scale_; }
  Vec3 to_input(const Vec3& working) const;
  Vec3 to_working(const Vec3& input) const;
  /// The position that a point moved to `working` really gets: on a lattice of 2^-30 (about 1e-9 of the
  /// mesh's size), and where that has no exact input coordinates, the nearest position that has. So signs
  /// hold for the coordinates as written, and a mesh that was moved far away gives the same result.
  Vec3 snap(const Vec3& working) const;

 private:
  double scale_ = 1;
  Vec3 shift_ = Vec3::Zero();  ///< input coordinates
};

}  // namespace tetwright
