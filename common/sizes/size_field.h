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

/// Default growth of the target edge length over distance: adjacent edges then differ by about this fraction,
/// and tets between them can be well shaped.
inline constexpr double default_grading = 0.5;

/// Bounds of edge lengths, input units.
struct SizeLimits {
  double min_edge = 0;  ///< at least 0
  double max_edge = std::numeric_limits<double>::infinity();
  double grading = default_grading;  ///< growth of the length over distance, above 0
};

/// Edge lengths vary around their target: targets inside the bounds by this factor keep nearly all edges
/// within them.
inline constexpr double within_bounds = 1.48;

/// Limits of target lengths whose edges stay within `edges`.
inline SizeLimits wanted_within(SizeLimits edges) {
  const double middle = std::sqrt(edges.min_edge * edges.max_edge);
  const double low = within_bounds * edges.min_edge, high = edges.max_edge / within_bounds;
  return low <= high ? SizeLimits{low, high, edges.grading} : SizeLimits{middle, middle, edges.grading};
}

/// Target edge length at each point of a box: the length of a source, clamped to the limits, growing nowhere
/// faster than the grading allows (Persson 2006, "Mesh size functions for implicit geometries and PDE-based
/// gradient limiting").
///
/// Stored on a grid of about 2 million nodes with trilinear interpolation. Every value of the source counts,
/// even if it has more of them than the grid has nodes: the field never exceeds one given on a surface, and
/// exceeds one within the volume by at most the growth over a cell's diagonal. Input units. Const functions
/// may be called concurrently.
class SizeField {
 public:
  /// Samples the source in the box from `low` to `high`: one query for each node.
  /// \pre at least one side of the box is above 0
  SizeField(const SizeSource& source, const Vec3& low, const Vec3& high, const SizeLimits& limits);

  /// Target edge length at a point; outside the box, that of its nearest point.
  double at(const Vec3& place) const;
  /// First of `places` that is farther from the source's domain than the edge length there plus two grid
  /// spacings: a mesh with sizes may have chords where the body is round.
  /// \return std::nullopt if the source reaches all
  std::optional<Vec3> first_beyond(const SizeSource& source, const std::vector<Vec3>& places) const;
  const SizeLimits& limits() const { return limits_; }

 private:
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * size_[1] + static_cast<std::size_t>(y)) * size_[0] +
           static_cast<std::size_t>(x);
  }
  Vec3 node(int x, int y, int z) const { return low_ + spacing_ * Vec3(x, y, z); }
  /// Growth of the target length from a point of the source to a node at this distance.
  double growth(double distance, const SizeSource& source) const;
  void sample(const SizeSource& source);
  void lower_at_values(const SizeSource& source);
  void limit_growth();

  SizeLimits limits_;
  Vec3 low_;
  double spacing_ = 1;
  std::array<std::size_t, 3> size_{2, 2, 2};  ///< nodes along each axis
  std::vector<float> values_;                 ///< by node, the first axis fastest
  std::vector<std::uint8_t> known_;           ///< by node: whether the source reaches it
};

}  // namespace tetwright
