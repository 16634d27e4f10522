// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "tetwright/prepare.h"

namespace tetwright {

/// The tuned constants of jobs whose bricks are regrouped and coarsened again.
struct BrickRoundsTuning {
  /// A third round mainly removes what the cuts of the first two have left.
  static constexpr int max_rounds = max_brick_rounds;
  /// Tets for each final one that a round after the first leaves, by round. coarsen() has its own number for
  /// the first one.
  static constexpr std::array<double, max_rounds> tets_for_final{0, 2, 2};
  /// Offset of the bricks, in edges: any two rounds have their cuts a quarter of an edge or more apart.
  static constexpr std::array<double, max_rounds> offset{0, 0.5, 0.25};

  /// Bounds of the thinned dense surface.
  struct Surface {
    /// Max distance of a removed point from it, in ideal edges of the result. Results of a dense surface
    /// are 0.01 of an edge (rms) away from it.
    static constexpr double distance_edges = 0.003;
    /// Min cosine of the angle by which a face turns when a point is removed.
    static constexpr double min_cosine = 0.9;
    /// Min area of a face, in that of an equilateral triangle with its longest edge, unless it had less.
    static constexpr double min_shape = 0.2;
    /// Passes over all points, each of which removes no two adjacent ones. More remove little.
    static constexpr int passes = 6;
    /// Shortest edges of a point that are tried.
    static constexpr int tried_edges = 4;
  };
};

}  // namespace tetwright
