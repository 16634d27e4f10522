// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "mesher/domain/material_field.h"

namespace tetwright {

/// Finds the cells of a field of voxels that an interface crosses, within one cube of eight nodes after the
/// other. Distances are trilinear in a cube.
///
/// An object belongs to one thread.
class InterfaceCells {
 public:
  /// Cells as large as voxels or larger count if they overlap the cube. Smaller ones count if their corners
  /// and the middles of their edges, faces and interior belong to more than one region.
  ///
  /// \param field has the refinement 0, and must outlive the object
  /// \param smaller cells are smaller than voxels
  InterfaceCells(const MaterialField& field, bool smaller);

  /// Appends the cells of a cube; those on its border may be appended by others, too.
  ///
  /// \param low, high bounding box of the cube, cells
  void append_cells(const Vec3& low, const Vec3& high, std::vector<MortonKey>& out);

 private:
  using Cell = std::array<int, 3>;
  using Corners = std::array<NearestRegion, 8>;

  void append_range(const Cell& from, const Cell& to, std::vector<MortonKey>& out);
  /// True if a range of cells is in the cube, and its corners' region, which is the same, is certain to have
  /// all of it.
  bool is_of_one_region(const Corners& corners, const Cell& from, const Cell& to) const;
  /// True if a point in the middle of an edge, a face or the interior of a cell has another region than its
  /// corners.
  bool is_mixed_between(RegionIndex of_corners, const Cell& cell);

  const Cell cells_;
  const bool smaller_;
  const std::unique_ptr<FieldSampler> sampler_;
  Cell whole_from_{}, whole_to_{};      ///< cells that are whole in the cube
  std::vector<NearestRegion> nearest_;  ///< at the corners of a range
};

}  // namespace tetwright
