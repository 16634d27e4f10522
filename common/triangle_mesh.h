#pragma once

#include <vector>

#include "common/types.h"

namespace tetwright {

/// A triangle surface as read from a file: no promise about orientation, closedness or unused points.
struct TriangleMesh {
  std::vector<Vec3> points;  ///< input units
  std::vector<Triangle>
      triangles;  ///< indices into points; counter-clockwise seen from outside where it is closed
};

}  // namespace tetwright
