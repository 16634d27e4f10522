#pragma once

#include <memory>
#include <vector>

#include "mesher/label_input.h"
#include "mesher/material_field.h"

namespace tetwright {

/// Where the cells of a segmented volume lie: cubes of `cell_size` (input units) along the axes of the
/// volume, as far as those are perpendicular, with the centre of the first voxel at a corner of cells, so
/// that cells of one voxel, half of one, ... have the centres of all voxels at their corners. The axes are
/// right-handed also where the volume's are not.
GridFrame label_frame(const PreparedLabels& labels, double cell_size, bool uniform);

/// The smallest of the three spacings: what is called a voxel where a length is meant.
double voxel_size(const PreparedLabels& labels);

/// The field of a segmented volume; see LabelSmoother for how distances come about.
///
/// They are distances in index space, each axis in its own spacing, times the smallest spacing; beyond some
/// two voxels they are cut off. Kept in blocks of 8 x 8 x 8 cells between voxel centres, each with the labels
/// that come near it: labels far apart cost nothing.
class LabelField final : public MaterialField {
 public:
  /// `frame` is label_frame()'s. With `keep_outside` region 0 bears the outside's name. Throws Interrupted.
  static std::shared_ptr<const LabelField> make(const PreparedLabels& labels, const GridFrame& frame,
                                                bool keep_outside, Progress* progress);
  ~LabelField() override;

  std::unique_ptr<FieldSampler> sampler() const override;
  std::shared_ptr<const MaterialField> refined(int refinement) const override;
  std::vector<MortonKey> interface_voxels() const override;
  std::vector<LeafOrigin> band_leaves(RegionIndex region) const override;
  bool knows_sheets() const override { return false; }
  /// The centres of voxels, if cells are small enough that each has a point near its own.
  bool is_certain(const Vec3& point) const override;

 private:
  class Sampler;
  struct Shared;

  static double band_in_cells(const Shared& shared, const GridFrame& voxels);
  LabelField(std::shared_ptr<const Shared> shared, const GridFrame& voxels, std::vector<FieldRegion> regions,
             int refinement);

  std::shared_ptr<const Shared> shared_;
  Eigen::Matrix3d to_nodes_;  ///< lattice units to nodes
  Vec3 first_node_;           ///< where the lattice's origin is, in nodes
};

}  // namespace tetwright
