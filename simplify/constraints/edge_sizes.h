// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "simplify/mesh/working_space.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/sizes.h"

namespace tetwright {

/// Bounds on edge lengths: the target length of a size field, within a factor, and global bounds. Working
/// coordinates. Const functions may be called concurrently.
class EdgeSizes {
 public:
  /// \param target_length may be null: then only the bounds hold. Input units.
  /// \param min_edge, max_edge bounds of all edges, input units; 0 and infinity: none.
  /// \param extent of the mesh, working coordinates; caps the target length.
  EdgeSizes(const SizeField* target_length, double min_edge, double max_edge, double extent,
            const WorkingSpace& space)
      : target_length_(target_length),
        space_(space),
        min_edge_(min_edge * space.scale()),
        max_edge_(max_edge * space.scale()),
        extent_(extent) {}

  /// Drops the lower bound of the target length, but not `min_edge`: layers thinner than the target length
  /// need shorter edges to be well shaped.
  /// \pre No task runs.
  void allow_shorter() { shorter_allowed_ = true; }

  bool has_target_length() const { return target_length_ != nullptr; }
  /// Whether there are bounds in addition to the target length.
  bool has_bounds() const { return min_edge_ > 0 || std::isfinite(max_edge_); }
  /// \pre has_target_length().
  double target_length(const Vec3& at) const {
    return std::min(extent_, target_length_->at(space_.to_input(at)) * space_.scale());
  }

  /// Max and min length of an edge with this midpoint.
  double upper(const Vec3& middle) const {
    return target_length_ ? std::min(max_edge_, Lengths::long_edge * target_length(middle)) : max_edge_;
  }
  double lower(const Vec3& middle) const {
    return target_length_ && !shorter_allowed_
               ? std::max(min_edge_, Lengths::short_edge * target_length(middle))
               : min_edge_;
  }
  /// Ratios of an edge's length to its max length, and of its min length to its length. A value above 1 is
  /// the factor by which the edge violates the bound.
  struct Excess {
    double longer, shorter;
  };
  /// \param short_share scales the min length that follows from the target length.
  Excess excess(const Vec3& p, const Vec3& q, double short_share = 1) const {
    const Vec3 middle = (p + q) / 2;
    const double length = (q - p).norm();
    if (!target_length_) return {length / max_edge_, min_edge_ / length};
    const double wanted = target_length(middle);
    return {length / std::min(max_edge_, Lengths::long_edge * wanted),
            (shorter_allowed_ ? min_edge_ : std::max(min_edge_, short_share * Lengths::short_edge * wanted)) /
                length};
  }

 private:
  using Lengths = SimplifyTuning::EdgeLengths;

  const SizeField* target_length_;
  WorkingSpace space_;
  double min_edge_, max_edge_, extent_;
  bool shorter_allowed_ = false;
};

}  // namespace tetwright
