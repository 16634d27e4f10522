// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesher/input/surface_cleaning.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// A bounded part of space between the triangles of a surface.
struct SurfaceCell {
  RepairedSurface surface;  ///< closed, oriented outwards; a wall between two cells is part of both
  /// The group that names the cell: it has all triangles between the cell and the outside, or all of a cell
  /// that is inside, and no triangle elsewhere.
  std::optional<std::uint32_t> group;
  bool walled = false;  ///< shares a triangle with another cell
};

/// A triangle that bounds no cell, or is there twice.
struct WallTriangle {
  std::array<Vec3, 3> corners;
  Index source;    ///< the triangle of the surface that it is a part of
  bool outside;    ///< not in a cell
  bool at_border;  ///< has an edge that no other triangle has
  Index cell = 0;  ///< equal numbers are in the same part of space; parts around pieces of the surface differ
  bool at_cell = false;  ///< bounds a cell: one that was dissolved, or if it is there twice

  double area() const { return (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() / 2; }
  Vec3 centre() const { return (corners[0] + corners[1] + corners[2]) / 3; }
};

/// The cells of a surface, and what bounds none.
struct DividedSurface {
  /// By volume, largest first; those that differ by less than InputTuning::Cells::equal by their lowest
  /// point.
  std::vector<SurfaceCell> cells;
  std::size_t border_edges = 0;  ///< of one triangle only, after imprinting
  std::optional<Vec3> border;    ///< the middle of one
  /// Triangles with the same cell, or the outside, on both sides; they are in no cell's surface.
  std::size_t sheet_triangles = 0;
  double sheet_area = 0;          ///< input units squared
  double outside_sheet_area = 0;  ///< the part with the outside on both sides
  std::optional<Vec3> sheet;      ///< the centre of the largest one
  std::vector<WallTriangle> sheets;
  std::vector<char>
      bounds;  ///< by triangle of the surface: 1 if a part of it bounds a cell, also one that was dissolved
  std::vector<char> between;           ///< likewise: 1 if a part of it is between two cells
  std::vector<WallTriangle> repeated;  ///< left out, since an earlier triangle has the same corners
  std::size_t dissolved_cells = 0;     ///< too small or thin, joined with a neighbour
  std::optional<Vec3> dissolved;       ///< on the boundary of one
  std::size_t crossing_pairs = 0;      ///< triangles of one sheet that cross each other
  std::optional<Vec3> crossing;        ///< a corner of one of them
  std::optional<Vec3> unresolved;      ///< see ImprintedSurfaces::unresolved; there are then no cells

  /// True if two cells share a wall, and no more area hangs outside than the cells have.
  bool has_inner_walls() const;
};

/// The surface between the cells and the outside, as it was cut.
/// \param divided has cells
CleanedSurface outline_of(const DividedSurface& divided);

/// True if sheets are joined at edges of an odd number of three or more triangles. Closed shells that touch
/// have an even number at each edge. A triangle that the file lists twice counts twice.
bool may_have_inner_walls(const CleanedSurface& surface);

/// Cuts the sheets of a surface along the curves in which they meet, and finds the cells between them. A
/// *sheet* is connected across edges of exactly two triangles. Triangles that the file lists from both sides
/// belong to two closed shells that touch, and are left out.
///
/// \param tolerance sheets within it meet, input units
/// \param progress may be null
/// \throws Interrupted
DividedSurface divide_surface(const CleanedSurface& surface, double tolerance, Progress* progress);

}  // namespace tetwright
