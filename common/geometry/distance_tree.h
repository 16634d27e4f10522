// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/geometry/reference_tree.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Exact distances from triangles of any shape. Accepts any finite coordinates and any defects.
///
/// Immutable after construction; all functions may be called concurrently. Built in O(n log n); the result
/// does not depend on the number of threads. About 100 bytes for each triangle and 130 for
/// each part of one (split_references()).
class DistanceTree {
 public:
  /// Copies its input. Distances are in the unit of `points`.
  DistanceTree(std::span<const Vec3> points, std::span<const Triangle> triangles);

  /// Distance from the nearest triangle, or `at_most` if none is nearer.
  double distance(const Vec3& p, double at_most) const;

 private:
  double scale_ = 1;  ///< power of two; the members below are in units of 1 / scale_
  ReferenceTree tree_;
  std::vector<std::array<Vec3, 3>> triangles_;
  std::vector<Vec3> normals_;  ///< unit; zero for triangles so thin that rounding changes it
};

/// Power of two that scales the longest side of the triangles' box to about 1, so that products of up to nine
/// lengths neither overflow nor underflow.
double unit_scale(std::span<const Vec3> points, std::span<const Triangle> triangles);

}  // namespace tetwright
