// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/types.h"

namespace tetwright {

class Progress;
class ProjectionTree;

/// Gap between the bounds of a SurfaceDeviation, relative to the deviation.
inline constexpr double relative_deviation_accuracy = 0.01;

/// One-sided Hausdorff distance of a surface from another, over all its points, not only the vertices: proven
/// to be between `lower` and `upper`. Input units.
struct SurfaceDeviation {
  double lower = 0, upper = 0;
  Vec3 place = Vec3::Zero();  ///< on the first surface, at the distance `lower` from the second
  double rms = 0;             ///< over about 100,000 points, evenly distributed by area
};

/// Proven distance of a mesh from the surface that it represents, input units. Parts of the dense mesh's
/// surface that are far from the given one (caps of holes, layers, the box of a meshed outside) are compared
/// with themselves. Parts of the given surface that are far from the dense mesh (removed inner walls) are
/// left out.
struct DeviationReport {
  SurfaceDeviation from_mesh, from_surface;
  double apart_area = 0;   ///< of the parts compared with themselves
  double hidden_area = 0;  ///< of the parts left out
  double upper() const { return std::max(from_mesh.upper, from_surface.upper); }
};

/// Computes the deviation of `from` from `to`.
///
/// Branch and bound over triangles (Tang, Lee & Kim 2009, "Interactive Hausdorff distance computation for
/// general polygonal models"): the distance from one triangle is convex, hence largest in a corner; any
/// distance grows no faster than the path; where triangles of the other surface meet, a piecewise linear map
/// to them bounds it. Triangles that may exceed the lower bound are bisected where the nearest triangle of
/// the other surface changes. Parallel; the result does not depend on the number of threads.
/// \param accuracy gap allowed between the bounds, input units, above 0; relative_deviation_accuracy if that
///   is more. The gap is larger only where closing it would take more than four million triangles, or 150
///   cuts of one, which is not to be expected
/// \param progress may be null; after its deadline the bounds remain as far apart as they are
/// \return infinite where `to` is empty and `from` is not
/// \throws Interrupted if `progress` is cancelled
SurfaceDeviation surface_deviation(const ProjectionTree& from, const ProjectionTree& to, double accuracy,
                                   const Progress* progress = nullptr);

/// A triangle with a point that is far from another surface.
struct FarTriangle {
  std::uint32_t item;     ///< index into items() of its surface
  std::uint32_t nearest;  ///< item of the other surface nearest to `place`
  Vec3 place;             ///< the far point
};

/// Finds the triangles of `from`, ascending, with a point farther from `to` than `limit`. A triangle that
/// exceeds it by less than `accuracy` (above 0), or is not settled after a few thousand cuts, may be missing.
/// Parallel; the result does not depend on the number of threads.
/// \pre `to` is not empty
std::vector<FarTriangle> triangles_beyond(const ProjectionTree& from, const ProjectionTree& to, double limit,
                                          double accuracy);

}  // namespace tetwright
