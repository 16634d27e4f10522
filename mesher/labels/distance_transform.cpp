// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/distance_transform.h"

#include <algorithm>
#include <cmath>

namespace tetwright {

namespace {

constexpr int max_steps = 255;
/// From a voxel's centre to its face, rounded.
constexpr int half_voxel = 1;

/// A neighbour of a voxel that precedes it in voxel order, and its distance in steps.
struct Neighbour {
  std::array<int, 3> by;
  int steps;
};
constexpr std::array<Neighbour, 13> earlier{{{{-1, 0, 0}, 3},
                                             {{-1, -1, 0}, 4},
                                             {{0, -1, 0}, 3},
                                             {{1, -1, 0}, 4},
                                             {{-1, -1, -1}, 5},
                                             {{0, -1, -1}, 4},
                                             {{1, -1, -1}, 5},
                                             {{-1, 0, -1}, 4},
                                             {{0, 0, -1}, 3},
                                             {{1, 0, -1}, 4},
                                             {{-1, 1, -1}, 5},
                                             {{0, 1, -1}, 4},
                                             {{1, 1, -1}, 5}}};

}  // namespace

DistanceTransform distance_transform(const LabelInput& labels) {
  const std::array<int, 3>& n = labels.size;
  DistanceTransform depths{n, std::vector<std::uint8_t>(labels.voxel_count(), max_steps)};
  const auto step_y = static_cast<std::ptrdiff_t>(n[0]), step_z = step_y * n[1];
  std::vector<RegionIndex> slice(static_cast<std::size_t>(step_z)), slice_before(slice.size());
  const auto visit = [&](int x, int y, int z, int direction) {
    const std::ptrdiff_t i = y * step_y + x;
    const RegionIndex own = slice[i];
    int min_steps = depths.steps[z * step_z + i];
    for (const Neighbour& k : earlier) {
      const int nx = x + direction * k.by[0], ny = y + direction * k.by[1], nz = z + direction * k.by[2];
      const bool inside = nx >= 0 && ny >= 0 && nz >= 0 && nx < n[0] && ny < n[1] && nz < n[2];
      if (!inside) continue;
      const std::ptrdiff_t j = ny * step_y + nx;
      const RegionIndex region = nz == z ? slice[j] : slice_before[j];
      min_steps = std::min(min_steps, region != own ? k.steps : depths.steps[nz * step_z + j] + k.steps);
    }
    depths.steps[z * step_z + i] = static_cast<std::uint8_t>(min_steps);
  };
  for (int z = 0; z < n[2]; ++z, slice.swap(slice_before)) {
    labels.regions.read_slices(z, z + 1, slice);
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) visit(x, y, z, 1);
  }
  for (int z = n[2] - 1; z >= 0; --z, slice.swap(slice_before)) {
    labels.regions.read_slices(z, z + 1, slice);
    for (int y = n[1] - 1; y >= 0; --y)
      for (int x = n[0] - 1; x >= 0; --x) visit(x, y, z, -1);
  }
  for (std::uint8_t& s : depths.steps) s = static_cast<std::uint8_t>(s - half_voxel);
  return depths;
}

double DistanceTransform::at(const Vec3& index, Vec3& gradient) const {
  std::array<int, 3> low;
  Vec3 share;
  for (int a = 0; a < 3; ++a) {
    const double x = std::clamp(index[a], 0.0, static_cast<double>(size[a] - 1));
    low[a] = std::clamp(static_cast<int>(x), 0, std::max(0, size[a] - 2));
    share[a] = x - low[a];
  }
  double value[8];
  for (int k = 0; k < 8; ++k) {
    std::array<int, 3> at;
    for (int a = 0; a < 3; ++a) at[a] = std::min(low[a] + (k >> a & 1), size[a] - 1);
    value[k] = steps[(static_cast<std::size_t>(at[2]) * size[1] + at[1]) * size[0] + at[0]];
  }
  const auto weight = [&](int axis, int upper) { return upper ? share[axis] : 1 - share[axis]; };
  double sum = 0;
  gradient = Vec3::Zero();
  for (int k = 0; k < 8; ++k) {
    const double w[3] = {weight(0, k & 1), weight(1, k >> 1 & 1), weight(2, k >> 2)};
    sum += w[0] * w[1] * w[2] * value[k];
    gradient += value[k] * Vec3((k & 1 ? 1 : -1) * w[1] * w[2], (k >> 1 & 1 ? 1 : -1) * w[0] * w[2],
                                (k >> 2 ? 1 : -1) * w[0] * w[1]);
  }
  gradient /= steps_per_voxel;
  return sum / steps_per_voxel;
}

}  // namespace tetwright
