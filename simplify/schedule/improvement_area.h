// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "simplify/schedule/block_runner.h"

namespace tetwright {

/// The part of the mesh that an improvement works on: all or some of it.
/// \pre No task runs during any call.
class ImprovementArea {
 public:
  virtual ~ImprovementArea() = default;
  /// Number of tets in the area, to which fractions refer.
  virtual std::size_t tet_count() const = 0;
  /// Typical edge length, working coordinates.
  virtual double usual_edge() const = 0;
  // Results are ascending: the order of the space-filling curve after compaction.

  /// The tets of quality `limit` or less.
  virtual std::vector<TetSnapshot> bad_tets(float limit) = 0;
  /// The points of bad_tets().
  virtual std::vector<Index> bad_points(float limit) = 0;
  /// The tets that share a point with a listed one, and their points.
  virtual std::vector<TetSnapshot> tets_around(const std::vector<TetSnapshot>& tets) = 0;
  virtual std::vector<Index> points_around(const std::vector<TetSnapshot>& tets) = 0;
  /// The points at which collapses may make room for insertions near bad tets.
  virtual std::vector<Index> points_to_thin(const std::vector<TetSnapshot>& bad) = 0;
};

}  // namespace tetwright
