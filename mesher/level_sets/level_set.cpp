// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/level_set.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/parallel/parallel_sort.h"
#include "mesher/level_sets/level_set_signs.h"
#include "mesher/tuning/distance_tuning.h"

namespace tetwright {

LevelSet::LevelSet(DistanceGrid grid, TriangleMesh caps, const std::array<int, 3>& cells)
    : grid_(std::make_shared<const DistanceGrid>(std::move(grid))),
      caps_(std::make_shared<const TriangleMesh>(std::move(caps))),
      cells_(cells) {}

std::shared_ptr<const LevelSet> LevelSet::of_surface(const RepairedSurface& surface, const GridFrame& frame,
                                                     Progress* progress) {
  std::vector<Vec3> points(surface.points.size());
  parallel_for(0, points.size(), DistanceGrains::elements, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = frame.to_grid(surface.points[i]);
  });
  const NodeWinding winding(points, surface.triangles, surface.closed, frame.cells);
  if (progress) progress->throw_if_stopped();

  DistanceGrid grid = DistanceGrid::unsigned_distances(points, surface.triangles, progress);
  TriangleMesh caps = sign_band(grid, winding, progress);
  grid.fill_outside_band();
  return std::shared_ptr<const LevelSet>(new LevelSet(std::move(grid), std::move(caps), frame.cells));
}

std::shared_ptr<const LevelSet> LevelSet::with_walls(const LevelSet& level_set,
                                                     std::shared_ptr<const WallDistances> walls) {
  DistanceGrid grid = level_set.grid_->copy();
  const std::vector<MortonKey> voxels = walls->covered();
  // At a grid point, the surrounding voxel with the smallest cells determines the depth.
  struct Corner {
    MortonKey point;
    int depth;
    bool operator<(const Corner& o) const { return point != o.point ? point < o.point : depth > o.depth; }
  };
  std::vector<Corner> corners = parallel_collect<Corner>(
      0, voxels.size(), DistanceGrains::sampled_voxels,
      [&](std::size_t begin, std::size_t end, std::vector<Corner>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const std::array<int, 3> v = morton_decode(voxels[i]);
          const int depth = walls->depth(v);
          for (int k = 0; k < 8; ++k)
            out.push_back({morton_encode(v[0] + (k & 1), v[1] + (k >> 1 & 1), v[2] + (k >> 2)), depth});
        }
      });
  parallel_sort(corners);
  corners.erase(std::unique(corners.begin(), corners.end(),
                            [](const Corner& a, const Corner& b) { return a.point == b.point; }),
                corners.end());
  std::vector<float> values(corners.size());
  parallel_for(0, corners.size(), DistanceGrains::leaves, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [x, y, z] = morton_decode(corners[i].point);
      Vec3 unused;
      values[i] = static_cast<float>(walls->changed_distance(Vec3(x, y, z), corners[i].depth, unused));
    }
  });
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [x, y, z] = morton_decode(corners[i].point);
    const auto down = [](int a) { return a / leaf_side * leaf_side; };
    const GridLeaf<float> leaf = grid.touch_leaf({down(x), down(y), down(z)});
    leaf.activate(leaf.number(x, y, z), values[i]);
  }
  std::shared_ptr<LevelSet> changed(new LevelSet(std::move(grid), *level_set.caps_, level_set.cells_));
  changed->walls_ = std::move(walls);
  return changed;
}

std::shared_ptr<const LevelSet> LevelSet::with_true_walls(const std::shared_ptr<const LevelSet>& level_set) {
  if (!level_set->walls_) return level_set;
  std::shared_ptr<LevelSet> as_is(new LevelSet(*level_set));
  as_is->true_walls_ = true;
  return as_is;
}

std::vector<MortonKey> LevelSet::interface_cells() const {
  const std::vector<GridLeaf<const float>> leaves = grid_->leaves();
  constexpr int n = leaf_side + 1;
  std::vector<MortonKey> keys = parallel_collect<MortonKey>(
      0, leaves.size(), DistanceGrains::leaves,
      [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
        DistanceGridReader reader(*grid_);
        for (std::size_t i = begin; i < end; ++i) {
          const auto& [ox, oy, oz] = leaves[i].origin;
          // Bit z of a row: the grid point is inside. A missing leaf lies completely on one side, outside the
          // band.
          unsigned rows[n][n] = {};
          for (int neighbour = 0; neighbour < 8; ++neighbour) {
            const int dx = neighbour & 1, dy = neighbour >> 1 & 1, dz = neighbour >> 2;
            const int x0 = ox + dx * leaf_side, y0 = oy + dy * leaf_side, z0 = oz + dz * leaf_side;
            const float* values = neighbour == 0 ? leaves[i].values : reader.leaf_values(x0, y0, z0);
            const bool tile_inside = !values && reader.value(x0, y0, z0) < 0;
            for (int x = 0; x < (dx ? 1 : leaf_side); ++x)
              for (int y = 0; y < (dy ? 1 : leaf_side); ++y)
                for (int z = 0; z < (dz ? 1 : leaf_side); ++z)
                  rows[dx * leaf_side + x][dy * leaf_side + y] |=
                      static_cast<unsigned>(values ? values[(x * leaf_side + y) * leaf_side + z] < 0
                                                   : tile_inside)
                      << (dz * leaf_side + z);
          }
          for (int x = 0; x < leaf_side; ++x)
            for (int y = 0; y < leaf_side; ++y) {
              const unsigned any = rows[x][y] | rows[x + 1][y] | rows[x][y + 1] | rows[x + 1][y + 1];
              const unsigned all = rows[x][y] & rows[x + 1][y] & rows[x][y + 1] & rows[x + 1][y + 1];
              const unsigned mixed = (any | any >> 1) & ~(all & all >> 1);
              for (int z = 0; z < leaf_side; ++z)
                if (mixed >> z & 1) out.push_back(morton_encode(ox + x, oy + y, oz + z));
            }
        }
      });
  if (walls_) {
    keys.insert(keys.end(), walls_->core().begin(), walls_->core().end());
    parallel_sort_unique(keys);
  } else {
    parallel_sort(keys);
  }
  return keys;
}

std::vector<LeafOrigin> LevelSet::leaves() const {
  std::vector<LeafOrigin> origins;
  for (const GridLeaf<const float>& leaf : grid_->leaves()) origins.push_back(leaf.origin);
  std::sort(origins.begin(), origins.end());
  return origins;
}

LevelSetSampler::LevelSetSampler(const LevelSet& level_set)
    : reader_(*level_set.grid_),
      cells_(level_set.cells_),
      walls_(level_set.walls_.get()),
      true_walls_(level_set.true_walls_) {}

double LevelSetSampler::at_node(int x, int y, int z) { return reader_.value(x, y, z); }

double LevelSetSampler::at(const Vec3& point) {
  Vec3 unused;
  return at(point, unused);
}

double LevelSetSampler::at(const Vec3& point, Vec3& gradient) {
  Eigen::Vector3i cell;
  for (int a = 0; a < 3; ++a)
    cell[a] = static_cast<int>(std::floor(std::clamp(point[a], 0.0, static_cast<double>(cells_[a]) - 0.5)));
  if (walls_)
    if (const int depth = walls_->depth({cell.x(), cell.y(), cell.z()}); depth >= 0) {
      if (point != last_point_) {
        last_distance_ = true_walls_ ? walls_->true_distance(point, depth, last_gradient_)
                                     : walls_->changed_distance(point, depth, last_gradient_);
        last_point_ = point;
      }
      gradient = last_gradient_;
      return last_distance_;
    }
  double v[8];
  reader_.corners(cell.x(), cell.y(), cell.z(), v);
  const Vec3 f = point - cell.cast<double>();
  // Interpolate along z, then y, then x.
  double z0[4], dz[4];
  for (int k = 0; k < 4; ++k) {
    dz[k] = v[2 * k + 1] - v[2 * k];
    z0[k] = v[2 * k] + f.z() * dz[k];
  }
  const double y0 = z0[0] + f.y() * (z0[1] - z0[0]), y1 = z0[2] + f.y() * (z0[3] - z0[2]);
  const double dz0 = dz[0] + f.y() * (dz[1] - dz[0]), dz1 = dz[2] + f.y() * (dz[3] - dz[2]);
  gradient = {y1 - y0, (z0[1] - z0[0]) + f.x() * ((z0[3] - z0[2]) - (z0[1] - z0[0])),
              dz0 + f.x() * (dz1 - dz0)};
  return y0 + f.x() * (y1 - y0);
}

}  // namespace tetwright
