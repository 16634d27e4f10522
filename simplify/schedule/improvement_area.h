// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "simplify/schedule/block_runner.h"

namespace tetwright {

/// What an improvement works on: the whole mesh, or a part of it. Only while no task runs.
class ImprovementArea {
 public:
  virtual ~ImprovementArea() = default;
  /// The number of its tets, which shares are of.
  virtual std::size_t tet_count() const = 0;
  /// A usual edge, working coordinates.
  virtual double usual_edge() const = 0;
  // Ascending, which is the order of the curve after compaction.

  /// The tets of at most that quality.
  virtual std::vector<TetSnapshot> bad_tets(float limit) = 0;
  /// Their points.
  virtual std::vector<Index> bad_points(float limit) = 0;
  /// The tets that share a point with a listed one, and their points.
  virtual std::vector<TetSnapshot> tets_around(const std::vector<TetSnapshot>& tets) = 0;
  virtual std::vector<Index> points_around(const std::vector<TetSnapshot>& tets) = 0;
  /// The points at which collapses may make room for insertions near bad tets.
  virtual std::vector<Index> points_to_thin(const std::vector<TetSnapshot>& bad) = 0;
};

}  // namespace tetwright
