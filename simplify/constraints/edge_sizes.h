// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "common/sizes/size_field.h"
#include "simplify/mesh/working_space.h"

namespace tetwright {

/// The lengths that edges should have: those that a field wants, within a factor, and bounds that hold
/// everywhere. Working coordinates. All functions may be called concurrently.
class EdgeSizes {
 public:
  /// `target_length` may be null: then only the bounds hold. `min_edge` and `max_edge` in input units,
  /// `extent` of the mesh: longer edges than that are not wanted.
  EdgeSizes(const SizeField* target_length, double min_edge, double max_edge, double extent,
            const WorkingSpace& space)
      : target_length_(target_length),
        space_(space),
        min_edge_(min_edge * space.scale()),
        max_edge_(max_edge * space.scale()),
        extent_(extent) {}

  /// From now on edges may be shorter than wanted, not than the bound: for shapes, where layers are thinner
  /// than the wanted length. While no task runs.
  void allow_shorter() { shorter_allowed_ = true; }

  bool has_target_length() const { return target_length_ != nullptr; }
  /// Whether any edge may break a bound, beside the target length.
  bool has_bounds() const { return min_edge_ > 0 || std::isfinite(max_edge_); }
  /// The wanted length at a place. Needs a target length.
  double target_length(const Vec3& at) const {
    return std::min(extent_, target_length_->at(space_.to_input(at)) * space_.scale());
  }

  /// Longest and shortest lengths that an edge with this middle should have.
  double upper(const Vec3& middle) const {
    return target_length_ ? std::min(max_edge_, long_edge * target_length(middle)) : max_edge_;
  }
  double lower(const Vec3& middle) const {
    return target_length_ && !shorter_allowed_ ? std::max(min_edge_, short_edge * target_length(middle))
                                               : min_edge_;
  }
  /// The length of an edge over the longest, and the shortest one over its length: above 1 where it breaks a
  /// bound, by so much.
  struct Excess {
    double longer, shorter;
  };
  /// `short_share`: of the shortest length beside the bound.
  Excess excess(const Vec3& p, const Vec3& q, double short_share = 1) const {
    const Vec3 middle = (p + q) / 2;
    const double length = (q - p).norm();
    if (!target_length_) return {length / max_edge_, min_edge_ / length};
    const double wanted = target_length(middle);
    return {length / std::min(max_edge_, long_edge * wanted),
            (shorter_allowed_ ? min_edge_ : std::max(min_edge_, short_share * short_edge * wanted)) / length};
  }

 private:
  /// Lengths over the wanted one within which edges are let be: halving a longer one makes none that is
  /// collapsed again (as in Botsch & Kobbelt 2004).
  static constexpr double short_edge = 0.7, long_edge = 1.48;

  const SizeField* target_length_;
  WorkingSpace space_;
  double min_edge_, max_edge_, extent_;
  bool shorter_allowed_ = false;
};

}  // namespace tetwright
