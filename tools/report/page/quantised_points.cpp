// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page/quantised_points.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/box_tree.h"
#include "tools/report/page/little_endian.h"

namespace tetwright {

QuantisedPoints quantise(std::span<const Vec3> points) {
  QuantisedPoints out;
  if (points.empty()) return out;
  Box3 box;
  for (const Vec3& p : points) box.add(p);
  out.origin = box.low;
  // Halves, as the difference of the largest doubles would overflow.
  const double half_side = (box.high / 2 - box.low / 2).maxCoeff();
  if (half_side > 0) out.step = std::max(half_side / QuantisedPoints::max_coordinate * 2, 0x1p-1022);
  out.bytes.reserve(6 * points.size());
  for (const Vec3& p : points)
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = (p[axis] / 2 - out.origin[axis] / 2) / out.step * 2;
      append_little_endian(
          out.bytes,
          static_cast<std::uint32_t>(std::lround(std::min(steps, QuantisedPoints::max_coordinate))), 2);
    }
  return out;
}

}  // namespace tetwright
