// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/geometry/reference_tree.h"
#include "common/geometry/surface_tree.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Triangles that close a surface: what they and the surface bound together has a whole winding number at
/// every point off them. The boundary of the surface is divided into closed curves, and every other corner of
/// a curve is cut off by a triangle until two are left, so that triangles are small near the curve. As many
/// as boundary edges at most; they may cross the surface and each other. The result depends on nothing but
/// the input.
std::vector<Triangle> closing_triangles(std::span<const Triangle> triangles);

/// Generalised winding numbers of an open surface, as SurfaceTree has them, in a time that depends on its
/// boundary and little on its triangles: the whole winding number of the surface with closing_triangles(), by
/// the exact crossings of a vertical line, less the winding number of these alone. (Martens & Bessmeltsev
/// 2025, "One-shot method for computing generalized winding numbers", take the boundary's part as an integral
/// along it.) More accurate than SurfaceTree where the boundary is far.
///
/// Immutable after construction; all functions may be called concurrently. Built in O(n log n); about 220
/// bytes per triangle.
class OpenWinding {
 public:
  /// Copies its input. Any finite coordinates and any defects.
  OpenWinding(std::span<const Vec3> points, std::span<const Triangle> triangles);

  /// \pre `p` is not on the surface (there one side's value is returned, not the mean of both)
  double winding_number(const Vec3& p) const;

 private:
  ReferenceTree tree_;
  std::vector<std::array<Vec3, 3>> triangles_;  ///< with the closing ones; empty if the boundary is too long
  SurfaceTree rest_;                            ///< the closing triangles turned over, or the whole surface
};

}  // namespace tetwright
