// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_faces.h"

#include <array>
#include <vector>

#include "tetwright/resources.h"

namespace tetwright {

FaceAreas face_areas(const LabelInput& labels) {
  const std::array<int, 3>& n = labels.size;
  std::vector<std::array<std::size_t, 6>> counts(static_cast<std::size_t>(n[2]));
  parallel_for(0, counts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z) {
      counts[z] = {};
      const auto row = static_cast<std::size_t>(n[0]), slice = row * n[1];
      for (int y = 0; y < n[1]; ++y)
        for (int x = 0; x < n[0]; ++x) {
          const std::size_t i = z * slice + static_cast<std::size_t>(y) * row + x;
          const RegionIndex here = labels.regions[i];
          const auto add = [&](int axis, bool there, std::size_t step) {
            const RegionIndex next = there ? labels.regions[i + step] : outside_region;
            if (next != here) ++counts[z][axis + (next == outside_region || here == outside_region ? 0 : 3)];
          };
          add(0, x + 1 < n[0], 1);
          add(1, y + 1 < n[1], row);
          add(2, z + 1 < counts.size(), slice);
          // The first voxels along an axis also have a face to the outside on their lower side.
          if (here != outside_region) {
            counts[z][0] += x == 0;
            counts[z][1] += y == 0;
            counts[z][2] += z == 0;
          }
        }
    }
  });
  FaceAreas areas;
  for (int a = 0; a < 3; ++a) {
    const double face = labels.directions.col((a + 1) % 3).cross(labels.directions.col((a + 2) % 3)).norm();
    for (const auto& c : counts) {
      areas.outer += face * static_cast<double>(c[a]);
      areas.inner += face * static_cast<double>(c[a + 3]);
    }
  }
  return areas;
}

}  // namespace tetwright
