// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "mesher/domain/material_field.h"
#include "mesher/level_sets/vdb_writer.h"
#include "tetwright/mesher.h"

namespace tetwright {

void write_fields(const MaterialField& field, const std::string& path, OutputFiles* files) {
  const std::shared_ptr<const MaterialField> on_voxels = field.refined(0);
  std::vector<LevelSetSource> sources;
  for (std::size_t r = 1; r < field.regions().size(); ++r) {
    const FieldRegion& region = field.regions()[r];
    LevelSetSource source;
    source.name = region.name;
    source.leaves = field.band_leaves(static_cast<RegionIndex>(r));
    source.distances = [on_voxels, number = static_cast<RegionIndex>(r)](const LeafOrigin& leaf,
                                                                         std::span<float, leaf_points> out) {
      const std::unique_ptr<FieldSampler> sampler = on_voxels->sampler();
      for (int i = 0; i < leaf_points; ++i) {
        const int x = leaf[0] + i / (leaf_side * leaf_side), y = leaf[1] + i / leaf_side % leaf_side,
                  z = leaf[2] + i % leaf_side;
        // A region's own distance need not reach 0 where it meets others, and in a thin region it may be
        // positive everywhere.
        const NearestRegion there = sampler->nearest_at_voxel(x, y, z);
        std::array<float, 2> both;
        sampler->values_at_voxel(x, y, z, std::array{number, there.region}, both.data());
        float& distance = out[static_cast<std::size_t>(i)];
        distance = there.region == number ? -there.margin : 0.5F * (both[0] - both[1]);
        if (!on_voxels->volume()) continue;
        const auto band = static_cast<float>(on_voxels->band());
        const std::array<int, 3> at{x, y, z};
        for (std::size_t a = 0; a < 3; ++a)
          distance = std::clamp(
              std::max(distance, static_cast<float>(std::max(-at[a], at[a] - on_voxels->frame().box[a]))),
              -band, band);
      }
    };
    sources.push_back(std::move(source));
  }
  write_level_sets(path, field.voxels(), on_voxels->band(), sources, files);
}

}  // namespace tetwright
