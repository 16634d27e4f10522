// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tetwright {

/// The tuned constants of coarsening in bulk (merge_points()), by the rules of SimplifyTuning. "Edges" are
/// TetQuality::ideal_edge, half of an edge of the result.
struct MergingTuning {
  /// Min ratio of tets to the target: three quarters of the tets vanish, and the loop needs some times the
  /// target to choose from.
  static constexpr double min_ratio = 20;
  /// Max distance by which a point moves, and max length of an edge of a moved face, in edges: shorter than
  /// those of the result.
  static constexpr double max_distance_edges = 1.5;
  /// Max distance of moved points of a surface from the planes of its new faces, in edges: half of
  /// SimplifyTuning::TunedLoop::first_deviation. With half of this, a tenth fewer points of a scan move, and
  /// rms distances are the same.
  static constexpr double max_deviation_edges = 0.1;
  /// Min cosines of the angle between a face and the mean around its point (37 degrees; a crease of 90
  /// degrees has 45), and between a face and the one that replaces it.
  static constexpr double min_smooth_cosine = 0.8, min_turn_cosine = 0.8;
  /// Min ratio of twice the area of a moved face to its longest edge squared; 0.87 for a regular one.
  /// Smaller values move no more points.
  static constexpr double min_face_shape = 0.3;
  /// Min ratio of a tet's determinant to the cube of its longest edge; 0.71 for a regular tet. Far above
  /// rounding errors, so the sign is exact. With 0.05 shapes are the same and more points stay.
  static constexpr double min_tet_shape = 0.02;
  /// Max change of a region's volume, as a fraction: half of SimplifyTuning::Volumes::max_change.
  static constexpr double max_volume_change = 0.004;
  /// Number of times that half of the moves of such a region are undone, before all are.
  static constexpr int max_volume_passes = 3;
  /// Max number of times that a point moves onto another neighbour before it stays; 4 is no better.
  static constexpr int max_changes = 2;
};

}  // namespace tetwright
