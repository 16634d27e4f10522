// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/geometry/quality.h"
#include "simplify/constraints/edge_sizes.h"

namespace tetwright {

/// How good a tet is, for the operations: larger is better; 0 is flat or negative and never accepted.
struct Objective {
  enum class Kind : std::uint8_t {
    paper,  ///< Quality(t)^3: angle, volume and longest edge, with the target count in view
    shape   ///< shape alone: for improving at a count that is reached
  };
  Kind kind = Kind::paper;
  TetQuality quality{1, 1, 5, 0};
  ShapeObjective shape = ShapeObjective::both;
  /// Kind::paper: tets are to have edges of these lengths, with a target length; `quality` is then for the
  /// average of them. Null: all the same.
  const EdgeSizes* sizes = nullptr;

  /// Edges of a mesh of well-shaped tets over the cube root of their average volume: measured of meshes made
  /// for sizes, where the median edge has the wanted length with it.
  static constexpr double edge_to_ideal = 2.1;
  /// The wanted edge length at a place over the average one.
  double scale_at(const Vec3& place) const {
    return sizes->target_length(place) / (edge_to_ideal * quality.ideal_edge);
  }

  float operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    return static_cast<float>(unsigned_value(a, b, c, d));
  }
  /// The maximum for a tet of six times this volume, rounded up.
  float max_for_volume(double det) const {
    return kind == Kind::paper && !has_target_length() ? static_cast<float>(quality.max_for_volume(det)) : 1;
  }
  /// Below 0 for a flat or negative tet, the lower the worse it is: shows the way out of inversion.
  float signed_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    return static_cast<float>(precise_signed_value(a, b, c, d));
  }
  /// signed_value() unrounded, for gradients by finite differences.
  double precise_signed_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;

 private:
  bool has_target_length() const { return sizes && sizes->has_target_length(); }
  double unsigned_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    if (kind == Kind::shape) return shape_quality(shape, a, b, c, d);
    return has_target_length() ? sized_quality(a, b, c, d) : quality.cubed(a, b, c, d);
  }
  /// quality.cubed() for the sizes that are wanted at the tet's centroid.
  double sized_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
};

}  // namespace tetwright
