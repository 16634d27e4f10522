// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "common/geometry/morton.h"
#include "mesher/domain/grid_frame.h"
#include "mesher/domain/narrow_band.h"
#include "mesher/domain/refinement_regions.h"
#include "mesher/level_sets/wall_distances.h"
#include "mesher/thin/surface_distance.h"

namespace tetwright {

/// Distances near the thin walls and gaps of one surface, in voxels.
///
/// They are computed from the triangles, for a surface changed so that nothing is thinner than a lattice can
/// resolve. With f the signed distance, T the thickness of the wall behind the closest surface point, G the
/// width of the gap in front of it and `min_shown` the thinnest that the lattice resolves, the distance
/// becomes
///
///     outside, G < min_shown:  -(min_shown - G) / 2           the gap is closed
///     else:                    f - max(0, min_shown - T) / 2  the wall is thickened
///
/// Both vary continuously along a wall, so that a wall or gap is kept or closed as a whole and does not tear.
/// Gaps below `min_gap` are closed and walls below `min_thickness` omitted in the same way, regardless of the
/// lattice.
///
/// Immutable once constructed; all functions may be called concurrently.
class ThinWalls : public WallDistances {
 public:
  struct Limits {
    double min_gap = 0, min_thickness = 0;  ///< voxels
  };

  ThinWalls(std::shared_ptr<const SurfaceDistance> surface, const Limits& limits)
      : surface_(std::move(surface)), limits_(limits) {}

  const SurfaceDistance& surface() const { return *surface_; }
  const Limits& limits() const { return limits_; }

  /// Covers a voxel: its distances come from this object. Records how many times its cells are halved.
  void cover(const std::array<int, 3>& voxel, int depth);
  int depth(const std::array<int, 3>& voxel) const override {
    const auto block = blocks_.find(block_key(voxel));
    return block == blocks_.end() ? -1 : block->second[place_in_block(voxel)] - 1;
  }
  std::vector<MortonKey> covered() const override;
  const std::vector<MortonKey>& core() const override { return core_; }
  /// \param core covered voxels that contain a thin wall or gap, ascending
  void set_core(std::vector<MortonKey> core) { core_ = std::move(core); }

  double changed_distance(const Vec3& point, int depth, Vec3& gradient) const override;
  double true_distance(const Vec3& point, int depth, Vec3& gradient) const override;
  double parallel_thickness(const Vec3& point, int depth) const override;

 private:
  using Block = std::array<std::uint8_t, leaf_points>;  ///< depth + 1, or 0
  static MortonKey block_key(const std::array<int, 3>& v) {
    return morton_encode(v[0] / leaf_side, v[1] / leaf_side, v[2] / leaf_side);
  }
  static std::size_t place_in_block(const std::array<int, 3>& v) {
    const int place = (v[0] % leaf_side * leaf_side + v[1] % leaf_side) * leaf_side + v[2] % leaf_side;
    return static_cast<std::size_t>(place);
  }
  /// The thickness at a surface point, also on the narrow face at the rim of a wall or the end of a gap.
  /// \param place is replaced by the point where the thickness was measured
  double thickness_around(SurfacePlace& place, SurfaceDistance::Side side, double at_most) const;
  /// True if a point lies between a wall of this normal and one that faces it, both nearer than `width`.
  bool is_between(const Vec3& point, const Vec3& normal, double width) const;
  double distance(const Vec3& point, int depth, bool thicken, Vec3& gradient) const;

  std::shared_ptr<const SurfaceDistance> surface_;
  Limits limits_;
  std::unordered_map<MortonKey, Block> blocks_;
  std::vector<MortonKey> core_;
};

}  // namespace tetwright
