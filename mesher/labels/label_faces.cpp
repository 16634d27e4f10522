// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_faces.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "mesher/tuning/label_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Calls f(z, x, y, axis, outer) for each face between voxels of different regions that belongs to slices of
/// the volume: those of their voxels with the next one along an axis, and with the border.
/// \param f `outer` tells whether the outside is on one side
template <class F>
void for_each_face(const LabelInput& labels, std::size_t first_slice, std::size_t last_slice, const F& f) {
  const std::array<int, 3>& n = labels.size;
  const auto row = static_cast<std::size_t>(n[0]), size = row * n[1];
  std::vector<RegionIndex> slice(size), next_slice(size);
  const auto read = [&](std::size_t z, std::vector<RegionIndex>& out) {
    if (z < static_cast<std::size_t>(n[2]))
      labels.regions.read_slices(static_cast<int>(z), static_cast<int>(z + 1), out);
    else
      std::fill(out.begin(), out.end(), outside_region);
  };
  read(first_slice, slice);
  for (std::size_t z = first_slice; z < last_slice; ++z, slice.swap(next_slice)) {
    read(z + 1, next_slice);
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * row + x;
        const RegionIndex here = slice[i];
        const auto look = [&](int axis, RegionIndex next) {
          if (next != here) f(z, x, y, axis, next == outside_region || here == outside_region);
        };
        look(0, x + 1 < n[0] ? slice[i + 1] : outside_region);
        look(1, y + 1 < n[1] ? slice[i + row] : outside_region);
        look(2, next_slice[i]);
        // The first voxels along an axis also have a face to the outside on their lower side.
        if (here == outside_region) continue;
        if (x == 0) f(z, x, y, 0, true);
        if (y == 0) f(z, x, y, 1, true);
        if (z == 0) f(z, x, y, 2, true);
      }
  }
}

}  // namespace

FaceAreas face_areas(const LabelInput& labels) {
  std::vector<std::array<std::size_t, 6>> counts(static_cast<std::size_t>(labels.size[2]));
  parallel_for(0, counts.size(), LabelGrains::slices, [&](std::size_t begin, std::size_t end) {
    for_each_face(labels, begin, end, [&](std::size_t z, int, int, int axis, bool outer) {
      ++counts[z][axis + (outer ? 0 : 3)];
    });
  });
  FaceAreas areas;
  for (int a = 0; a < 3; ++a) {
    const double face = labels.directions.col((a + 1) % 3).cross(labels.directions.col((a + 2) % 3)).norm();
    for (const auto& c : counts) {
      areas.outer += face * static_cast<double>(c[a]);
      areas.inner += face * static_cast<double>(c[a + 3]);
      areas.faces += static_cast<double>(c[a] + c[a + 3]);
    }
  }
  return areas;
}

BoxFaces faces_of_boxes(const LabelInput& labels, const std::array<double, 3>& box, double offset) {
  BoxFaces faces;
  const auto box_at = [&](int voxel, std::size_t axis) {
    return static_cast<std::size_t>(voxel / box[axis] + offset);
  };
  for (std::size_t a = 0; a < 3; ++a) faces.boxes[a] = box_at(labels.size[a] - 1, a) + 1;
  const std::size_t nx = faces.boxes[0], in_layer = nx * faces.boxes[1];
  const auto slices = static_cast<std::size_t>(labels.size[2]);
  std::vector<std::vector<std::size_t>> of_slices(slices);
  parallel_for(0, slices, LabelGrains::slices, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z) of_slices[z].assign(in_layer, 0);
    for_each_face(labels, begin, end, [&](std::size_t z, int x, int y, int, bool) {
      ++of_slices[z][box_at(y, 1) * nx + box_at(x, 0)];
    });
  });
  faces.counts.assign(in_layer * faces.boxes[2], 0);
  for (std::size_t z = 0; z < slices; ++z) {
    const std::size_t first = box_at(static_cast<int>(z), 2) * in_layer;
    for (std::size_t b = 0; b < in_layer; ++b) faces.counts[first + b] += of_slices[z][b];
  }
  return faces;
}

double BoxFaces::largest_share() const {
  const std::size_t all = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  if (all == 0) return 1;
  return static_cast<double>(*std::max_element(counts.begin(), counts.end())) / static_cast<double>(all);
}

}  // namespace tetwright
