// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/border_creases.h"

#include <array>

namespace tetwright {

CreaseCurves border_creases(const LabelInput& labels) {
  CreaseCurves creases;
  const std::array<int, 3>& n = labels.size;
  const auto to_input = [&](const Vec3& index) -> Vec3 { return labels.origin + labels.directions * index; };
  for (int axis = 0; axis < 3; ++axis)
    for (int edge = 0; edge < 4; ++edge) {
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      const bool upper_b = edge & 1, upper_c = edge >> 1;
      const auto region = [&](int i) {
        VoxelIndex at{};
        at[axis] = i;
        at[b] = upper_b ? n[b] - 1 : 0;
        at[c] = upper_c ? n[c] - 1 : 0;
        return labels.regions.at(at[0], at[1], at[2]);
      };
      const auto place = [&](double i) {
        Vec3 index;
        index[axis] = i;
        index[b] = upper_b ? n[b] - 0.5 : -0.5;
        index[c] = upper_c ? n[c] - 0.5 : -0.5;
        return to_input(index);
      };
      for (int i = 0, j; i < n[axis]; i = j) {
        for (j = i + 1; j < n[axis] && region(j) == region(i);) ++j;
        if (region(i) == outside_region) continue;
        // Smoothing moves the ends of labels, so skip the last voxel.
        const double from = i == 0 ? -0.5 : i + 0.5, to = j == n[axis] ? j - 0.5 : j - 1.5;
        if (to <= from) continue;
        const auto first = static_cast<Index>(creases.points.size());
        creases.points.push_back(place(from));
        creases.points.push_back(place(to));
        creases.segments.push_back({first, first + 1});
        if (axis > 0) continue;  // each corner ends one edge along the first axis
        if (i == 0) creases.corners.push_back(place(from));
        if (j == n[axis]) creases.corners.push_back(place(to));
      }
    }
  return creases;
}

}  // namespace tetwright
