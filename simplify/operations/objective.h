#pragma once

#include <cstdint>

#include "common/geometry/quality.h"

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

  float operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    return static_cast<float>(unsigned_value(a, b, c, d));
  }
  /// The maximum for a tet of six times this volume, rounded up.
  float max_for_volume(double det) const {
    return kind == Kind::paper ? static_cast<float>(quality.max_for_volume(det)) : 1;
  }
  /// Below 0 for a flat or negative tet, the lower the worse it is: shows the way out of inversion.
  float signed_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    return static_cast<float>(precise_signed_value(a, b, c, d));
  }
  /// signed_value() unrounded, for gradients by finite differences.
  double precise_signed_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;

 private:
  double unsigned_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
    return kind == Kind::paper ? quality.cubed(a, b, c, d) : shape_quality(shape, a, b, c, d);
  }
};

}  // namespace tetwright
