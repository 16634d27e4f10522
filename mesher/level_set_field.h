#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mesher/level_set.h"
#include "mesher/material_field.h"

namespace tetwright {

/// A region's signed distance is the largest of its terms: level sets, or their negatives.
struct RegionTerm {
  std::uint16_t level_set;
  bool negated;
  std::uint16_t body = 0;  ///< level sets of one body are exact offsets of each other, those of two may touch
};

struct LevelSetRegion {
  std::string name;
  MaterialTag tag = 0;
  std::vector<RegionTerm> terms;
};

/// The field of surfaces: level sets on their voxels, one finest cell each, and regions made of them.
class LevelSetField final : public MaterialField {
 public:
  /// `regions[0]` is outside. `voxels` is the frame of the level sets.
  LevelSetField(const GridFrame& voxels, std::vector<std::shared_ptr<const LevelSet>> level_sets,
                std::vector<LevelSetRegion> regions, int refinement = 0);
  ~LevelSetField() override;

  std::unique_ptr<FieldSampler> sampler() const override;
  std::shared_ptr<const MaterialField> refined(int refinement) const override;
  std::vector<MortonKey> interface_voxels() const override;
  std::vector<LeafOrigin> band_leaves(RegionIndex region) const override;
  bool knows_sheets() const override { return level_sets_.size() > 1; }
  bool is_certain(const Vec3&) const override { return false; }

  const std::vector<std::shared_ptr<const LevelSet>>& level_sets() const { return level_sets_; }
  const std::vector<RegionTerm>& terms(RegionIndex region) const { return level_set_regions_[region].terms; }

 private:
  class Sampler;

  std::vector<std::shared_ptr<const LevelSet>> level_sets_;
  std::vector<LevelSetRegion> level_set_regions_;
};

}  // namespace tetwright
