// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "mesher/tuning/cell_tuning.h"
#include "tetwright/mesher_input.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Where the creases of each body are given up, since the mesh cannot have them. Input units; all functions
/// may be called concurrently.
class GivenUpZone {
 public:
  /// Places that a body's creases must keep away from.
  struct Causes {
    std::vector<Vec3> points;
    std::vector<ProjectionTree::Item> items;
    bool only_crossings = true;

    void add(const Vec3& a, const Vec3& b, const Vec3& c) {
      const auto first = static_cast<Index>(points.size());
      points.insert(points.end(), {a, b, c});
      items.push_back({{first, first + 1, first + 2}, {}});
    }
    /// Adds a closed gap or a meeting with another body.
    void add(const Vec3& p) {
      add(p, p, p);
      only_crossings = false;
    }
  };

  GivenUpZone() = default;
  /// \param by_body in the order of the input
  /// \param cell edge of a finest cell, input units
  GivenUpZone(std::vector<Causes> by_body, double cell);

  bool any() const { return any_; }
  bool has(std::size_t body) const { return body < bodies_.size() && !bodies_[body].empty(); }
  /// True if a body has no cause but crossings of itself.
  bool has_only_crossings(std::size_t body) const { return only_crossings_[body] != 0; }
  /// True where nothing moves onto creases.
  bool contains(const Vec3& p, std::size_t body) const {
    return has(body) && bodies_[body].any_within(p, CellTuning::GivenUp::reach * cell_);
  }
  /// True there and beside it, where creases may be off.
  bool affects(const Vec3& p, std::size_t body) const {
    return has(body) &&
           bodies_[body].any_within(p, (CellTuning::GivenUp::reach + CellTuning::GivenUp::beside) * cell_);
  }
  bool affects(const Vec3& p) const {
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      if (affects(p, b)) return true;
    return false;
  }
  /// Length of the pieces of creases that are kept or given up as a whole.
  double piece() const { return cell_; }

 private:
  std::vector<ProjectionTree> bodies_;
  std::vector<std::uint8_t> only_crossings_;
  double cell_ = 0;
  bool any_ = false;
};

/// True if all creases of a surface were given up.
inline bool are_given_up(const SurfacePatches& patches) {
  return patches.verdict == SurfacePatches::Verdict::meeting ||
         patches.verdict == SurfacePatches::Verdict::intersecting;
}

/// Adds the curves in which triangles of a surface cross each other. O(n log n + pairs of overlapping boxes).
void add_self_crossings(const RepairedSurface& surface, GivenUpZone::Causes& causes);

}  // namespace tetwright
