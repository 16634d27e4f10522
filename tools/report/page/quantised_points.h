// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Points in 16-bit coordinates: origin + step * (x, y, z), with one step for all axes to keep proportions.
/// The max error of a coordinate is half a step, about 1 / 131,000 of the longest side of their box.
struct QuantisedPoints {
  static constexpr double max_coordinate = 65535;

  Vec3 origin = Vec3::Zero();  ///< the lowest corner of the box, input units
  double step = 1;             ///< input units, above 0
  std::string bytes;           ///< x, y and z of each point, 16 bits each, little-endian
};

/// \pre All points are finite.
QuantisedPoints quantise(std::span<const Vec3> points);

}  // namespace tetwright
