// SPDX-License-Identifier: Apache-2.0
#include "mesher/lattice/octree.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/lattice_tuning.h"

namespace tetwright {

namespace {

/// Appends the parents (level l + 1) that must be split because the cell `key` of level l is split: its own
/// parent, and the parents of its neighbours across faces and edges, since these must exist as cells of level
/// l.
/// \param window cells of level l
void append_parents(MortonKey key, const CellBox& window, std::vector<MortonKey>& out) {
  const std::array<int, 3> p = morton_decode(key);
  const auto parent_of = [&](const std::array<int, 3>& q) {
    if (window.contains(q)) out.push_back(morton_encode(q) >> 3);
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

/// True if a cell across a face of the given one is among `split`. All keys are of one level.
bool has_split_neighbour(MortonKey key, const CellBox& window, const std::vector<MortonKey>& split) {
  const std::array<int, 3> p = morton_decode(key);
  for (std::size_t a = 0; a < 3; ++a)
    for (int step : {-1, 1}) {
      std::array<int, 3> q = p;
      q[a] += step;
      if (window.contains(q) && contains(split, morton_encode(q))) return true;
    }
  return false;
}

/// Calls `use(cell)` for the cells at one side of a box of cells.
template <class Use>
void for_each_at_side(const CellBox& cells, int axis, bool upper, Use&& use) {
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  std::array<int, 3> q;
  q[axis] = upper ? cells.high[axis] - 1 : cells.low[axis];
  for (q[c] = cells.low[c]; q[c] < cells.high[c]; ++q[c])
    for (q[b] = cells.low[b]; q[b] < cells.high[b]; ++q[b]) use(q);
}

/// Appends the cells of a level in the window that the upper sides of the box cut in two.
void append_cut_by_box(const std::array<int, 3>& box, const CellBox& window, int level,
                       std::vector<MortonKey>& out) {
  const CellBox cells = at_level({window.low, box}, level);
  for (int a = 0; a < 3; ++a) {
    if (cells.high[a] << level == box[a]) continue;
    for_each_at_side(cells, a, true, [&](const std::array<int, 3>& q) {
      if (at_level(window, level).contains(q)) out.push_back(morton_encode(q));
    });
  }
}

/// Appends the cells of a level through which a plane of the border of a volume passes.
void append_cut_by_border(const CellBox& border, const CellBox& window, int level,
                          std::vector<MortonKey>& out) {
  for (int a = 0; a < 3; ++a)
    for (const int plane : {border.low[a], border.high[a]}) {
      if ((plane >> level) << level == plane) continue;
      CellBox layer = at_level(window, level);
      layer.low[a] = plane >> level;
      layer.high[a] = layer.low[a] + 1;
      for_each_at_side(layer, a, true, [&](const std::array<int, 3>& q) { out.push_back(morton_encode(q)); });
    }
}

/// Adds the mirror images of cells of a level beside the planes of the border of a volume.
void mirror_at_border(const CellBox& border, const CellBox& window, int level,
                      std::vector<MortonKey>& cells) {
  const CellBox around = at_level(window, level);
  for (int a = 0; a < 3; ++a)
    for (const int plane : {border.low[a], border.high[a]}) {
      const int at = plane >> level;
      if (at << level != plane) continue;
      const std::size_t count = cells.size();
      for (std::size_t i = 0; i < count; ++i) {
        std::array<int, 3> cell = morton_decode(cells[i]);
        if (cell[a] != at && cell[a] != at - 1) continue;
        cell[a] = 2 * at - 1 - cell[a];
        if (around.contains(cell)) cells.push_back(morton_encode(cell));
      }
    }
  parallel_sort_unique(cells);
}

/// Appends the cells of a level at the sides of the window that are not sides of the grid.
void append_at_open_sides(const std::array<int, 3>& grid, const CellBox& window, int level,
                          std::vector<MortonKey>& out) {
  for (int a = 0; a < 3; ++a)
    for (const bool upper : {false, true})
      if (upper ? window.high[a] != grid[a] : window.low[a] != 0)
        for_each_at_side(at_level(window, level), a, upper,
                         [&](const std::array<int, 3>& q) { out.push_back(morton_encode(q)); });
}

/// Drops the leaves beyond the box, which no leaf crosses.
void cut_off_at_box(Octree& octree, const std::array<int, 3>& box) {
  if (octree.cells == box) return;
  const auto beyond = [&](std::uint64_t packed) {
    const std::array<int, 3> low = morton_decode(packed >> 5);
    return low[0] >= box[0] || low[1] >= box[1] || low[2] >= box[2];
  };
  std::erase_if(octree.packed, beyond);
  std::erase_if(octree.uncertain, beyond);
  octree.cells = box;
  for (int a = 0; a < 3; ++a) octree.window.high[a] = std::min(octree.window.high[a], box[a]);
}

/// Cells of one level that are split, ascending: those that are for any cells beyond the window, and those
/// that are if all cells there are split. Neither more cells beyond the window nor more split cells in it
/// make a cell whole again, so the whole box's octree splits the first and none but the second.
struct SplitCells {
  std::vector<MortonKey> surely, possibly;
};

void add_sorted(std::vector<MortonKey>& to, const std::vector<MortonKey>& more) {
  if (more.empty()) return;
  to.insert(to.end(), more.begin(), more.end());
  parallel_sort_unique(to);
}

std::vector<MortonKey> parents(const std::vector<MortonKey>& below, const CellBox& window) {
  std::vector<MortonKey> all =
      parallel_collect<MortonKey>(0, below.size(), LatticeGrains::cells,
                                  [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
                                    for (std::size_t i = begin; i < end; ++i)
                                      append_parents(below[i], window, out);
                                  });
  parallel_sort_unique(all);
  return all;
}

/// Builds an octree in one sweep from the finest level up.
/// \param split split(level, already) returns the cells of a level to be split, in any order, given those
///   already split; called for levels 1 and up. `possibly` is empty if the window is the whole box.
template <class Split>
Octree sweep(const std::array<int, 3>& cells, const CellBox& window, int root_level, Split&& split) {
  const bool whole = window == CellBox{{0, 0, 0}, cells};
  std::vector<SplitCells> split_cells(static_cast<std::size_t>(root_level) + 1);
  for (int level = 1; level <= root_level; ++level) {
    SplitCells& now = split_cells[static_cast<std::size_t>(level)];
    const SplitCells& below = split_cells[static_cast<std::size_t>(level - 1)];
    const CellBox around = at_level(window, level - 1);
    now.surely = parents(below.surely, around);
    if (!whole) {
      now.possibly = parents(below.possibly, around);
      std::vector<MortonKey> beside;
      append_at_open_sides(cells, window, level, beside);
      add_sorted(now.possibly, beside);
    }
    const SplitCells asked = split(level, now);
    add_sorted(now.surely, asked.surely);
    add_sorted(now.possibly, asked.possibly);
  }

  Octree octree{cells, window, root_level, {}, {}};
  const auto is_split = [&](int level, MortonKey key) {
    return level > 0 && contains(split_cells[static_cast<std::size_t>(level)].surely, key);
  };
  const auto may_be_split = [&](int level, MortonKey key) {
    return level > 0 && contains(split_cells[static_cast<std::size_t>(level)].possibly, key);
  };
  const auto add_leaf = [&](MortonKey key, int level, std::vector<std::uint64_t>& out) {
    if (!is_split(level, key)) out.push_back(key << (3 * level) << 5 | static_cast<std::uint64_t>(level));
  };
  const CellBox roots = at_level(window, root_level);
  octree.packed = parallel_collect<std::uint64_t>(
      static_cast<std::size_t>(roots.low[2]), static_cast<std::size_t>(roots.high[2]), 1,
      [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& out) {
        for (int z = static_cast<int>(begin); z < static_cast<int>(end); ++z)
          for (int y = roots.low[1]; y < roots.high[1]; ++y)
            for (int x = roots.low[0]; x < roots.high[0]; ++x)
              add_leaf(morton_encode(x, y, z), root_level, out);
      });
  for (int level = root_level; level > 0; --level) {
    const std::vector<MortonKey>& split_there = split_cells[static_cast<std::size_t>(level)].surely;
    const std::vector<std::uint64_t> children = parallel_collect<std::uint64_t>(
        0, split_there.size(), LatticeGrains::cells,
        [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& out) {
          for (std::size_t i = begin; i < end; ++i)
            for (MortonKey child = 0; child < 8; ++child)
              add_leaf(split_there[i] << 3 | child, level - 1, out);
        });
    octree.packed.insert(octree.packed.end(), children.begin(), children.end());
  }
  parallel_sort(octree.packed);
  if (!whole)
    octree.uncertain = parallel_collect<std::uint64_t>(
        0, octree.size(), LatticeGrains::cells,
        [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& out) {
          for (std::size_t i = begin; i < end; ++i)
            if (const Octree::Leaf leaf = octree.leaf(i);
                may_be_split(leaf.level, leaf.key >> 3 * leaf.level))
              out.push_back(octree.packed[i]);
        });
  return octree;
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

std::optional<Octree> Octree::part(const CellBox& box) const {
  const auto within = [&](std::uint64_t leaf) { return box.contains(morton_decode(leaf >> 5)); };
  if (std::any_of(uncertain.begin(), uncertain.end(), within)) return std::nullopt;
  Octree found{cells, box, root_level, {}, {}};
  for (int a = 0; a < 3; ++a) found.window.high[a] = std::min(box.high[a], window.high[a]);
  std::copy_if(packed.begin(), packed.end(), std::back_inserter(found.packed), within);
  return found;
}

Octree build_octree(const std::array<int, 3>& cells, int root_level, const CellsToSplit& split) {
  return sweep(cells, {{0, 0, 0}, cells}, root_level, [&](int level, const SplitCells& already) {
    return SplitCells{split(level, already.surely), {}};
  });
}

Octree build_octree(const MaterialField& field, const OctreeOptions& options,
                    std::vector<MortonKey> interface_voxels, const std::vector<std::vector<MortonKey>>& thin,
                    Progress* progress, const CellBox* part) {
  const GridFrame& frame = field.frame();
  if (options.uniform) {
    Octree whole = build_octree(frame.cells, 0,
                                [](int, const std::vector<MortonKey>&) { return std::vector<MortonKey>(); });
    whole.border = frame.border;
    return whole;
  }

  const CellBox window = part ? *part : CellBox{{0, 0, 0}, frame.cells};
  const int voxel_level = field.refinement();
  // Cells of the current level that contain an interface.
  std::vector<MortonKey> holding = std::move(interface_voxels);
  const auto cells_to_split = [&](int level, const SplitCells& already) {
    if (progress) {
      progress->throw_if_stopped();
      progress->update(static_cast<double>(level) / (frame.root_level + 1));
    }
    const auto place = static_cast<std::size_t>(level);
    std::vector<MortonKey> sheets = place < thin.size() ? thin[place] : std::vector<MortonKey>();
    append_cut_by_box(frame.box, window, level, sheets);
    if (frame.continues()) append_cut_by_border(frame.border, window, level, sheets);
    const auto both = [&](std::vector<MortonKey> cells) {
      if (!part) return SplitCells{std::move(cells), {}};
      return SplitCells{cells, cells};
    };
    if (level <= voxel_level) return both(std::move(sheets));
    for (MortonKey& key : holding) key >>= 3;
    holding.erase(std::unique(holding.begin(), holding.end()), holding.end());
    const int voxel_steps = level - voxel_level;
    if (voxel_steps > options.coarsest_interface_level || options.adaptivity <= 0) {
      sheets.insert(sheets.end(), holding.begin(), holding.end());
      return both(std::move(sheets));
    }
    // Surely split cells need no test.
    const std::vector<MortonKey> failed = parallel_collect<MortonKey>(
        0, holding.size(), LatticeGrains::cells,
        [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
          const std::unique_ptr<FieldSampler> owned = field.sampler();
          FieldSampler& sampler = *owned;
          for (std::size_t i = begin; i < end; ++i)
            if (contains(already.surely, holding[i]) ||
                !interpolates(sampler, holding[i], voxel_steps, options.adaptivity, field))
              out.push_back(holding[i]);
        });
    const CellBox here = at_level(window, level);
    // Cut tets are worse where cells of two sizes meet at the interface, so coarse cells are used only in
    // groups, never singly.
    const auto chosen = [&](const std::vector<MortonKey>& fail) {
      std::vector<MortonKey> cells =
          parallel_collect<MortonKey>(0, holding.size(), LatticeGrains::cells,
                                      [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
                                        for (std::size_t i = begin; i < end; ++i)
                                          if (has_split_neighbour(holding[i], here, fail))
                                            out.push_back(holding[i]);
                                      });
      cells.insert(cells.end(), fail.begin(), fail.end());
      cells.insert(cells.end(), sheets.begin(), sheets.end());
      return cells;
    };
    SplitCells asked{chosen(failed), {}};
    if (part) {
      std::vector<MortonKey> may_fail = failed;
      for (const MortonKey key : holding)
        if (contains(already.possibly, key)) may_fail.push_back(key);
      parallel_sort_unique(may_fail);
      asked.possibly = chosen(may_fail);
    }
    return asked;
  };
  const auto split = [&](int level, const SplitCells& already) {
    SplitCells asked = cells_to_split(level, already);
    if (frame.continues()) {
      asked.surely.insert(asked.surely.end(), already.surely.begin(), already.surely.end());
      mirror_at_border(frame.border, window, level, asked.surely);
    }
    return asked;
  };
  Octree octree = sweep(frame.cells, window, frame.root_level, split);
  cut_off_at_box(octree, frame.box);
  octree.border = frame.border;
  return octree;
}

}  // namespace tetwright
