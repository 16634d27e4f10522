// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Segments near a surface.
struct NearCurves {
  std::vector<Vec3> points;
  std::vector<std::array<Index, 2>> segments;  ///< into points
};

/// A surface divided along curves that were laid on it.
struct LaidCurves {
  std::vector<Index> points;               ///< for each point of the curves, the surface's
  std::vector<std::vector<Index>> chains;  ///< for each segment, the surface's points from end to end
  std::vector<Triangle> triangles;
  std::vector<Index> source;  ///< of each triangle: the one that it is a part of
};

/// Lays segments on a surface: their ends move to its nearest points, and between them each follows the
/// plane that is perpendicular to the surface there. The surface keeps its shape. Points and segments within
/// the tolerance of the surface's own points, and points within it of edges, run through these instead.
///
/// \param points of the surface; new ones are appended
/// \param tolerance above 0, in the unit of points
/// \return nothing if a segment cannot be laid: where segments cross, or the surface is not nearby or folds
std::optional<LaidCurves> lay_curves(const NearCurves& curves, std::span<const Triangle> surface,
                                     double tolerance, std::vector<Vec3>& points);

}  // namespace tetwright
