// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/types.h"

namespace tetwright {

class Progress;
class ProjectionTree;

/// How near to each other the bounds of a SurfaceDeviation are, as a share of it.
inline constexpr double relative_deviation_accuracy = 0.01;

/// How far a surface is from another: the largest distance of all its points, those between the corners too,
/// is proven to be from `lower` to `upper`. Units of the input.
struct SurfaceDeviation {
  double lower = 0, upper = 0;
  Vec3 place = Vec3::Zero();  ///< of the first surface, at the distance `lower` from the second
  double rms = 0;             ///< of 100,000 points spread evenly by area, about
};

/// How far a mesh is from the surface that it stands for, proven; input units. Parts of the dense mesh's own
/// surface that are far from the one given (caps of holes, layers, the box of an outside that is meshed)
/// stand for themselves; parts of that one that are far from the dense mesh (inner walls that were removed)
/// for nothing.
struct DeviationReport {
  SurfaceDeviation from_mesh, from_surface;
  double apart_area = 0;   ///< of what stands for itself
  double hidden_area = 0;  ///< of what stands for nothing
  double upper() const { return std::max(from_mesh.upper, from_surface.upper); }
};

/// The deviation of `from` from `to`. The bounds are within relative_deviation_accuracy of each other, or
/// `accuracy` if that is more (above 0; input units); wider only where that would take more than four million
/// triangles, or 150 cuts of one, which is not to be expected.
///
/// Branch and bound over triangles (Tang, Lee & Kim 2009, "Interactive Hausdorff distance computation for
/// general polygonal models"): the distance from one triangle is convex, so that it is largest in a corner;
/// any distance grows no faster than the way; over triangles of the other surface that meet, a map to them,
/// linear in parts, bounds it. Triangles that may be farther than what is known are cut in two, where the
/// nearest triangle of the other surface changes. Infinite where `to` is empty and `from` is not. Parallel;
/// the result does not depend on the threads. Throws Interrupted when `progress` (may be null) is cancelled;
/// once its deadline has passed the bounds are left as far apart as they are.
SurfaceDeviation surface_deviation(const ProjectionTree& from, const ProjectionTree& to, double accuracy,
                                   const Progress* progress = nullptr);

/// A triangle with a point that is far from another surface.
struct FarTriangle {
  std::uint32_t item;     ///< of items() of the surface it belongs to
  std::uint32_t nearest;  ///< the other surface's item that is nearest to that point
  Vec3 place;             ///< the point
};

/// The triangles of `from`, ascending, of which a point is farther from `to` than `limit`. Where that is so
/// by less than `accuracy` (above 0), or not settled after a few thousand cuts, a triangle may be left out.
/// `to` must not be empty. Parallel; the result does not depend on the threads.
std::vector<FarTriangle> triangles_beyond(const ProjectionTree& from, const ProjectionTree& to, double limit,
                                          double accuracy);

}  // namespace tetwright
