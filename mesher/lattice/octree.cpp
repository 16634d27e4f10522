// SPDX-License-Identifier: Apache-2.0
#include "mesher/lattice/octree.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/lattice_tuning.h"

namespace tetwright {

namespace {

/// Appends the parents (level l + 1) that must be split because the cell `key` of level l is split: its own
/// parent, and the parents of its neighbours across faces and edges, since these must exist as cells of level
/// l.
void append_parents(MortonKey key, const std::array<int, 3>& size, std::vector<MortonKey>& out) {
  const std::array<int, 3> p = morton_decode(key);
  const auto parent_of = [&](const std::array<int, 3>& q) {
    for (int a = 0; a < 3; ++a)
      if (q[a] < 0 || q[a] >= size[a]) return;
    out.push_back(morton_encode(q) >> 3);
  };
  // Only neighbours on the outer sides of the parent have another parent.
  std::array<int, 3> outer;
  for (int a = 0; a < 3; ++a) outer[a] = p[a] & 1 ? 1 : -1;
  out.push_back(key >> 3);
  for (int a = 0; a < 3; ++a) {
    std::array<int, 3> q = p;
    q[a] += outer[a];
    parent_of(q);
    const int b = (a + 1) % 3;
    q[b] += outer[b];
    parent_of(q);
  }
}

bool contains(const std::vector<MortonKey>& ascending, MortonKey key) {
  return std::binary_search(ascending.begin(), ascending.end(), key);
}

/// True if a cell across a face of the given one is among `split`. All keys are of one level, whose grid has
/// `size` cells.
bool has_split_neighbour(MortonKey key, const std::array<int, 3>& size, const std::vector<MortonKey>& split) {
  const std::array<int, 3> p = morton_decode(key);
  for (std::size_t a = 0; a < 3; ++a)
    for (int step : {-1, 1}) {
      std::array<int, 3> q = p;
      q[a] += step;
      if (q[a] >= 0 && q[a] < size[a] && contains(split, morton_encode(q))) return true;
    }
  return false;
}

/// Appends the cells of a level that the upper sides of the box cut in two.
void append_cut_by_box(const std::array<int, 3>& box, int level, std::vector<MortonKey>& out) {
  std::array<int, 3> size;
  for (int a = 0; a < 3; ++a) size[a] = (box[a] + (1 << level) - 1) >> level;
  for (std::size_t a = 0; a < 3; ++a) {
    if (size[a] << level == box[a]) continue;
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    std::array<int, 3> q;
    q[a] = size[a] - 1;
    for (q[c] = 0; q[c] < size[c]; ++q[c])
      for (q[b] = 0; q[b] < size[b]; ++q[b]) out.push_back(morton_encode(q));
  }
}

/// Drops the leaves beyond the box, which no leaf crosses.
void cut_off_at_box(Octree& octree, const std::array<int, 3>& box) {
  if (octree.cells == box) return;
  std::erase_if(octree.packed, [&](std::uint64_t packed) {
    const std::array<int, 3> low = morton_decode(packed >> 5);
    return low[0] >= box[0] || low[1] >= box[1] || low[2] >= box[2];
  });
  octree.cells = box;
}

/// True if the cell contains a single interface, and trilinear interpolation between the corners of the cell
/// yields an interface within `tolerance` (voxels) of the one on voxels. `key` and `level` are in voxels.
bool interpolates(FieldSampler& sampler, MortonKey key, int level, double tolerance,
                  const MaterialField& field) {
  const double voxel = 1 << field.refinement();  // lattice units
  const std::array<int, 3> low = morton_decode(key << 3 * level);
  const int side = 1 << level;
  RegionSet regions;
  NearestRegion nearest[8];
  for (int k = 0; k < 8; ++k) {
    nearest[k] = sampler.nearest_at_voxel(low[0] + (k & 1) * side, low[1] + (k >> 1 & 1) * side,
                                          low[2] + (k >> 2) * side);
    if (nearest[k].margin >= field.band() || !regions.insert(nearest[k].region)) return false;
  }
  if (regions.size() != 2) return false;
  double corner[8];
  for (int k = 0; k < 8; ++k)
    corner[k] = nearest[k].region == regions[0] ? -nearest[k].margin : nearest[k].margin;
  for (int z = 0; z <= side; ++z)
    for (int y = 0; y <= side; ++y)
      for (int x = 0; x <= side; ++x) {
        const NearestRegion there = sampler.nearest_at_voxel(low[0] + x, low[1] + y, low[2] + z);
        if (!regions.contains(there.region)) return false;
        const double value = there.region == regions[0] ? -there.margin : there.margin;
        const double fx = static_cast<double>(x) / side, fy = static_cast<double>(y) / side,
                     fz = static_cast<double>(z) / side;
        const auto mix = [](double a, double b, double f) { return a + f * (b - a); };
        const double coarse = mix(mix(mix(corner[0], corner[1], fx), mix(corner[2], corner[3], fx), fy),
                                  mix(mix(corner[4], corner[5], fx), mix(corner[6], corner[7], fx), fy), fz);
        // Distances have slope 1, so near the interface the difference of values is the displacement.
        if (std::min(std::abs(value), std::abs(coarse)) >= voxel && (value < 0) == (coarse < 0)) continue;
        if (std::abs(coarse - value) > tolerance * voxel) return false;
      }
  return true;
}

}  // namespace

std::size_t Octree::find(MortonKey finest_cell, std::size_t hint) const {
  // With all level bits set, this finds the last leaf that starts at or before the cell.
  return lower_bound_near(packed, (finest_cell << 5 | 31) + 1, hint) - 1;
}

Octree build_octree(const std::array<int, 3>& cells, int root_level, const SplitCells& split) {
  std::vector<std::vector<MortonKey>> split_cells(static_cast<std::size_t>(root_level) + 1);
  for (int level = 1; level <= root_level; ++level) {
    std::vector<MortonKey>& now = split_cells[static_cast<std::size_t>(level)];
    const std::vector<MortonKey>& below = split_cells[static_cast<std::size_t>(level - 1)];
    const std::array<int, 3> size{cells[0] >> (level - 1), cells[1] >> (level - 1), cells[2] >> (level - 1)};
    now = parallel_collect<MortonKey>(0, below.size(), LatticeGrains::cells,
                                      [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
                                        for (std::size_t i = begin; i < end; ++i)
                                          append_parents(below[i], size, out);
                                      });
    parallel_sort_unique(now);
    const std::vector<MortonKey> asked = split(level, now);
    if (asked.empty()) continue;
    now.insert(now.end(), asked.begin(), asked.end());
    parallel_sort_unique(now);
  }

  Octree octree{cells, root_level, {}};
  const auto is_split = [&](int level, MortonKey key) {
    return level > 0 && contains(split_cells[static_cast<std::size_t>(level)], key);
  };
  const auto pack = [](MortonKey key, int level) {
    return key << (3 * level) << 5 | static_cast<std::uint64_t>(level);
  };
  const std::array<int, 3> roots{cells[0] >> root_level, cells[1] >> root_level, cells[2] >> root_level};
  const auto layers = static_cast<std::size_t>(roots[2]);
  octree.packed = parallel_collect<std::uint64_t>(
      0, layers, 1, [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& out) {
        for (int z = static_cast<int>(begin); z < static_cast<int>(end); ++z)
          for (int y = 0; y < roots[1]; ++y)
            for (int x = 0; x < roots[0]; ++x)
              if (const MortonKey key = morton_encode(x, y, z); !is_split(root_level, key))
                out.push_back(pack(key, root_level));
      });
  for (int level = root_level; level > 0; --level) {
    const std::vector<MortonKey>& parents = split_cells[static_cast<std::size_t>(level)];
    const std::vector<std::uint64_t> children = parallel_collect<std::uint64_t>(
        0, parents.size(), LatticeGrains::cells,
        [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& out) {
          for (std::size_t i = begin; i < end; ++i)
            for (MortonKey child = 0; child < 8; ++child)
              if (const MortonKey key = parents[i] << 3 | child; !is_split(level - 1, key))
                out.push_back(pack(key, level - 1));
        });
    octree.packed.insert(octree.packed.end(), children.begin(), children.end());
  }
  parallel_sort(octree.packed);
  return octree;
}

Octree build_octree(const MaterialField& field, const OctreeOptions& options,
                    std::vector<MortonKey> interface_voxels, const std::vector<std::vector<MortonKey>>& thin,
                    Progress* progress) {
  const GridFrame& frame = field.frame();
  if (options.uniform)
    return build_octree(frame.cells, 0,
                        [](int, const std::vector<MortonKey>&) { return std::vector<MortonKey>(); });

  const int voxel_level = field.refinement();
  // Cells of the current level that contain an interface.
  std::vector<MortonKey> holding = std::move(interface_voxels);
  const SplitCells split = [&](int level, const std::vector<MortonKey>& already) {
    if (progress) {
      progress->throw_if_stopped();
      progress->update(static_cast<double>(level) / (frame.root_level + 1));
    }
    const auto place = static_cast<std::size_t>(level);
    std::vector<MortonKey> sheets = place < thin.size() ? thin[place] : std::vector<MortonKey>();
    append_cut_by_box(frame.box, level, sheets);
    if (level <= voxel_level) return sheets;
    for (MortonKey& key : holding) key >>= 3;
    holding.erase(std::unique(holding.begin(), holding.end()), holding.end());
    const int voxel_steps = level - voxel_level;
    if (voxel_steps > options.coarsest_interface_level || options.adaptivity <= 0) {
      sheets.insert(sheets.end(), holding.begin(), holding.end());
      return sheets;
    }
    const std::vector<MortonKey> failed = parallel_collect<MortonKey>(
        0, holding.size(), LatticeGrains::cells,
        [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
          const std::unique_ptr<FieldSampler> owned = field.sampler();
          FieldSampler& sampler = *owned;
          for (std::size_t i = begin; i < end; ++i)
            if (contains(already, holding[i]) ||
                !interpolates(sampler, holding[i], voxel_steps, options.adaptivity, field))
              out.push_back(holding[i]);
        });
    const std::array<int, 3> size{frame.cells[0] >> level, frame.cells[1] >> level, frame.cells[2] >> level};
    // Cut tets are worse where cells of two sizes meet at the interface, so coarse cells are used only in
    // groups, never singly.
    std::vector<MortonKey> chosen =
        parallel_collect<MortonKey>(0, holding.size(), LatticeGrains::cells,
                                    [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
                                      for (std::size_t i = begin; i < end; ++i)
                                        if (has_split_neighbour(holding[i], size, failed))
                                          out.push_back(holding[i]);
                                    });
    chosen.insert(chosen.end(), failed.begin(), failed.end());
    chosen.insert(chosen.end(), sheets.begin(), sheets.end());
    return chosen;
  };
  Octree octree = build_octree(frame.cells, frame.root_level, split);
  cut_off_at_box(octree, frame.box);
  return octree;
}

}  // namespace tetwright
