// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/surface_region.h"
#include "common/types.h"

namespace tetwright {

/// A triangle surface as read from a file: no promise about orientation, closedness or unused points.
struct TriangleMesh {
  std::vector<Vec3> points;  ///< input units
  std::vector<Triangle>
      triangles;  ///< indices into points; counter-clockwise seen from outside where it is closed
  /// Regions that the file distinguishes, and the index of each triangle's region; both empty if it
  /// distinguishes none. One entry may be no region.
  std::vector<SurfaceRegion> groups = {};
  std::vector<std::uint32_t> triangle_groups = {};
};

struct NamedSurface {
  std::string name;
  TriangleMesh surface;
};

}  // namespace tetwright
