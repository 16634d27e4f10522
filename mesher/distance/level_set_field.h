// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mesher/distance/level_set.h"
#include "mesher/distance/material_field.h"

namespace tetwright {

/// A term of a region's signed distance, which is the maximum of its terms: a level set or its negative.
struct RegionTerm {
  std::uint16_t level_set;
  bool negated;
  /// Level sets of one body are exact offsets of each other; those of different bodies may touch.
  std::uint16_t body = 0;
  bool operator==(const RegionTerm&) const = default;
};

struct LevelSetRegion {
  std::string name;
  MaterialTag tag = 0;
  std::vector<RegionTerm> terms;
};

/// The field of surfaces: level sets on voxels, and regions as combinations of them.
class LevelSetField final : public MaterialField {
 public:
  /// \param voxels frame of the level sets
  /// \param regions the first is the outside
  LevelSetField(const GridFrame& voxels, std::vector<std::shared_ptr<const LevelSet>> level_sets,
                std::vector<LevelSetRegion> regions, int refinement = 0);
  ~LevelSetField() override;

  std::unique_ptr<FieldSampler> sampler() const override;
  std::shared_ptr<const MaterialField> refined(int refinement) const override;
  std::vector<MortonKey> interface_voxels() const override;
  std::vector<LeafOrigin> band_leaves(RegionIndex region) const override;
  bool knows_sheets() const override { return level_sets_.size() > 1; }
  bool is_certain(const Vec3&) const override { return false; }
  std::shared_ptr<const MaterialField> with_true_walls() const override;
  bool changes_walls(const Vec3& point) const override;
  double parallel_thickness(const Vec3& point) const override;

  const std::vector<std::shared_ptr<const LevelSet>>& level_sets() const { return level_sets_; }
  const std::vector<RegionTerm>& terms(RegionIndex region) const { return level_set_regions_[region].terms; }
  /// The number of a region's terms before those it shares with the outside. Later bodies carve all earlier
  /// ones, so a region's last terms are the last ones of the outside.
  std::size_t own_terms(RegionIndex region) const { return own_terms_[region]; }

 private:
  class Sampler;

  std::vector<std::shared_ptr<const LevelSet>> level_sets_;
  std::vector<LevelSetRegion> level_set_regions_;
  std::vector<std::size_t> own_terms_;  ///< by region
};

}  // namespace tetwright
