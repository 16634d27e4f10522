// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "common/types.h"

namespace tetwright {

/// Points as whole numbers of 16 bits: origin + step * (x, y, z), one step for all axes so that shapes stay
/// what they are. No coordinate is off by more than half a step, about 1 / 131,000 of the longest side of
/// their box.
struct QuantisedPoints {
  static constexpr double max_coordinate = 65535;

  Vec3 origin = Vec3::Zero();  ///< the lowest corner of the box, input units
  double step = 1;             ///< input units, above 0
  std::string bytes;           ///< x, y and z of each point, 16 bits each, little-endian
};

/// Points must be finite.
QuantisedPoints quantise(std::span<const Vec3> points);

}  // namespace tetwright
