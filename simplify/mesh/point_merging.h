// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "simplify/mesh/editable_mesh.h"
#include "simplify/tuning/merging_tuning.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Bounds for merge_points(). Lengths in working coordinates.
struct PointMerging {
  double max_distance;  ///< of a point from the neighbour onto which it moves; length of edges of moved faces
  /// Max distance of the three points of a face from the plane of the face that replaces it. Points all of
  /// whose faces vanish are not tested.
  double max_deviation;
  std::uint64_t seed = 1;  ///< selects the points that stay
  /// Min cosine of the angle between the normal of each face at a point of a surface and their mean; other
  /// points stay.
  double min_smooth_cosine = MergingTuning::min_smooth_cosine;
  double min_turn_cosine = MergingTuning::min_turn_cosine;  ///< by which the normal of a face turns
  /// Min ratio of twice the area of a face to the square of its longest edge.
  double min_face_shape = MergingTuning::min_face_shape;
};

/// Coarsens a mesh in bulk, several times faster than collapse by collapse: points of a maximal independent
/// set stay, and most others move onto a neighbour that stays, at once; elements with two equal points
/// vanish. Only points inside a material and points of a surface around which it is smooth, with one patch,
/// move; the latter along its edges. The result is proven to keep the topology and to be embedded:
///
/// - Every point, edge and triangle of the new surfaces comes from a contractible part of the old ones, so
///   they are homeomorphic (Youngs 1948): clusters have Euler characteristic 1; the edges between two
///   clusters and the triangles that join these edges form a path; no two triangles become the same; no piece
///   of the surface vanishes as a whole.
/// - No two triangles of the new boundary intersect, and all remaining tets are positive. They cover each
///   point as often as the boundary winds around it. If no body of the mesh has moved over another one, which
///   is not tested and can happen where they are about as near to each other as `max_deviation`, that is
///   once: tets do not overlap, interfaces do not meet, and neighbours across a face remain neighbours.
///
/// Moves that violate this are undone, and those of a region whose volume would change by more than
/// MergingTuning::max_volume_change. Parallel; the result does not depend on the number of threads.
/// Links, incident tets and patches are set anew; points that moved are dead, and all other points keep their
/// numbers and positions.
///
/// \param progress tells whether the work should end; may be null
/// \return false if nothing was changed: a tet is not positive (exact sign), or the boundary meets itself
/// \throws OutOfTime or Interrupted if the work should end; nothing was changed then
///
/// \pre no operation has run
bool merge_points(EditableMesh& mesh, const PointMerging& options, const Progress* progress = nullptr);

}  // namespace tetwright
