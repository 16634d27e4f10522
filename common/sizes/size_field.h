// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "common/sizes/size_source.h"
#include "common/types.h"

namespace tetwright {

/// How much a wanted edge length may grow from one place to another, over their distance, by default: edges
/// next to each other then differ by about as much, and tets between them can be well shaped.
inline constexpr double default_grading = 0.5;

/// Bounds of the lengths of edges, input units.
struct SizeLimits {
  double min_edge = 0;  ///< at least 0
  double max_edge = std::numeric_limits<double>::infinity();
  double grading = default_grading;  ///< above 0: growth of the length over distance
};

/// Lengths of edges vary around what is wanted: so far within the bounds, as a factor, what is wanted keeps
/// nearly all of them there.
inline constexpr double within_bounds = 1.48;

/// The limits of what may be wanted where edges have these.
inline SizeLimits wanted_within(SizeLimits edges) {
  const double middle = std::sqrt(edges.min_edge * edges.max_edge);
  const double low = within_bounds * edges.min_edge, high = edges.max_edge / within_bounds;
  return low <= high ? SizeLimits{low, high, edges.grading} : SizeLimits{middle, middle, edges.grading};
}

/// The edge length that is wanted at each place of a box: what a source says, between the limits, and nowhere
/// growing faster than the grading allows (Persson 2006, "Mesh size functions for implicit geometries and
/// PDE-based gradient limiting").
///
/// Kept as numbers on a grid of some 2 million nodes, between which it is trilinear. Every value of the
/// source counts, also where it has more of them than the grid has nodes: it is never above one given on a
/// surface, and above one within the volume by at most the growth over a cell's diagonal. Input units.
/// Functions that read may be called concurrently.
class SizeField {
 public:
  /// For places in the box from `low` to `high`, of which at least one side must be above 0. Time: a query of
  /// the source for each node.
  SizeField(const SizeSource& source, const Vec3& low, const Vec3& high, const SizeLimits& limits);

  /// The wanted edge length at a place of the box; of one outside that of the nearest place in it.
  double at(const Vec3& place) const;
  /// The first of these places that is farther from where the source knows sizes than the edge length there
  /// and two nodes: a mesh with sizes may have chords where the body is round. Nothing if it reaches all.
  std::optional<Vec3> first_beyond(const SizeSource& source, const std::vector<Vec3>& places) const;
  const SizeLimits& limits() const { return limits_; }

 private:
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * size_[1] + static_cast<std::size_t>(y)) * size_[0] +
           static_cast<std::size_t>(x);
  }
  Vec3 node(int x, int y, int z) const { return low_ + spacing_ * Vec3(x, y, z); }
  /// Of the wanted length from a place of the source to a node this far from it.
  double growth(double distance, const SizeSource& source) const;
  void sample(const SizeSource& source);
  void lower_at_values(const SizeSource& source);
  void limit_growth();

  SizeLimits limits_;
  Vec3 low_;
  double spacing_ = 1;
  std::array<std::size_t, 3> size_{2, 2, 2};  ///< nodes along each axis
  std::vector<float> values_;                 ///< by node, the first axis running fastest
  std::vector<std::uint8_t> known_;           ///< by node: whether the source reaches it
};

}  // namespace tetwright
