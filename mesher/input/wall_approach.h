// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/box_tree.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// Where a path turns onto a wall.
struct PathTurn {
  double along;     ///< length of the path until then
  double distance;  ///< from the wall, there
  Vec3 towards;     ///< unit, to the wall
  Vec3 foot;        ///< on the wall
};

/// How a surface is continued from a point of its border: in three segments.
struct ContinuedPath {
  std::array<Vec3, 3> ends;  ///< of the segments
};

/// The walls of bodies, as seen by surfaces that are continued to them. A surface that meets a wall at a
/// narrow angle leaves a wedge behind, which no tet of a good shape fits into; so it turns onto the wall
/// where it is close to it. Surfaces that run along a wall stay as they are. Input units; immutable, all
/// functions may be called concurrently.
class WallApproach {
 public:
  /// \param sheets those that divide bodies hide walls behind them
  WallApproach(std::span<const MaterialSurface> bodies, std::span<const SheetSurface> sheets);

  /// Distance of a point inside a body from walls that a surface with this normal may meet at a narrow angle,
  /// at most `limit`; 0 outside of bodies.
  double distance(const Vec3& from, const Vec3& normal, double limit) const;

  /// Where a path from a border has to turn; nothing if it starts outside of all bodies, leaves them at a
  /// wide angle or ends before.
  /// \param direction unit, in the surface continued and away from it
  /// \param normal unit, of the surface at the point, with either sign
  /// \param length of the whole path
  /// \param reach distance from a wall at which paths turn onto it
  std::optional<PathTurn> find_turn(const Vec3& from, const Vec3& direction, const Vec3& normal,
                                    double length, double reach) const;
  /// The turn of a path beside one that turns onto a wall; nothing if the wall is not there.
  /// \param along length of the path until it turns
  std::optional<PathTurn> turn_beside(const PathTurn& other, const Vec3& from, const Vec3& direction,
                                      double along, double length, double reach) const;
  ContinuedPath path(const Vec3& from, const Vec3& direction, double length, double reach,
                     const std::optional<PathTurn>& turn) const;

 private:
  struct Wall {
    std::array<Vec3, 3> corners;
    Vec3 normal;  ///< unit
    std::uint32_t body;
  };
  struct NearestWall {
    double distance = HUGE_VAL;
    Vec3 towards = Vec3::Zero();  ///< unit
    double cosine = 0;            ///< between the normals of surface and wall, absolute value
  };
  struct Walls {
    std::vector<Wall> all;  ///< in the order of the tree
    BoxTree tree;

    void add(const TriangleMesh& surface, std::uint32_t body);
    void build();
    /// Calls `visit(wall, distance)` for all that a ray meets.
    template <class Visit>
    void for_crossings(const Vec3& from, const Vec3& direction, const Visit& visit) const;
  };

  bool is_inside(const Vec3& point) const;
  bool is_hidden(const Vec3& point, const Vec3& direction) const;
  double distance_along(const Vec3& from, const Vec3& direction) const;
  NearestWall nearest(const Vec3& point, const Vec3& normal, double limit) const;

  Walls walls_, sheets_;
  std::uint32_t bodies_ = 0;
};

}  // namespace tetwright
