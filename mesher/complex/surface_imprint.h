// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mesher/tuning/complex_tuning.h"
#include "tetwright/progress.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Triangles of several surfaces.
struct SurfaceSoup {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> surface;  ///< of each triangle; earlier surfaces keep their positions
};

/// Surfaces cut along the curves in which they meet.
struct ImprintedSurfaces {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<Index> source;  ///< of each triangle: the triangle of the input that it is a part of
  bool any = false;           ///< whether any two surfaces meet; if not, all is as it was
  /// Where triangles of two surfaces still meet other than in points and edges after the last round.
  std::optional<Vec3> unresolved;
  /// The last round was the last one because the next would exceed the bound on new points
  /// (ComplexTuning::Imprint); then `unresolved` is set.
  bool too_many_points = false;
  double peak_bytes = 0;  ///< estimated peak memory of imprinting
};

/// New points beyond which no further round begins: the larger of both.
struct ImprintBound {
  double points = ComplexTuning::Imprint::max_new_points;
  double per_pair = ComplexTuning::Imprint::points_per_pair;  ///< of triangles whose boxes meet at first
};

/// Cuts surfaces along the curves in which they meet, so that afterwards any two triangles of different
/// surfaces are equal or share points or an edge, or are apart.
///
/// Distances up to `tolerance` count as contact: points merge with points, edges and triangles of another
/// surface within it, and edges that pass each other that closely meet in a common point. Points move onto
/// the earlier of the two surfaces. New points lie where edges cross edges or triangles. Every triangle is
/// then divided by a constrained triangulation; this is repeated until nothing is left to do, two to four
/// times. Moved points may bend the surface by the tolerance.
///
/// A tolerance works where it is well below the size of facets. O(n log n + pairs of triangles whose boxes
/// meet). The result does not depend on the number of threads, and its geometry not on the numbers of
/// triangles.
///
/// \pre each surface by itself has no two equal points
/// \param tolerance above 0, in the unit of points
/// \throws OutputError if it needs more memory than is available, see require_memory()
/// \throws Interrupted
ImprintedSurfaces imprint_surfaces(const SurfaceSoup& soup, double tolerance, Progress* progress,
                                   const ImprintBound& bound = {});

}  // namespace tetwright
