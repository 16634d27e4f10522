// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/working_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tetwright {

namespace {

/// Whether a - b is exact (the error term of Knuth's two-sum).
bool exact_difference(double a, double b) {
  const double x = a - b, b_virtual = a - x, a_virtual = x + b_virtual;
  return (b_virtual - b) + (a - a_virtual) == 0;
}

}  // namespace

WorkingSpace WorkingSpace::of(const std::vector<Vec3>& points) {
  WorkingSpace space;
  for (int axis = 0; axis < 3; ++axis) {
    double low = std::numeric_limits<double>::infinity();
    for (const Vec3& p : points) low = std::min(low, p[axis]);
    if (std::isfinite(low) && std::all_of(points.begin(), points.end(),
                                          [&](const Vec3& p) { return exact_difference(p[axis], low); }))
      space.shift_[axis] = low;
  }
  double largest = 0;
  for (const Vec3& p : points) largest = std::max(largest, (p - space.shift_).cwiseAbs().maxCoeff());
  if (!std::isfinite(largest)) {
    space.scale_ = 0;
  } else if (largest > 0) {
    space.scale_ = std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1000, 1000));
  }
  return space;
}

Vec3 WorkingSpace::to_input(const Vec3& working) const { return working / scale_ + shift_; }

Vec3 WorkingSpace::to_working(const Vec3& input) const { return (input - shift_) * scale_; }

Vec3 WorkingSpace::snap(const Vec3& working) const {
  const Vec3 on_lattice = (working * 0x1p30).array().round().matrix() * 0x1p-30;
  return to_working(to_input(on_lattice));
}

}  // namespace tetwright
