// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mesher/input/connected_patches.h"
#include "mesher/input/divided_surface.h"
#include "mesher/input/surface_cleaning.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// Walls of zero thickness inside a body that are part of its surface: one material is on both sides.
struct InnerWalls {
  std::vector<char> whole;  ///< by patch: bounds no cell, and enough of it is inside
  /// The walls that are kept; groups are those of the surface. Whole patches as they are, and parts of others
  /// as they were cut.
  TriangleMesh kept;
  std::size_t pieces = 0;     ///< of those kept, connected by points
  double area = 0;            ///< likewise, input units squared
  Vec3 place = Vec3::Zero();  ///< the centre of the largest triangle
  /// Triangles that bound no cell and are not kept: outside, of pieces that are too small, or on others.
  std::size_t dropped = 0;
  double dropped_area = 0;
  std::optional<Vec3> dropped_place;
  double largest_dropped = -1;

  void drop(double size, const Vec3& centre);
};

/// Finds the walls of a surface.
/// \param divided the surface, divided
/// \param inside whether a point off the surfaces of bodies is inside one
/// \param min_area smaller pieces are dropped, input units squared
InnerWalls find_inner_walls(const CleanedSurface& surface, const ConnectedPatches& patches,
                            const DividedSurface& divided, const std::function<bool(const Vec3&)>& inside,
                            double min_area);

/// The surface without some of its patches.
CleanedSurface without_patches(const CleanedSurface& surface, const ConnectedPatches& patches,
                               const std::vector<char>& left_out);

/// The walls of a body as a sheet.
struct WallSheet {
  SheetSurface sheet;
  std::vector<SurfaceRegion> groups;  ///< of the body's file that name walls, and nothing else
};

/// Makes a sheet of the walls of a body. Groups of triangles that bound no cell name their walls; the others
/// are called NAME_sheet after the body, with a number if that is taken.
/// \param surface the body's, `divided` into cells
/// \param from has its groups
/// \param taken names of patches and sheets; receives a new one
WallSheet sheet_of_walls(const InnerWalls& walls, const CleanedSurface& surface,
                         const DividedSurface& divided, const MaterialSurface& from,
                         std::set<std::string>& taken);

}  // namespace tetwright
