// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/voxel_source.h"

#include "common/whole_volume.h"

namespace tetwright {

ImageVolume read_all_values(const VoxelSource& source, const std::string& file) {
  return {source.grid(),
          read_whole<float>(source, static_cast<std::size_t>(source.channels()), file, "values",
                            [&](const VoxelIndex& low, const VoxelIndex& high, std::size_t first,
                                std::span<const std::span<float>> out) {
                              source.read_channels(low, high, static_cast<std::int64_t>(first), out);
                            })};
}

}  // namespace tetwright
