// SPDX-License-Identifier: Apache-2.0
#include "common/images/nearest_voxels.h"

#include <algorithm>
#include <array>
#include <limits>

#include "common/geometry/morton.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

constexpr int block_edge = 8;  // voxels: small enough to search, large enough that blocks are few
constexpr std::size_t blocks_grain = 64, blocks_in_leaf = 4;

}  // namespace

/// Calls `visit(voxel, index)` for the voxels of a block.
template <class Visit>
void NearestVoxels::for_each_voxel(std::uint64_t block, const Visit& visit) const {
  std::array<int, 3> begin = morton_decode(block), end{};
  for (std::size_t a = 0; a < 3; ++a) {
    begin[a] *= block_edge;
    end[a] = std::min(begin[a] + block_edge, grid_.size[a]);
  }
  for (int z = begin[2]; z < end[2]; ++z)
    for (int y = begin[1]; y < end[1]; ++y) {
      const std::size_t row = (static_cast<std::size_t>(z) * static_cast<std::size_t>(grid_.size[1]) +
                               static_cast<std::size_t>(y)) *
                              static_cast<std::size_t>(grid_.size[0]);
      for (int x = begin[0]; x < end[0]; ++x) visit(row + static_cast<std::size_t>(x), Vec3(x, y, z));
    }
}

/// Box around the centres of a block's voxels.
Box3 NearestVoxels::box_of(std::uint64_t block) const {
  const std::array<int, 3> place = morton_decode(block);
  Box3 box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int a = 0; a < 3; ++a) {
      const int first = place[static_cast<std::size_t>(a)] * block_edge;
      index[a] = (corner >> a & 1) ? std::min(first + block_edge, grid_.size[static_cast<std::size_t>(a)]) - 1
                                   : first;
    }
    box.add(grid_.to_input(index));
  }
  return box;
}

NearestVoxels::NearestVoxels(const LabelGrid& grid, const GroupOf& group_of)
    : grid_(grid), group_of_(group_of) {
  std::array<std::size_t, 3> count{};
  for (std::size_t a = 0; a < 3; ++a)
    count[a] = (static_cast<std::size_t>(grid.size[a]) + block_edge - 1) / block_edge;
  blocks_ = parallel_collect<Block>(
      0, count[0] * count[1] * count[2], blocks_grain,
      [&](std::size_t begin, std::size_t end, std::vector<Block>& out) {
        for (std::size_t b = begin; b < end; ++b) {
          const std::uint64_t place =
              morton_encode(static_cast<int>(b % count[0]), static_cast<int>(b / count[0] % count[1]),
                            static_cast<int>(b / (count[0] * count[1])));
          std::vector<std::uint32_t> groups;
          for_each_voxel(place, [&](std::size_t voxel, const Vec3&) {
            const std::uint32_t group = group_of_(voxel);
            if (group != 0 && std::find(groups.begin(), groups.end(), group) == groups.end())
              groups.push_back(group);
          });
          for (const std::uint32_t group : groups) out.push_back({group, place});
        }
      });
  parallel_sort(blocks_);
  tree_ = BoxTree(blocks_.size(), blocks_in_leaf, [&](std::size_t i) { return box_of(blocks_[i].place); });
}

std::optional<std::size_t> NearestVoxels::find(const Vec3& p, std::optional<std::uint32_t> group) const {
  BoxTree::Range range = tree_.all();
  if (group) {
    const auto [first, last] =
        std::equal_range(blocks_.begin(), blocks_.end(), Block{*group, 0},
                         [](const Block& a, const Block& b) { return a.group < b.group; });
    range = {static_cast<std::size_t>(first - blocks_.begin()),
             static_cast<std::size_t>(last - blocks_.begin())};
  }
  std::optional<std::size_t> nearest;
  tree_.nearest(p, std::numeric_limits<double>::infinity(), range, [&](std::size_t i, double best) {
    for_each_voxel(blocks_[i].place, [&](std::size_t voxel, const Vec3& index) {
      const std::uint32_t own = group_of_(voxel);
      if (own == 0 || (group && own != *group)) return;
      const double squared = (grid_.to_input(index) - p).squaredNorm();
      if (nearest && !(squared < best || (squared == best && voxel < *nearest))) return;
      nearest = voxel;
      best = squared;
    });
    return best;
  });
  return nearest;
}

}  // namespace tetwright
