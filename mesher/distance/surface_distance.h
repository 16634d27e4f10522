// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/geometry/box_tree.h"
#include "common/geometry/surface_tree.h"
#include "common/triangle_mesh.h"
#include "common/types.h"

namespace tetwright {

/// A place on a surface.
struct SurfacePlace {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< unit, of the triangle, pointing out
};

/// Exact distances from the triangles of a surface, its exact inside, and how far it is from one wall to the
/// next. Unlike distances on voxels these resolve walls and gaps of any thinness.
///
/// Triangles without area are left out of distances. Immutable after construction; all functions may be
/// called concurrently. Built in O(n log n); about 200 bytes for each triangle.
class SurfaceDistance {
 public:
  /// The surface's points, its triangles, of which the first `closed` are those of closed components, and
  /// the caps of its holes, which count for distances only. All in one unit, that of all results. Where the
  /// surface `intersects_itself` parts of it are inside others and no walls.
  SurfaceDistance(std::span<const Vec3> points, std::span<const Triangle> triangles, std::size_t closed,
                  const TriangleMesh& caps, bool intersects_itself);

  /// The nearest place within `at_most`; of equally near ones that on the triangle that faces the point most.
  std::optional<SurfacePlace> nearest(const Vec3& point, double at_most) const;

  /// True where the winding number of the closed components, which is exact, and that of the open ones, from
  /// a tree, add up to more than 1/2.
  bool inside(const Vec3& point) const;

  enum class Side { wall, gap };
  /// The thickness of the wall behind a place, or the width of the gap in front of it: the diameter of the
  /// largest ball that touches the place and contains no wall facing it (the shrinking ball of Ma, Bae & Choi
  /// 2012, restricted), at most `at_most`. A wall faces the place if the cosine between their normals is
  /// below -`facing`, so neither the flanks of a convex edge nor noise count.
  double thickness(const SurfacePlace& place, Side side, double facing, double at_most) const;

  /// The place nearest to a point on walls that face `normal`, see thickness(), nearer than `below`; with
  /// `in_front` only on those that the point is in front of.
  std::optional<SurfacePlace> nearest_facing(const Vec3& point, const Vec3& normal, double facing,
                                             double below, bool in_front = false) const;

 private:
  /// False for a place of a self-intersecting surface with the inside on both sides.
  bool is_boundary(const SurfacePlace& place) const;

  BoxTree tree_;
  std::vector<std::array<Vec3, 3>> triangles_;  ///< in the order of the tree
  std::vector<Vec3> normals_;                   ///< unit; zero for triangles without area
  std::vector<std::uint8_t> is_closed_;         ///< of a closed component
  std::optional<SurfaceTree> open_;
  bool intersects_itself_;
};

}  // namespace tetwright
