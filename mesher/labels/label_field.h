// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "mesher/domain/material_field.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// The frame for a segmented volume. Its box ends exactly at the volume's border, half a voxel beyond the
/// outermost centres, and its axes are the volume's, right-handed. Cells are cubes of `cell_size` if whole
/// ones fill the box and the axes are perpendicular; otherwise nearly so. Lattice points, the corners and
/// centres of cells, coincide with voxel centres where cells are one voxel, half a voxel, ...
/// \param cell_size input units
GridFrame label_frame(const LabelInput& labels, double cell_size, bool uniform);

/// The length of a voxel: the smallest of the three spacings, input units.
double voxel_size(const LabelInput& labels);

/// Whether cells are so much larger than voxels that the field has a distance_transform(), a byte for each
/// voxel.
///
/// \param cell_size input units
bool needs_depths(const LabelInput& labels, double cell_size);

/// The field of a segmented volume or of an image; see LabelSmoother and make_image_bricks() for how its
/// distances are computed.
///
/// Distances are measured in index space, with each axis in its own spacing, and multiplied by the smallest
/// spacing; they are clamped to about two voxels. They are stored in bricks of 8 x 8 x 8 cells between voxel
/// centres, each with only the labels near it.
class LabelField final : public MaterialField, private VoxelVolume {
 public:
  /// \param frame from label_frame(), or a continued one
  /// \param keep_outside region 0 has the outside's name
  /// \throws InputError and Interrupted as make_label_bricks() does
  static std::shared_ptr<const LabelField> make(const LabelInput& labels, const GridFrame& frame,
                                                bool keep_outside, Progress* progress);
  ~LabelField() override;

  std::unique_ptr<FieldSampler> sampler() const override;
  std::shared_ptr<const MaterialField> refined(int refinement) const override;
  std::vector<MortonKey> interface_voxels() const override;
  std::vector<LeafOrigin> band_leaves(RegionIndex region) const override;
  const VoxelVolume* volume() const override { return this; }

 private:
  class Sampler;
  struct Shared;

  /// True at voxel centres of a segmented volume, provided that cells are at most half a voxel.
  bool is_certain(const Vec3& point) const override;
  static double band_in_cells(const Shared& shared, const GridFrame& voxels);
  LabelField(std::shared_ptr<const Shared> shared, const GridFrame& voxels, std::vector<FieldRegion> regions,
             int refinement);

  /// Converts from lattice units.
  Vec3 to_nodes(const Vec3& point) const;
  /// True if the volume's border passes through a brick.
  bool is_at_border(const std::array<int, 3>& brick) const;

  std::shared_ptr<const Shared> shared_;
  Vec3 nodes_per_unit_;  ///< along each axis of the lattice
};

}  // namespace tetwright
