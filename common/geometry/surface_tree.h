// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/geometry/box_tree.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A bounding volume hierarchy over triangles for fast generalised winding numbers (Barill et al. 2018, "Fast
/// winding numbers for soups and clouds"). Accepts any finite coordinates and any defects; distance_tree.h
/// has distances.
///
/// Immutable after construction; all functions may be called concurrently. Built in O(n log n), in parallel;
/// the result does not depend on the number of threads. About 200 bytes for each triangle.
class SurfaceTree {
 public:
  /// Copies its input.
  SurfaceTree(std::span<const Vec3> points, std::span<const Triangle> triangles);

  /// Generalised winding number: 1 well inside a closed surface oriented outwards, 0 outside, in between
  /// around holes; on the surface the mean of both sides. Nearby triangles are evaluated exactly, distant
  /// groups by the first three terms of their multipole series: error below 0.01, typically 0.002.
  /// \pre distance of `p` from the surface at most about 1e30 times its size
  double winding_number(const Vec3& p) const;

 private:
  /// Multipole series of a node of the tree.
  struct Series {
    Vec3 centre;                      ///< area-weighted centre of the triangles
    double far_squared;               ///< squared distance from which the series is accurate enough
    Vec3 normal;                      ///< sum of area times unit normal
    std::array<double, 6> quadratic;  ///< second moments
    std::array<double, 10> cubic;     ///< third moments; both as coefficients of traceless polynomials
  };

  /// Computes the series of all nodes.
  void make_series();

  double scale_ = 1;  ///< power of two; the members below are in units of 1 / scale_
  BoxTree tree_;
  std::vector<Series> series_;                  ///< by node of the tree
  std::vector<std::array<Vec3, 3>> triangles_;  ///< in tree order
};

/// Sum of all triangles' solid angles / 4 pi (van Oosterom & Strackee 1983), exact up to rounding. O(n).
double winding_number(std::span<const Vec3> points, std::span<const Triangle> triangles, const Vec3& p);

}  // namespace tetwright
