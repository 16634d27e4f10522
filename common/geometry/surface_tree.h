// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/geometry/box_tree.h"
#include "common/types.h"

namespace tetwright {

/// A bounding volume hierarchy over triangles: fast generalised winding numbers (Barill et al. 2018, "Fast
/// winding numbers for soups and clouds") and nearest distances. Any finite coordinates, any defects.
///
/// Immutable after construction; all functions may be called concurrently. Built in O(n log n), in parallel,
/// with the same result for any number of threads; about 200 bytes for each triangle.
class SurfaceTree {
 public:
  /// Copies what it needs. `points` and all distances are in the caller's units.
  SurfaceTree(std::span<const Vec3> points, std::span<const Triangle> triangles);

  /// Generalised winding number: 1 well inside a closed surface wound outwards, 0 outside it, in between
  /// around holes; on the surface the mean of both sides. Triangles nearby count exactly, distant groups by
  /// the first three terms of their multipole series: the error is below 0.01, typically 0.002. Points within
  /// some 1e30 times the surface's size from it.
  double winding_number(const Vec3& p) const;

  /// Distance from the nearest triangle, or `at_most` where none is nearer.
  double distance(const Vec3& p, double at_most) const;

 private:
  /// The multipole series of a node of the tree.
  struct Series {
    Vec3 centre;                      ///< area-weighted centre of the triangles
    double far_squared;               ///< from this squared distance on the series is accurate enough
    Vec3 normal;                      ///< sum of area times unit normal
    std::array<double, 6> quadratic;  ///< second and
    std::array<double, 10> cubic;     ///< third moments, coefficients of traceless polynomials
  };

  /// Computes the series of all nodes.
  void make_series();

  double scale_ = 1;  ///< power of two: everything below is in units of 1 / scale_
  BoxTree tree_;
  std::vector<Series> series_;                  ///< of the tree's nodes
  std::vector<std::array<Vec3, 3>> triangles_;  ///< in the order of the tree
};

/// The exact sum of all triangles' solid angles / 4 pi (van Oosterom & Strackee 1983), with the error of
/// rounding alone. O(n).
double winding_number(std::span<const Vec3> points, std::span<const Triangle> triangles, const Vec3& p);

}  // namespace tetwright
