// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "simplify/constraints/edge_sizes.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

/// Quality of a tet for operations: larger is better; 0 means flat or negative and is never accepted.
struct Objective {
  enum class Kind : std::uint8_t {
    paper,  ///< Quality(t)^3: angle, volume and longest edge, relative to the target count
    shape   ///< shape alone, for improvement at a given count
  };
  Kind kind = Kind::paper;
  TetQuality quality{1, 1, 5, 0};
  ShapeObjective shape = ShapeObjective::both;
  /// Kind::paper: target lengths of edges; `quality` is then for their average. Null: the same length
  /// everywhere.
  const EdgeSizes* sizes = nullptr;

  /// Ratio of the target edge length at a point to the average one.
  double scale_at(const Vec3& place) const {
    return sizes->target_length(place) / (SimplifyTuning::EdgeLengths::edge_to_ideal * quality.ideal_edge);
  }

  float operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    return static_cast<float>(unsigned_value(a, b, c, d));
  }
  /// Max value for a tet whose volume is det / 6, rounded up.
  float max_for_volume(double det) const {
    return kind == Kind::paper && !has_target_length() ? static_cast<float>(quality.max_for_volume(det)) : 1;
  }
  /// Like operator(), but below 0 for a flat or negative tet, and lower the worse it is, so that ascent leads
  /// out of inversion.
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
  /// quality.cubed() for the target length at the tet's centroid.
  double sized_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
};

}  // namespace tetwright
