// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_faces.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Calls f(x, y, axis, outer) for each face between voxels of different regions that belongs to a slice of
/// the volume: those of its voxels with the next one along an axis, and with the border.
/// \param f `outer` tells whether the outside is on one side
template <class F>
void for_each_face(const LabelInput& labels, std::size_t z, const F& f) {
  const std::array<int, 3>& n = labels.size;
  const auto row = static_cast<std::size_t>(n[0]), slice = row * n[1];
  for (int y = 0; y < n[1]; ++y)
    for (int x = 0; x < n[0]; ++x) {
      const std::size_t i = z * slice + static_cast<std::size_t>(y) * row + x;
      const RegionIndex here = labels.regions[i];
      const auto look = [&](int axis, bool there, std::size_t step) {
        const RegionIndex next = there ? labels.regions[i + step] : outside_region;
        if (next != here) f(x, y, axis, next == outside_region || here == outside_region);
      };
      look(0, x + 1 < n[0], 1);
      look(1, y + 1 < n[1], row);
      look(2, z + 1 < static_cast<std::size_t>(n[2]), slice);
      // The first voxels along an axis also have a face to the outside on their lower side.
      if (here == outside_region) continue;
      if (x == 0) f(x, y, 0, true);
      if (y == 0) f(x, y, 1, true);
      if (z == 0) f(x, y, 2, true);
    }
}

}  // namespace

FaceAreas face_areas(const LabelInput& labels) {
  std::vector<std::array<std::size_t, 6>> counts(static_cast<std::size_t>(labels.size[2]));
  parallel_for(0, counts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z) {
      counts[z] = {};
      for_each_face(labels, z, [&](int, int, int axis, bool outer) { ++counts[z][axis + (outer ? 0 : 3)]; });
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

BoxFaces faces_of_boxes(const LabelInput& labels, const std::array<double, 3>& box) {
  BoxFaces faces;
  for (int a = 0; a < 3; ++a) faces.boxes[a] = static_cast<std::size_t>((labels.size[a] - 1) / box[a]) + 1;
  const std::size_t nx = faces.boxes[0], in_layer = nx * faces.boxes[1];
  const auto slices = static_cast<std::size_t>(labels.size[2]);
  std::vector<std::vector<std::size_t>> of_slices(slices);
  parallel_for(0, slices, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z) {
      of_slices[z].assign(in_layer, 0);
      for_each_face(labels, z, [&](int x, int y, int, bool) {
        ++of_slices[z][static_cast<std::size_t>(y / box[1]) * nx + static_cast<std::size_t>(x / box[0])];
      });
    }
  });
  faces.counts.assign(in_layer * faces.boxes[2], 0);
  for (std::size_t z = 0; z < slices; ++z) {
    const std::size_t first = static_cast<std::size_t>(static_cast<double>(z) / box[2]) * in_layer;
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
