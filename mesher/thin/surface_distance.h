// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/geometry/reference_tree.h"
#include "common/geometry/surface_tree.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A point on a surface.
struct SurfacePlace {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< outward unit normal of the triangle
  /// Side of the surface on which the queried point lies: 1 outside, -1 inside, 0 if the triangle alone does
  /// not tell. Set by SurfaceDistance::nearest() only.
  int side = 0;
  bool on_cap = false;  ///< of a hole, which is no wall
  /// Whether the inside is behind the triangle and not in front of it; no value if the triangle does not
  /// tell.
  std::optional<bool> is_boundary;
};

/// Exact distances from the triangles of a surface, its exact inside, and the distance from one wall to the
/// next. Unlike distances on voxels, these resolve walls and gaps of any thickness.
///
/// Distances ignore triangles without area. Immutable after construction; all functions may be called
/// concurrently. Built in O(n log n); about 350 bytes per triangle.
class SurfaceDistance {
 public:
  /// Coordinates and results are in voxels.
  /// \param closed number of triangles of closed components, which come first; none lies within another one
  ///   that is oriented alike and touches it
  /// \param caps caps of the surface's holes. If they have more than DistanceTuning::Caps::max_wall_share of
  ///   its area, the surface is more of a sheet than a body: they count for distances then but are no walls
  /// \param intersects_itself parts of the surface lie inside others and are not walls
  SurfaceDistance(std::span<const Vec3> points, std::span<const Triangle> triangles, std::size_t closed,
                  const TriangleMesh& caps, bool intersects_itself);

  /// The closest point within `at_most`. Among equally close points, the one whose triangle faces `point`
  /// most directly.
  std::optional<SurfacePlace> nearest(const Vec3& point, double at_most) const;

  /// Whether no triangle but those of caps that are no walls is nearer to a point than `radius`.
  bool is_ball_empty(const Vec3& center, double radius) const;

  /// True where the winding numbers of the closed components (exact) and of the open ones (by a tree) add up
  /// to more than 1/2.
  bool inside(const Vec3& point) const;

  enum class Side { wall, gap };
  /// The thickness of the wall behind a surface point, or the width of the gap in front of it, at most
  /// `at_most`: the diameter of the largest ball that touches the point and contains no wall facing it (the
  /// shrinking ball of Ma, Bae & Choi 2012, restricted). `at_most` on caps that are no walls.
  /// \param facing a wall faces the point if the cosine between their normals is below -`facing`, so that
  ///   neither the flanks of a convex edge nor noise count
  double thickness(const SurfacePlace& place, Side side, double facing, double at_most) const;

  /// The closest point, within `below`, on walls that face `normal` (see thickness()).
  /// \param in_front only walls that `point` is in front of count
  std::optional<SurfacePlace> nearest_facing(const Vec3& point, const Vec3& normal, double facing,
                                             double below, bool in_front = false) const;

 private:
  /// Where the inside is around a triangle.
  enum class Sides : std::uint8_t { unknown, behind, both, neither };
  void find_sides(std::span<const Triangle> triangles, const std::vector<Index>& order);
  /// For each triangle of the surface whether neither another one nor a cap meets it.
  std::vector<std::uint8_t> find_clear(std::span<const Triangle> triangles,
                                       const std::vector<Index>& order) const;
  /// Whether the inside is behind a triangle and not in front of it, if known.
  std::optional<bool> known_boundary(std::size_t triangle) const;
  /// False for a point of a self-intersecting surface with the inside on both sides.
  bool is_boundary(const SurfacePlace& place) const;
  /// Whether there is only one triangle where has_inside_behind() would look.
  bool is_alone(const Vec3& point) const;
  /// Whether the inside is behind a point of the surface and not in front of it.
  bool has_inside_behind(const SurfacePlace& place) const;

  ReferenceTree tree_;
  std::vector<std::array<Vec3, 3>> triangles_;  ///< neighbours in the list are neighbours in space
  std::vector<Vec3> normals_;                   ///< unit; zero for triangles without area
  enum class Part : std::uint8_t { closed, open, cap };
  std::vector<Part> parts_;  ///< the kind of component that each triangle is in
  std::optional<SurfaceTree> open_;
  bool intersects_itself_;
  std::vector<Sides> sides_;  ///< by triangle
};

}  // namespace tetwright
