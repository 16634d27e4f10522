// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "mesher/distance/material_field.h"
#include "mesher/input/label_input.h"

namespace tetwright {

/// The frame for a segmented volume: its box ends exactly at the volume's border, half a voxel beyond the
/// outermost centres, and its axes are the volume's, right-handed. Cells are cubes of `cell_size` (input
/// units) as far as whole ones fill the box and the axes are perpendicular. The lattice, which has points at
/// corners and centres of cells, has them at the centres of voxels where cells are one voxel, half a voxel,
/// ...
GridFrame label_frame(const LabelInput& labels, double cell_size, bool uniform);

/// The smallest of the three spacings, input units: the length of a voxel.
double voxel_size(const LabelInput& labels);

/// The field of a segmented volume; see LabelSmoother for how its distances are computed.
///
/// Distances are measured in index space, with each axis in its own spacing, and multiplied by the smallest
/// spacing; they are clamped to about two voxels. They are stored in bricks of 8 x 8 x 8 cells between voxel
/// centres, each with the labels near it only.
class LabelField final : public MaterialField {
 public:
  /// `frame` must be from label_frame(). With `keep_outside` region 0 has the outside's name. Throws as
  /// make_label_bricks() does.
  static std::shared_ptr<const LabelField> make(const LabelInput& labels, const GridFrame& frame,
                                                bool keep_outside, Progress* progress);
  ~LabelField() override;

  std::unique_ptr<FieldSampler> sampler() const override;
  std::shared_ptr<const MaterialField> refined(int refinement) const override;
  std::vector<MortonKey> interface_voxels() const override;
  std::vector<LeafOrigin> band_leaves(RegionIndex region) const override;
  bool knows_sheets() const override { return false; }
  /// True at the centres of voxels, provided that cells are at most half a voxel.
  bool is_certain(const Vec3& point) const override;
  bool ends_at_box() const override { return true; }

 private:
  class Sampler;
  class InterfaceFinder;
  struct Shared;

  static double band_in_cells(const Shared& shared, const GridFrame& voxels);
  LabelField(std::shared_ptr<const Shared> shared, const GridFrame& voxels, std::vector<FieldRegion> regions,
             int refinement);

  /// From lattice units.
  Vec3 to_nodes(const Vec3& point) const;
  /// Whether the volume's border passes through a brick.
  bool is_at_border(const std::array<int, 3>& brick) const;

  std::shared_ptr<const Shared> shared_;
  Vec3 nodes_per_unit_;  ///< along each axis of the lattice
};

}  // namespace tetwright
