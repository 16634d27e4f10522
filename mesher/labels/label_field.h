#pragma once

#include <memory>
#include <vector>

#include "mesher/distance/material_field.h"
#include "mesher/input/label_input.h"

namespace tetwright {

/// The frame for a segmented volume: cubes of `cell_size` (input units) along the axes of the volume, made
/// perpendicular and right-handed. The centre of the first voxel is at a corner of cells, so cells of one
/// voxel, half a voxel, ... have the centres of all voxels at corners.
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

 private:
  class Sampler;
  class InterfaceFinder;
  struct Shared;

  static double band_in_cells(const Shared& shared, const GridFrame& voxels);
  LabelField(std::shared_ptr<const Shared> shared, const GridFrame& voxels, std::vector<FieldRegion> regions,
             int refinement);

  std::shared_ptr<const Shared> shared_;
  Eigen::Matrix3d to_nodes_;  ///< lattice units to nodes
  Vec3 first_node_;           ///< the lattice's origin, in nodes
};

}  // namespace tetwright
