// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
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
/// In a thin layer around bodies labels continue from its outer side along the normals, so that their
/// interfaces meet bodies at right angles: interfaces that run along a body as closely as a fraction of a
/// cell would leave slivers there, although they are known to half a voxel only. Beside protected labels
/// there is no layer.
///
/// The distance of a label exceeds that of the outside of all bodies by what its own distance exceeds the
/// smallest one of a label. So the difference between a body and the label around it is that of the body and
/// its outside, and between two labels their own: no interface moves where others are near.
class CarvedField final : public MaterialField, private WallChanges, private VoxelVolume {
 public:
  /// \param labels, bodies on the same voxels, with the same refinement; `bodies` have no sheets
  /// \param layer its thickness, voxels of the frame
  /// \param is_protected a flag for each region of `labels`: bodies do not carve it; or empty
  /// \param crossed the sides of the volume that bodies cross, bits as for box_faces(): they are whole there,
  ///   while everything else ends at the border
  static std::shared_ptr<const CarvedField> make(std::shared_ptr<const LabelField> labels,
                                                 std::shared_ptr<const MaterialField> bodies,
                                                 std::vector<std::uint8_t> is_protected, double layer,
                                                 unsigned crossed = 0);
  ~CarvedField() override;

  std::unique_ptr<FieldSampler> sampler() const override;
  std::shared_ptr<const MaterialField> refined(int refinement) const override;
  std::vector<MortonKey> interface_voxels() const override;
  std::vector<LeafOrigin> band_leaves(RegionIndex region) const override;
  /// The faces of a body beside the outside are its own also beyond the border, where labels continue here.
  std::optional<Vec3> project(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                              double max_distance) const override;
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
  bool leaves_out(RegionIndex region, const Vec3& point) const override;
  bool is_far_beyond(const Vec3& point) const override;
  bool crosses_border(MaterialTag material) const override;
  bool is_near_bodies(const Vec3& point) const;

  std::shared_ptr<const MaterialField> labels_, bodies_;
  std::shared_ptr<const Rules> rules_;
};

}  // namespace tetwright
