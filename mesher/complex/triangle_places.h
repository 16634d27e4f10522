// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/box_tree.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Finds triangles by position. Keeps the triangles' corners, so that these may change later.
class TrianglePlaces {
 public:
  struct Place {
    Index triangle;  ///< the first of equally near ones
    Vec3 point;      ///< its nearest point
  };

  TrianglePlaces(const std::vector<Vec3>& points, std::span<const Triangle> triangles);

  /// The nearest triangle within a distance, in the unit of points.
  std::optional<Place> nearest(const Vec3& p, double max_distance) const;
  /// Triangles whose boxes meet a box that grows by a margin, ascending.
  std::vector<Index> in_box(Box3 box, double margin) const;

 private:
  std::vector<std::array<Vec3, 3>> corners_;
  std::vector<Box3> boxes_;
  std::vector<Index> order_;
  BoxTree tree_;
};

}  // namespace tetwright
