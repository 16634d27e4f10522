// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mesher/complex/contact_zone.h"
#include "mesher/complex/sheet_zone.h"
#include "mesher/domain/material_field.h"
#include "mesher/level_sets/level_set.h"

namespace tetwright {

/// A term of a region's signed distance, which is the maximum of its terms: a level set or its negative.
struct RegionTerm {
  std::uint16_t level_set;
  bool negated;
  /// Level sets of one body are exact offsets of each other; those of different bodies may touch.
  std::uint16_t body = 0;
  bool offset = false;  ///< an offset of the body's surface, by which layers are cut
  bool operator==(const RegionTerm&) const = default;
};

struct LevelSetRegion {
  std::string name;
  MaterialTag tag = 0;
  std::vector<RegionTerm> terms;
  RegionIndex of_complex = 0;  ///< its body's number in a LabelledComplex
};

/// The field of surfaces: level sets on voxels, and regions as combinations of them.
class LevelSetField final : public MaterialField, private WallChanges {
 public:
  /// \param voxels frame of the level sets
  /// \param regions the first is the outside
  /// \param zone where bodies meet, or null: there regions are decided by the triangles
  /// \param sheets inside regions, or null; they change no distance
  LevelSetField(const GridFrame& voxels, std::vector<std::shared_ptr<const LevelSet>> level_sets,
                std::vector<LevelSetRegion> regions, std::shared_ptr<const ContactZone> zone = {},
                std::shared_ptr<const SheetZone> sheets = {}, int refinement = 0);
  ~LevelSetField() override;

  std::unique_ptr<FieldSampler> sampler() const override;
  std::shared_ptr<const MaterialField> refined(int refinement) const override;
  std::vector<MortonKey> interface_voxels() const override;
  std::vector<LeafOrigin> band_leaves(RegionIndex region) const override;
  const WallChanges* wall_changes() const override;
  const SheetZone* sheets() const override { return sheets_.get(); }

  const std::vector<std::shared_ptr<const LevelSet>>& level_sets() const { return level_sets_; }
  const std::vector<LevelSetRegion>& level_set_regions() const { return level_set_regions_; }
  const std::vector<RegionTerm>& terms(RegionIndex region) const { return level_set_regions_[region].terms; }
  /// The number of a region's terms before those it shares with the outside. Later bodies carve all earlier
  /// ones, so a region's last terms are the last ones of the outside.
  std::size_t own_terms(RegionIndex region) const { return own_terms_[region]; }
  const ContactZone* zone() const { return zone_.get(); }
  /// Whether layers are cut from the first body; if not, regions have their numbers in the complex.
  bool has_layers() const { return has_layers_; }

 private:
  class Sampler;

  std::shared_ptr<const MaterialField> with_true_walls() const override;
  bool contains(const Vec3& point) const override;
  double parallel_thickness(const Vec3& point) const override;

  std::vector<std::shared_ptr<const LevelSet>> level_sets_;
  std::vector<LevelSetRegion> level_set_regions_;
  std::vector<std::size_t> own_terms_;  ///< by region
  std::shared_ptr<const ContactZone> zone_;
  std::shared_ptr<const SheetZone> sheets_;
  bool has_layers_ = false;
};

}  // namespace tetwright
