// SPDX-License-Identifier: Apache-2.0
#include "mesher/thin/local_thickness.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/mesh/disjoint_sets.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/distance_tuning.h"

namespace tetwright {

namespace {

using Walls = DistanceTuning::Walls;
using WallCells = DistanceTuning::WallCells;

using Side = SurfaceDistance::Side;
using Voxel = std::array<int, 3>;

/// Number of cells whose middle is within half a diagonal of a plane, per squared cell of the plane's area.
constexpr double cells_per_area = 2 * half_cube_diagonal;

std::array<int, 3> sum(const Voxel& a, int dx, int dy, int dz) { return {a[0] + dx, a[1] + dy, a[2] + dz}; }

/// The voxels that may contain a surface, judging by the distances at their corners.
std::vector<MortonKey> surface_voxels(const LevelSet& level_set) {
  const std::vector<GridLeaf<const float>> leaves = level_set.grid().leaves();
  std::vector<MortonKey> keys = parallel_collect<MortonKey>(
      0, leaves.size(), DistanceGrains::band_leaves,
      [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
        DistanceGridReader reader(level_set.grid());
        for (std::size_t i = begin; i < end; ++i)
          for (int k = 0; k < leaf_points; ++k) {
            if (!leaves[i].active(k) || std::abs(leaves[i].values[k]) > 3 * half_cube_diagonal) continue;
            const Voxel v = leaves[i].point(k);
            double corners[8];
            reader.corners(v[0], v[1], v[2], corners);
            if (std::any_of(corners, corners + 8, [](double d) { return std::abs(d) <= half_cube_diagonal; }))
              out.push_back(morton_encode(v));
          }
      });
  parallel_sort(keys);
  return keys;
}

/// False if the distances on voxels rule out any other surface within half of `limit` on either side of the
/// surface in a voxel.
bool may_be_thin(LevelSetSampler& sampler, const Vec3& middle, double limit) {
  if (limit > level_set_band) return true;
  Vec3 slope;
  const double value = sampler.at(middle, slope);
  const double length = slope.norm();
  if (std::abs(value) > half_cube_diagonal + Walls::trusted) return std::abs(length - 1) > Walls::trusted;
  if (std::abs(length - 1) > Walls::trusted) return true;
  const Vec3 normal = slope / length, place = middle - value * normal;
  const double radius = 0.5 * limit;
  return sampler.at(place + radius * normal) < radius - Walls::trusted ||
         sampler.at(place - radius * normal) > Walls::trusted - radius;
}

Vec3 middle_of(const Voxel& cell, int depth) {
  return std::ldexp(1, -depth) * (Vec3(cell[0], cell[1], cell[2]) + Vec3::Constant(0.5));
}

/// Walls and gaps near a cell of 1/2^depth voxels.
struct CellWalls {
  bool near = false;     ///< the surface is near the cell
  bool thin = false;     ///< something there is below its limit
  bool gap = false;      ///< the thin part is a gap, not a wall
  double thickness = 0;  ///< of the thinnest
};

/// Thickness below which walls and gaps count.
struct SideLimits {
  double wall, gap;
};

/// Measures at the surface point closest to a cell's middle.
CellWalls measure_nearest(const SurfaceDistance& surface, const Voxel& cell, int depth, double facing,
                          const SideLimits& limits) {
  const std::optional<SurfacePlace> place =
      surface.nearest(middle_of(cell, depth), half_cube_diagonal * std::ldexp(1, -depth));
  if (!place) return {};
  const double wall = surface.thickness(*place, Side::wall, facing, limits.wall),
               gap = surface.thickness(*place, Side::gap, facing, limits.gap);
  const bool thin_wall = wall < limits.wall, thin_gap = gap < limits.gap;
  return {true, thin_wall || thin_gap, thin_gap && (!thin_wall || gap < wall), std::min(gap, wall)};
}

Voxel child(const Voxel& cell, int k) {
  return {2 * cell[0] + (k & 1), 2 * cell[1] + (k >> 1 & 1), 2 * cell[2] + (k >> 2)};
}

/// As measure_nearest(). If nothing is thin there, also measures at the eight octants of the cell, which
/// contains several faces near rims and corners.
CellWalls measure(const SurfaceDistance& surface, const Voxel& cell, int depth, double facing,
                  const SideLimits& limits) {
  CellWalls found = measure_nearest(surface, cell, depth, facing, limits);
  for (int k = 0; k < 8 && found.near && !found.thin; ++k)
    if (const CellWalls part = measure_nearest(surface, child(cell, k), depth + 1, facing, limits); part.thin)
      found = part;
  return found;
}

/// True for a gap that no cell resolves.
bool stays_closed(const CellWalls& walls) {
  return walls.thin && walls.gap &&
         walls.thickness < std::ldexp(Walls::min_shown_cells, -max_wall_refinement);
}

/// Calls `visit(cell, depth, walls, split)` for the cells of a voxel that contain a surface, each split cell
/// before its parts. Cells are split while they are thin and above `max_depth`, unless they stay closed.
template <class Visit>
void descend(const SurfaceDistance& surface, const Voxel& cell, int depth, int max_depth,
             const Visit& visit) {
  const double side = std::ldexp(1, -depth), enough = Walls::min_shown_cells * side;
  const CellWalls walls = measure(surface, cell, depth, Walls::facing_to_refine, {enough, enough});
  if (!walls.near) return;
  const bool split = walls.thin && depth < max_depth && !stays_closed(walls);
  visit(cell, depth, walls, split);
  if (!split) return;
  for (int k = 0; k < 8; ++k) descend(surface, child(cell, k), depth + 1, max_depth, visit);
}

/// The voxels dilated by one layer of neighbours, `times` times.
std::vector<MortonKey> dilated(std::vector<MortonKey> voxels, int times, const std::array<int, 3>& cells) {
  for (int i = 0; i < times; ++i) {
    voxels =
        parallel_collect<MortonKey>(0, voxels.size(), DistanceGrains::measured_voxels,
                                    [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
                                      for (std::size_t v = begin; v < end; ++v) {
                                        const Voxel at = morton_decode(voxels[v]);
                                        for (int k = 0; k < 27; ++k) {
                                          const Voxel next = sum(at, k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
                                          bool in_box = true;
                                          for (std::size_t a = 0; a < 3; ++a)
                                            in_box &= next[a] >= 0 && next[a] < cells[a];
                                          if (in_box) out.push_back(morton_encode(next));
                                        }
                                      }
                                    });
    parallel_sort_unique(voxels);
  }
  return voxels;
}

/// Voxels around a thin voxel whose distances come from the triangles.
int covered_around(const ThinWalls::Limits& limits) {
  return std::max(1, static_cast<int>(std::ceil(0.5 * std::max(limits.min_gap, limits.min_thickness))));
}

/// Puts thin voxels with overlapping covered neighbourhoods into one region.
void find_regions(LocalThickness& measured) {
  // Closing and omitting on purpose changes distances in a wide neighbourhood. Use one depth everywhere, so
  // that distances do not jump.
  if (covered_around(measured.limits) > 1) {
    measured.region.assign(measured.voxels.size(), 0);
    measured.regions.resize(1);
    return;
  }
  struct Claim {
    MortonKey voxel;
    Index owner;
    bool operator<(const Claim& o) const { return voxel != o.voxel ? voxel < o.voxel : owner < o.owner; }
  };
  std::vector<Claim> claims =
      parallel_collect<Claim>(0, measured.voxels.size(), DistanceGrains::measured_voxels,
                              [&](std::size_t begin, std::size_t end, std::vector<Claim>& out) {
                                for (std::size_t v = begin; v < end; ++v)
                                  for (const MortonKey key : dilated({measured.voxels[v]}, 1, measured.cells))
                                    out.push_back({key, static_cast<Index>(v)});
                              });
  parallel_sort(claims);
  DisjointSets sets(measured.voxels.size());
  for (std::size_t i = 1; i < claims.size(); ++i)
    if (claims[i].voxel == claims[i - 1].voxel) sets.unite(claims[i - 1].owner, claims[i].owner);
  std::vector<std::uint32_t> number(measured.voxels.size());
  measured.region.resize(measured.voxels.size());
  std::uint32_t count = 0;
  for (Index v = 0; v < measured.voxels.size(); ++v) {
    if (sets.is_root(v)) number[v] = count++;
    measured.region[v] = number[sets.root(v)];  // a root is the smallest of its set
  }
  measured.regions.resize(count);
}

/// Predicts the tets of each region at each depth.
void count_cells(LocalThickness& measured) {
  struct Cell {
    std::uint32_t region;
    int depth;
    int needed;  ///< depth that resolves it
    bool gap, thin;
    bool closed;  ///< whatever the depth
  };
  const std::vector<Cell> cells = parallel_collect<Cell>(
      0, measured.voxels.size(), DistanceGrains::measured_voxels,
      [&](std::size_t begin, std::size_t end, std::vector<Cell>& out) {
        for (std::size_t v = begin; v < end; ++v)
          descend(*measured.surface, morton_decode(measured.voxels[v]), 0, WallCells::counted_depth,
                  [&](const Voxel& cell, int depth, const CellWalls& walls, bool split) {
                    int needed = depth + split;
                    const bool closed = stays_closed(walls);
                    if (walls.thin && !closed && depth == WallCells::counted_depth) {
                      needed = depth + 1;
                      // Tips of wedges are thin in cells of any size, so only parallel walls are refined
                      // further.
                      const double side = std::ldexp(1, -depth);
                      const CellWalls parallel =
                          measure_nearest(*measured.surface, cell, depth, Walls::facing_to_report,
                                          {Walls::min_shown_cells * side, Walls::min_shown_cells * side});
                      if (parallel.thin)
                        while (needed < max_wall_refinement &&
                               parallel.thickness < std::ldexp(Walls::min_shown_cells, -needed))
                          ++needed;
                      else
                        needed = depth;
                    }
                    out.push_back({measured.region[v], depth, needed, walls.gap, walls.thin, closed});
                  });
      });
  // For each region, the number of cells that need each depth or more.
  std::vector<std::array<std::size_t, max_wall_refinement + 1>> asking(measured.regions.size());
  for (const Cell& c : cells)
    for (int d = c.depth + 1; d <= c.needed; ++d) ++asking[c.region][d];
  const auto worth = [&](const Cell& c) {
    int needed = c.needed;
    const auto& of_region = asking[c.region];
    while (needed > 0 && of_region[needed] < (needed > WallCells::counted_depth ? WallCells::min_deep_cells
                                                                                : WallCells::min_thin_voxels))
      --needed;
    return needed;
  };
  for (LocalThickness::Region& region : measured.regions) region.has_walls = false;
  for (const Cell& c : cells) {
    LocalThickness::Region& region = measured.regions[c.region];
    region.has_walls |= c.thin && !c.gap;
    if (!c.thin || !c.gap) continue;
    // Deeper cells count for themselves, down to the depth that is counted.
    const int last = c.closed                             ? max_wall_refinement
                     : c.depth < WallCells::counted_depth ? c.depth
                                                          : c.needed - 1;
    for (int d = c.depth; d <= last; ++d) region.closed[d] += std::ldexp(1, -2 * c.depth);
  }
  for (Cell c : cells) {
    c.needed = worth(c);
    if (c.depth > c.needed) continue;  // inside a cell that is not split
    LocalThickness::Region& region = measured.regions[c.region];
    const double tets = c.gap ? WallCells::tets_per_gap_cell : WallCells::tets_per_wall_cell;
    region.needed = std::max(region.needed, c.needed);
    for (int d = c.depth; d <= max_wall_refinement; ++d) {
      const bool counted_below = c.depth < WallCells::counted_depth && c.needed > c.depth && d > c.depth;
      if (!counted_below)
        region.tets[d] += tets * std::ldexp(1, 2 * (std::min(d, std::max(c.needed, c.depth)) - c.depth));
    }
  }
}

}  // namespace

LocalThickness measure_local_thickness(const RepairedSurface& surface, const LevelSet& level_set,
                                       const GridFrame& frame, const ThinWalls::Limits& limits,
                                       std::vector<MortonKey> exact_voxels, Progress* progress) {
  LocalThickness measured;
  measured.limits = limits;
  measured.cells = frame.cells;
  const SideLimits exact{std::max(Walls::exact_below, limits.min_thickness),
                         std::max(Walls::exact_below, limits.min_gap)};
  const std::vector<MortonKey> all = surface_voxels(level_set);
  const std::vector<MortonKey> suspects = parallel_collect<MortonKey>(
      0, all.size(), DistanceGrains::measured_voxels,
      [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
        LevelSetSampler sampler(level_set);
        for (std::size_t i = begin; i < end; ++i)
          if (may_be_thin(sampler, middle_of(morton_decode(all[i]), 0), std::max(exact.wall, exact.gap)))
            out.push_back(all[i]);
      });
  if (progress) progress->throw_if_stopped();
  measured.exact = std::move(exact_voxels);
  if (suspects.empty() && measured.exact.empty()) return measured;

  std::vector<Vec3> points(surface.points.size());
  parallel_for(0, points.size(), DistanceGrains::elements, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = frame.to_grid(surface.points[i]);
  });
  measured.surface = std::make_shared<const SurfaceDistance>(points, surface.triangles, surface.closed,
                                                             level_set.caps(), surface.intersects_itself);
  measured.voxels = parallel_collect<MortonKey>(
      0, suspects.size(), DistanceGrains::measured_voxels,
      [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          if (measure(*measured.surface, morton_decode(suspects[i]), 0, Walls::facing_to_change, exact).thin)
            out.push_back(suspects[i]);
        }
      });
  if (measured.voxels.empty()) {
    if (measured.exact.empty()) measured.surface = nullptr;
    return measured;
  }
  if (progress) progress->throw_if_stopped();
  find_regions(measured);
  if (progress) progress->throw_if_stopped();
  count_cells(measured);
  return measured;
}

ThinWallPlan plan_thin_walls(const LocalThickness& measured) {
  ThinWallPlan plan;
  if (!measured.surface) return plan;
  const auto walls = std::make_shared<ThinWalls>(measured.surface, measured.limits);
  const int around = covered_around(measured.limits);
  {
    std::vector<std::vector<MortonKey>> by_depth(max_wall_refinement + 1);
    for (std::size_t v = 0; v < measured.voxels.size(); ++v)
      by_depth[measured.regions[measured.region[v]].depth].push_back(measured.voxels[v]);
    for (int depth = 0; depth <= max_wall_refinement; ++depth)
      for (const MortonKey key : dilated(std::move(by_depth[depth]), around, measured.cells))
        walls->cover(morton_decode(key), depth);
    for (const MortonKey key : dilated(measured.exact, 1, measured.cells))
      if (walls->depth(morton_decode(key)) < 0) walls->cover(morton_decode(key), 0);
  }
  walls->set_core(measured.voxels);

  struct Cell {
    int depth;
    MortonKey key;
    bool operator<(const Cell& o) const { return depth != o.depth ? depth < o.depth : key < o.key; }
    bool operator==(const Cell& o) const { return depth == o.depth && key == o.key; }
  };
  struct Change {
    std::uint32_t region;
    bool gap, on_purpose;
    double thickness, area;
    Vec3 place;
  };
  std::vector<Change> changes;
  std::vector<Cell> cells;
  {
    struct Found {
      double filling = 0, filling_thickened = 0;
      std::vector<Cell> cells;
      std::vector<Change> changes;
    };
    const std::size_t tasks =
        (measured.voxels.size() + DistanceGrains::measured_voxels - 1) / DistanceGrains::measured_voxels;
    std::vector<Found> found(tasks);
    parallel_for(0, tasks, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t task = begin; task < end; ++task)
        for (std::size_t v = task * DistanceGrains::measured_voxels;
             v < std::min(measured.voxels.size(), (task + 1) * DistanceGrains::measured_voxels); ++v) {
          const std::uint32_t region = measured.region[v];
          const int max_depth = measured.regions[region].depth;
          const double min_shown = std::ldexp(Walls::min_shown_cells, -max_depth);
          descend(*measured.surface, morton_decode(measured.voxels[v]), 0, max_depth,
                  [&](const Voxel& cell, int depth, const CellWalls& walls, bool split) {
                    if (split) found[task].cells.push_back({depth, morton_encode(cell)});
                    if (split) return;
                    const bool thin = walls.thin;
                    const double side = std::ldexp(1, -depth);
                    // Area of one side. If the wall is thinner than a cell, both sides are in the cell.
                    const auto area_of = [&](double thickness) {
                      return side * side / cells_per_area / (1 + std::min(1.0, thickness / side));
                    };
                    // A thickened wall extends into the cells around it.
                    if (thin && depth > 0)
                      for (int k = 0; k < 27; ++k) {
                        const Voxel next = sum(cell, k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
                        found[task].cells.push_back({depth - 1, morton_encode(next) >> 3});
                      }
                    const Vec3 middle = middle_of(cell, depth);
                    const std::optional<SurfacePlace> place =
                        measured.surface->nearest(middle, half_cube_diagonal * side);
                    if (!place) return;
                    const double wall = measured.surface->thickness(
                        *place, Side::wall, Walls::facing_to_report, Walls::exact_below);
                    if (wall < Walls::exact_below) {
                      const double kept = std::max(wall, measured.limits.min_thickness),
                                   shown = std::max(kept, min_shown);
                      // At most the number of tets that the dense mesh has there, since a fold may have no
                      // thickness at all.
                      const auto filling = [&](double thickness) {
                        return std::min(
                            WallCells::filling_tets_per_area * area_of(wall) / (thickness * thickness),
                            WallCells::tets_per_wall_cell);
                      };
                      found[task].filling += filling(kept);
                      found[task].filling_thickened += filling(shown);
                    }
                    for (const Side kind : {Side::wall, Side::gap}) {
                      const double wanted =
                          kind == Side::gap ? measured.limits.min_gap : measured.limits.min_thickness;
                      const double limit = std::max(min_shown, wanted);
                      const double thickness =
                          measured.surface->thickness(*place, kind, Walls::facing_to_report, limit);
                      if (thickness < limit)
                        found[task].changes.push_back({region, kind == Side::gap, thickness < wanted,
                                                       thickness, area_of(thickness), place->point});
                    }
                  });
        }
    });
    for (Found& f : found) {
      plan.filling_tets += f.filling;
      plan.filling_tets_thickened += f.filling_thickened;
      cells.insert(cells.end(), f.cells.begin(), f.cells.end());
      changes.insert(changes.end(), f.changes.begin(), f.changes.end());
      f = {};
    }
  }
  parallel_sort_unique(cells);
  // At the rim of a wall or gap the closest point may be on an adjacent face: surface cells next to split
  // cells are split too.
  const std::vector<Cell> beside = parallel_collect<Cell>(
      0, cells.size(), DistanceGrains::measured_voxels,
      [&](std::size_t begin, std::size_t end, std::vector<Cell>& out) {
        for (std::size_t i = begin; i < end; ++i)
          for (int k = 0; k < 27; ++k) {
            const Voxel next = sum(morton_decode(cells[i].key), k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            if (const Cell c{cells[i].depth, morton_encode(next)};
                !std::binary_search(cells.begin(), cells.end(), c) &&
                measured.surface->nearest(middle_of(next, c.depth),
                                          half_cube_diagonal * std::ldexp(1, -c.depth)))
              out.push_back(c);
          }
      });
  cells.insert(cells.end(), beside.begin(), beside.end());
  parallel_sort_unique(cells);
  for (const Cell& c : cells) plan.finer.refinement = std::max(plan.finer.refinement, c.depth + 1);
  // Nothing thin may remain in cells larger than voxels: the last list splits cells of two voxels.
  plan.finer.cells.resize(static_cast<std::size_t>(plan.finer.refinement) + 2);
  for (const MortonKey voxel : measured.voxels)
    if (std::vector<MortonKey>& larger = plan.finer.cells.back();
        larger.empty() || larger.back() != voxel >> 3)
      larger.push_back(voxel >> 3);
  for (const Cell& c : cells)
    plan.finer.cells[static_cast<std::size_t>(plan.finer.refinement - c.depth)].push_back(c.key);

  std::stable_sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) {
    return std::tuple(a.region, a.gap, a.on_purpose) < std::tuple(b.region, b.gap, b.on_purpose);
  });
  for (const Change& c : changes) {
    const bool same = !plan.changed.empty() && &c != changes.data() && (&c)[-1].region == c.region &&
                      (&c)[-1].gap == c.gap && (&c)[-1].on_purpose == c.on_purpose;
    if (!same)
      plan.changed.push_back({c.gap,
                              c.thickness,
                              std::ldexp(Walls::min_shown_cells, -measured.regions[c.region].depth),
                              0,
                              c.place,
                              c.on_purpose,
                              {}});
    ChangedWall& w = plan.changed.back();
    w.area += c.area;
    if (c.gap) w.places.push_back(c.place);
    if (c.thickness < w.thickness) w.thickness = c.thickness, w.place = c.place;
  }
  // Areas smaller than a finest cell are noise from surfaces that merely pass close to each other.
  std::erase_if(plan.changed, [](const ChangedWall& w) { return w.area < w.min_shown * w.min_shown; });
  plan.walls = walls;
  return plan;
}

RefinementRegions combine(RefinementRegions a, RefinementRegions b) {
  if (a.refinement < b.refinement) std::swap(a, b);
  const auto shift = static_cast<std::size_t>(a.refinement - b.refinement);
  a.cells.resize(std::max(a.cells.size(), b.cells.size() + shift));
  for (std::size_t level = 0; level < b.cells.size(); ++level) {
    std::vector<MortonKey>& all = a.cells[level + shift];
    all.insert(all.end(), b.cells[level].begin(), b.cells[level].end());
    parallel_sort_unique(all);
  }
  a.coarsest_interface_level = std::min(a.coarsest_interface_level, b.coarsest_interface_level);
  return a;
}

}  // namespace tetwright
