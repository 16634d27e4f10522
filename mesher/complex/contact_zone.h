// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "common/geometry/box_tree.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/domain/grid_frame.h"

namespace tetwright {

/// Regions and distances around the contacts and junctions of a complex, computed from its triangles: a point
/// belongs to the region on its side of the nearest triangle, so that no gap opens between bodies that share
/// a sheet. Voxel coordinates; immutable, all functions may be called concurrently.
class ContactZone {
 public:
  /// Regions at the complex's nearest triangle.
  struct Nearest {
    RegionIndex region, across;  ///< on the point's side, and on the other; numbers of the complex
    double distance;
  };
  struct Distance {
    double value;   ///< unsigned
    Vec3 gradient;  ///< unit, away from the surface
  };

  ContactZone(const LabelledComplex& complex, const GridFrame& voxels);

  /// True if the voxel that holds the point is in the zone.
  bool contains(const Vec3& point) const;
  /// \pre contains(point)
  Nearest nearest(const Vec3& point) const;
  /// Distance from the boundary of a region; nothing beyond the band.
  std::optional<Distance> distance(const Vec3& point, RegionIndex region) const;

 private:
  using Mask = std::bitset<512>;

  void add_voxels(const std::array<Vec3, 3>& triangle, const std::array<int, 3>& cells,
                  std::vector<std::uint64_t>& keys) const;

  BoxTree tree_;
  struct Face {
    std::array<Vec3, 3> corners;
    Vec3 normal;  ///< unit
    RegionIndex behind, front;
  };
  std::vector<Face> faces_;  ///< in the order of the tree
  std::unordered_map<std::uint64_t, Mask> leaves_;
};

}  // namespace tetwright
