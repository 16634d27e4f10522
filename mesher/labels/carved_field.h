// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mesher/domain/material_field.h"
#include "mesher/labels/label_field.h"

namespace tetwright {

/// The field of a segmented volume whose labels bodies carve: implants, electrodes, tools.
///
/// Its regions are those of the volume, followed by those of the bodies without their outside. A point inside
/// a body belongs to that body, unless its label is protected; all others have their label. So the sharp
/// edges of bodies are those of their own level sets, and labels end exactly there.
///
/// Distances of labels are those from their interfaces, half the difference between the label's distance and
/// the smallest other one, and inside bodies increase with the depth there; so at most one of the two fields
/// decides at a point, and the second nearest region is the one across the nearest interface.
class CarvedField final : public MaterialField, private WallChanges, private VoxelVolume {
 public:
  /// \param labels, bodies on the same voxels, with the same refinement; `bodies` have no sheets
  /// \param is_protected a flag for each region of `labels`: bodies do not carve it; or empty
  static std::shared_ptr<const CarvedField> make(std::shared_ptr<const LabelField> labels,
                                                 std::shared_ptr<const MaterialField> bodies,
                                                 std::vector<std::uint8_t> is_protected);
  ~CarvedField() override;

  std::unique_ptr<FieldSampler> sampler() const override;
  std::shared_ptr<const MaterialField> refined(int refinement) const override;
  std::vector<MortonKey> interface_voxels() const override;
  std::vector<LeafOrigin> band_leaves(RegionIndex region) const override;
  const WallChanges* wall_changes() const override { return bodies_->wall_changes() ? this : nullptr; }
  const VoxelVolume* volume() const override { return this; }

 private:
  class Sampler;
  struct Rules;

  CarvedField(std::shared_ptr<const MaterialField> labels, std::shared_ptr<const MaterialField> bodies,
              std::shared_ptr<const Rules> rules);

  std::shared_ptr<const MaterialField> with_true_walls() const override;
  bool contains(const Vec3& point) const override { return bodies_->wall_changes()->contains(point); }
  double parallel_thickness(const Vec3& point) const override {
    return bodies_->wall_changes()->parallel_thickness(point);
  }
  /// Where `labels` are certain, unless a body is near.
  bool is_certain(const Vec3& point) const override;

  std::shared_ptr<const MaterialField> labels_, bodies_;
  std::shared_ptr<const Rules> rules_;
};

}  // namespace tetwright
