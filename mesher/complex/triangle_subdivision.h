// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Subdivides one triangle into a constrained Delaunay triangulation of its corners, of points on its edges
/// and in its interior, and of segments between them.
///
/// Predicates are exact: barycentric coordinates are rounded to multiples of 2^-40, points on edges lie
/// exactly on them. Thus the result covers the triangle once, however points were rounded in space. Which
/// diagonals are Delaunay is decided in space by positions alone, and ties by the points' numbers, so that
/// two triangles with the same points and segments on a common part are divided alike there.
///
/// Cost: about O(n^1.5) for n points.
class TriangleSubdivision {
 public:
  /// \param corners numbers of the points; numbers are only compared
  TriangleSubdivision(const Triangle& corners, const std::array<Vec3, 3>& positions);

  /// Adds a point on the edge from corner `edge` to the next one.
  /// \param share fraction of the edge; two points of an edge must differ by more than 2^-40
  void add_on_edge(int edge, double share, Index number, const Vec3& position);
  /// Adds a point in the interior, by its projection onto the triangle.
  void add_inside(Index number, const Vec3& position);
  /// Makes the segment between two added points or corners a chain of edges.
  /// \return false if a point is not there, or an earlier segment crosses it
  bool constrain(Index a, Index b);

  /// The parts, by the numbers of their points, oriented like the triangle.
  std::vector<Triangle> triangles();

 private:
  using Local = std::uint32_t;
  struct Point {
    std::int64_t x, y;  ///< barycentric coordinates of corners 1 and 2, times 2^40
    Index number;
    Vec3 position;
    Local part = 0;  ///< one that has it
  };
  struct Part {
    std::array<Local, 3> points;
    std::array<Local, 3> across;  ///< the part opposite each point
    std::array<bool, 3> fixed;    ///< the edge opposite each point is one of a segment
  };

  int side(Local a, Local b, Local c) const;
  Local insert(const Point& point);
  void split_edge(Local part, int edge, Local point);
  void split_part(Local part, Local point);
  void link(Local part, Local before, Local after);
  int slot(Local part, Local point) const;
  bool can_flip(Local part, int edge) const;
  void flip(Local part, int edge);
  bool should_flip(Local part, int edge) const;
  void make_delaunay(std::vector<std::array<Local, 2>> edges);
  Local find(Index number) const;
  bool find_edge(Local a, Local b, Local& part, int& edge) const;
  bool constrain_local(Local a, Local b);
  Local constrain_first(Local a, Local b);
  std::vector<Local> parts_around(Local point) const;

  std::vector<Point> points_;
  std::map<Index, Local> local_;  ///< by number
  std::vector<Part> parts_;
  Local last_ = 0;  ///< part at which the next search starts
};

}  // namespace tetwright
