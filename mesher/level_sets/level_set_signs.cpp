// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/level_set_signs.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/level_sets/hole_caps.h"
#include "mesher/tuning/distance_tuning.h"

namespace tetwright {

namespace {

float signed_value(float distance, bool inside) {
  const float size = std::clamp(distance, static_cast<float>(tolerance::smallest_distance),
                                static_cast<float>(level_set_band));
  return inside ? -size : size;
}

void sign_by_rows(const GridLeaf<float>& leaf, const GridWinding& winding) {
  const auto& [ox, oy, oz] = leaf.origin;
  for (int x = 0; x < leaf_side; ++x)
    for (int y = 0; y < leaf_side; ++y) {
      const auto row = winding.row(ox + x, oy + y);
      auto next = row.begin();
      bool inside = false;
      for (int z = 0; z < leaf_side; ++z) {
        for (; next != row.end() && next->first <= oz + z; ++next) inside = next->winding > 0;
        float& value = leaf.values[(x * leaf_side + y) * leaf_side + z];
        value = signed_value(value, inside);
      }
    }
}

bool is_inside(const NodeWinding& winding, const std::array<int, 3>& p) {
  return winding.at(p[0], p[1], p[2]) >= DistanceTuning::Caps::inside_winding;
}

void sign_by_points(const GridLeaf<float>& leaf, const NodeWinding& winding) {
  for (int k = 0; k < leaf_points; ++k)
    if (leaf.active(k)) leaf.values[k] = signed_value(leaf.values[k], is_inside(winding, leaf.point(k)));
}

std::vector<GridEdge> edges_to_cap(const DistanceGrid& grid) {
  const std::vector<GridLeaf<const float>> leaves = grid.leaves();
  return parallel_collect<GridEdge>(0, leaves.size(), DistanceGrains::band_leaves,
                                    [&](std::size_t begin, std::size_t end, std::vector<GridEdge>& out) {
                                      DistanceGridReader reader(grid);
                                      for (std::size_t i = begin; i < end; ++i)
                                        for (int k = 0; k < leaf_points; ++k) {
                                          if (!leaves[i].active(k)) continue;
                                          const std::array<int, 3> p = leaves[i].point(k);
                                          for (int axis = 0; axis < 3; ++axis) {
                                            std::array<int, 3> next = p;
                                            ++next[axis];
                                            float next_value;
                                            if (reader.active(next[0], next[1], next[2], next_value) &&
                                                needs_cap(leaves[i].values[k], next_value))
                                              out.push_back({morton_encode(p[0], p[1], p[2]), axis});
                                          }
                                        }
                                    });
}

/// Merges the distances from the caps into the signed distances, and their band into the band.
void add_caps(DistanceGrid& grid, const TriangleMesh& caps, const NodeWinding& winding, Progress* progress) {
  const DistanceGrid cap_grid = DistanceGrid::unsigned_distances(caps.points, caps.triangles, progress);
  const std::vector<GridLeaf<const float>> sources = cap_grid.leaves();
  std::vector<GridLeaf<float>> targets;
  targets.reserve(sources.size());
  for (const GridLeaf<const float>& source : sources) targets.push_back(grid.touch_leaf(source.origin));
  parallel_for(0, sources.size(), DistanceGrains::band_leaves, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int k = 0; k < leaf_points; ++k) {
        if (!sources[i].active(k)) continue;
        const float distance = sources[i].values[k], value = targets[i].values[k];
        const bool known = targets[i].active(k);
        const bool inside = known ? value < 0 : is_inside(winding, sources[i].point(k));
        targets[i].activate(k, signed_value(known ? std::min(distance, std::abs(value)) : distance, inside));
      }
  });
}

}  // namespace

NodeWinding::NodeWinding(std::span<const Vec3> points, std::span<const Triangle> triangles,
                         std::size_t closed, const std::array<int, 3>& cells)
    : closed_(points, triangles.first(closed), cells) {
  if (closed == triangles.size()) return;
  open_.emplace(points, triangles.subspan(closed));
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  for (int a = 0; a < 3; ++a) {
    low_[a] = std::max(1, static_cast<int>(std::ceil(low[a])));
    high_[a] = std::min(cells[a] - 1, static_cast<int>(std::floor(high[a])));
  }
}

double NodeWinding::at(int x, int y, int z) const {
  const int whole = closed_.at(x, y, z);
  if (!open_) return whole;
  static const Vec3 offset(tolerance::winding_offset[0], tolerance::winding_offset[1],
                           tolerance::winding_offset[2]);
  const double winding = whole + open_->winding_number(Vec3(x, y, z) + offset);
  const std::array<int, 3> p{x, y, z};
  bool in_box = true;
  for (int a = 0; a < 3; ++a) in_box &= p[a] >= low_[a] && p[a] <= high_[a];
  constexpr double outside = 0.5;  // just below inside_winding
  static_assert(outside < DistanceTuning::Caps::inside_winding);
  return in_box ? winding : std::min(winding, outside);
}

TriangleMesh sign_band(DistanceGrid& grid, const NodeWinding& winding, Progress* progress) {
  const std::vector<GridLeaf<float>> leaves = grid.leaves();
  parallel_for(0, leaves.size(), DistanceGrains::band_leaves, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (winding.whole_numbers())
        sign_by_rows(leaves[i], winding.closed());
      else
        sign_by_points(leaves[i], winding);
  });
  TriangleMesh all;
  if (winding.whole_numbers()) return all;

  const auto read = [&](int x, int y, int z) {
    const double w = winding.at(x, y, z);
    const float far = w >= DistanceTuning::Caps::inside_winding ? -level_set_band : level_set_band;
    return GridReading{grid.active_or(x, y, z, far), w};
  };
  for (int round = 0; round < DistanceTuning::Caps::rounds; ++round) {
    if (progress) progress->throw_if_stopped();
    const std::vector<GridEdge> edges = edges_to_cap(grid);
    if (edges.empty()) break;
    const TriangleMesh caps = cap_holes(edges, read, progress);
    add_caps(grid, caps, winding, progress);
    const auto shift = static_cast<Index>(all.points.size());
    all.points.insert(all.points.end(), caps.points.begin(), caps.points.end());
    for (const Triangle& t : caps.triangles)
      all.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  return all;
}

}  // namespace tetwright
