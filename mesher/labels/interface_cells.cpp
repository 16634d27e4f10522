// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/interface_cells.h"

#include <algorithm>
#include <cmath>

#include "common/tolerances.h"
#include "mesher/tuning/label_tuning.h"

namespace tetwright {

namespace {

template <class Use>
void for_each_in(const std::array<int, 3>& from, const std::array<int, 3>& to, const Use& use) {
  for (int z = from[2]; z < to[2]; ++z)
    for (int y = from[1]; y < to[1]; ++y)
      for (int x = from[0]; x < to[0]; ++x) use(x, y, z);
}

bool have_one_region(const std::array<NearestRegion, 8>& corners) {
  return std::all_of(corners.begin(), corners.end(),
                     [&](const NearestRegion& corner) { return corner.region == corners[0].region; });
}

}  // namespace

InterfaceCells::InterfaceCells(const MaterialField& field, bool smaller)
    : cells_(field.voxels().box), smaller_(smaller), sampler_(field.sampler()) {}

void InterfaceCells::append_cells(const Vec3& low, const Vec3& high, std::vector<MortonKey>& out) {
  constexpr double slack = tolerance::coinciding_cells;
  Cell from, to;
  for (int a = 0; a < 3; ++a) {
    from[a] = std::max(0, static_cast<int>(std::floor(low[a] + slack)));
    to[a] = std::min(cells_[a], static_cast<int>(std::ceil(high[a] - slack)));
    if (from[a] >= to[a]) return;
    whole_from_[a] = static_cast<int>(std::ceil(low[a] - slack));
    whole_to_[a] = static_cast<int>(std::floor(high[a] + slack));
  }
  if (smaller_)
    append_range(from, to, out);
  else
    for_each_in(from, to, [&](int x, int y, int z) { out.push_back(morton_encode(x, y, z)); });
}

void InterfaceCells::append_range(const Cell& from, const Cell& to, std::vector<MortonKey>& out) {
  Corners corners;
  int longest = 0;
  for (int a = 1; a < 3; ++a)
    if (to[a] - from[a] > to[longest] - from[longest]) longest = a;
  if (to[longest] - from[longest] > LabelTuning::Field::small_range) {
    for (int k = 0; k < 8; ++k)
      corners[k] = sampler_->nearest_at_voxel(k & 1 ? to[0] : from[0], k & 2 ? to[1] : from[1],
                                              k & 4 ? to[2] : from[2]);
    if (is_of_one_region(corners, from, to)) return;
    Cell middle_to = to, middle_from = from;
    middle_to[longest] = middle_from[longest] = (from[longest] + to[longest]) / 2;
    append_range(from, middle_to, out);
    append_range(middle_from, to, out);
    return;
  }
  // Cells share their corners.
  nearest_.clear();
  for_each_in(from, {to[0] + 1, to[1] + 1, to[2] + 1},
              [&](int x, int y, int z) { nearest_.push_back(sampler_->nearest_at_voxel(x, y, z)); });
  const int row = to[0] - from[0] + 1, slice = row * (to[1] - from[1] + 1);
  for_each_in(from, to, [&](int x, int y, int z) {
    const int first = (z - from[2]) * slice + (y - from[1]) * row + x - from[0];
    for (int k = 0; k < 8; ++k) {
      const int corner = first + (k & 1) + (k >> 1 & 1) * row + (k >> 2) * slice;
      corners[k] = nearest_[static_cast<std::size_t>(corner)];
    }
    if (is_of_one_region(corners, {x, y, z}, {x + 1, y + 1, z + 1})) return;
    if (!have_one_region(corners) || is_mixed_between(corners[0].region, {x, y, z}))
      out.push_back(morton_encode(x, y, z));
  });
}

bool InterfaceCells::is_of_one_region(const Corners& corners, const Cell& from, const Cell& to) const {
  for (int a = 0; a < 3; ++a)
    if (from[a] < whole_from_[a] || to[a] > whole_to_[a]) return false;
  // How much nearer one region is than another is trilinear in the cube, and so smallest at a corner of a box
  // in it: a region that leads at all corners leads everywhere between.
  return have_one_region(corners) && std::all_of(corners.begin(), corners.end(), [](const NearestRegion& at) {
           return at.margin > LabelTuning::Field::min_certain_lead;
         });
}

bool InterfaceCells::is_mixed_between(RegionIndex of_corners, const Cell& cell) {
  for (int k = 1; k < 27; ++k) {
    const int dx = k % 3, dy = k / 3 % 3, dz = k / 9;  // half voxels
    if (dx % 2 == 0 && dy % 2 == 0 && dz % 2 == 0) continue;
    if (sampler_->nearest(Vec3(cell[0] + 0.5 * dx, cell[1] + 0.5 * dy, cell[2] + 0.5 * dz)).region !=
        of_corners)
      return true;
  }
  return false;
}

}  // namespace tetwright
