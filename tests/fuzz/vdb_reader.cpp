// SPDX-License-Identifier: Apache-2.0

// Fuzzes the reader of .vdb files. OpenVDB trusts all sizes, so it must receive only data validated by
// split_vdb(). The result is a surface or a volume, or an InputError.
#include <stdexcept>

#include "mesher/level_sets/openvdb_grids.h"
#include "mesher/level_sets/vdb_structure.h"
#include "tests/fuzz/targets.h"
#include "tetwright/error.h"

namespace tetwright::fuzz {

void run_vdb(std::string_view bytes) {
  constexpr std::size_t max_voxels = 1'000'000;
  std::vector<VdbGrid> grids;
  try {
    grids = split_vdb(bytes);
  } catch (const std::runtime_error&) {  // the caller adds the file's name
    return;
  }
  for (VdbGrid& grid : grids) {
    if (grid.alone.empty()) continue;
    try {
      if (grid.type == "float" || grid.type == "double") {
        const TriangleMesh surface = DistanceGrid::from_vdb(grid, "fuzz").zero_surface();
        for (const Triangle& t : surface.triangles)
          for (const Index v : t) TETWRIGHT_CHECK(v < surface.points.size());
      } else {
        const LabelVolume volume = labels_from_vdb(grid, max_voxels, "fuzz");
        TETWRIGHT_CHECK(volume.labels.size() <= max_voxels);
      }
    } catch (const InputError&) {
    } catch (const std::domain_error&) {  // an invalid transform
    }
  }
}

}  // namespace tetwright::fuzz
