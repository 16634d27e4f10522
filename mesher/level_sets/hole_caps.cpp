// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/hole_caps.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/distance_tuning.h"

namespace tetwright {

namespace {

using GridPoint = std::array<int, 3>;

GridPoint point_of(MortonKey key) {
  const auto p = morton_decode(key);
  return {static_cast<int>(p[0]), static_cast<int>(p[1]), static_cast<int>(p[2])};
}

MortonKey corner_key(const GridPoint& cell, int k) {
  return morton_encode(cell[0] + (k & 1), cell[1] + (k >> 1 & 1), cell[2] + (k >> 2));
}

/// The cells around an edge, counter-clockwise as seen from its upper end.
std::array<MortonKey, 4> cells_around(const GridEdge& edge) {
  const int u = (edge.axis + 1) % 3, v = (edge.axis + 2) % 3;
  std::array<MortonKey, 4> cells;
  constexpr std::array<std::array<int, 2>, 4> steps{{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
  for (int k = 0; k < 4; ++k) {
    GridPoint p = point_of(edge.lower);
    p[u] += steps[k][0];
    p[v] += steps[k][1];
    cells[k] = morton_encode(p);
  }
  return cells;
}

/// Calls `use(lower, upper, axis)` with the corners at the ends of each of a cell's twelve edges.
template <class Use>
void for_each_edge(Use&& use) {
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 8; ++k)
      if (!(k >> axis & 1)) use(k, k | 1 << axis, axis);
}

class CapFinder {
 public:
  CapFinder(const std::function<GridReading(int, int, int)>& read, Progress* progress)
      : read_(read), progress_(progress) {}

  TriangleMesh find(const std::vector<GridEdge>& seeds) {
    for (std::vector<MortonKey> wave = new_cells(seeds); !wave.empty();) {
      if (progress_) progress_->throw_if_stopped();
      read_corners(wave);
      std::vector<GridEdge> edges = cap_edges(wave);
      wave = new_cells(edges);
      edges_.insert(edges_.end(), edges.begin(), edges.end());
    }
    parallel_sort_unique(edges_);
    return surface_net();
  }

 private:
  /// The cells around the edges that no earlier call returned.
  std::vector<MortonKey> new_cells(const std::vector<GridEdge>& edges) {
    std::vector<MortonKey> cells;
    for (const GridEdge& edge : edges)
      for (const MortonKey cell : cells_around(edge))
        if (cells_.insert(cell).second) cells.push_back(cell);
    parallel_sort(cells);
    return cells;
  }

  void read_corners(const std::vector<MortonKey>& cells) {
    auto corners =
        parallel_collect<MortonKey>(0, cells.size(), DistanceGrains::cap_cells,
                                    [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
                                      for (std::size_t i = begin; i < end; ++i)
                                        for (int k = 0; k < 8; ++k) {
                                          const MortonKey key = corner_key(point_of(cells[i]), k);
                                          if (!readings_.contains(key)) out.push_back(key);
                                        }
                                    });
    parallel_sort_unique(corners);
    std::vector<GridReading> readings(corners.size());
    parallel_for(0, corners.size(), DistanceGrains::cap_cells, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const GridPoint p = point_of(corners[i]);
        readings[i] = read_(p[0], p[1], p[2]);
      }
    });
    for (std::size_t i = 0; i < corners.size(); ++i) readings_.emplace(corners[i], readings[i]);
  }

  std::array<GridReading, 8> corners_of(MortonKey cell) const {
    std::array<GridReading, 8> corners;
    for (int k = 0; k < 8; ++k) corners[k] = readings_.at(corner_key(point_of(cell), k));
    return corners;
  }

  std::vector<GridEdge> cap_edges(const std::vector<MortonKey>& cells) const {
    return parallel_collect<GridEdge>(0, cells.size(), DistanceGrains::cap_cells,
                                      [&](std::size_t begin, std::size_t end, std::vector<GridEdge>& out) {
                                        for (std::size_t i = begin; i < end; ++i) {
                                          const std::array<GridReading, 8> corners = corners_of(cells[i]);
                                          for_each_edge([&](int lower, int upper, int axis) {
                                            if (needs_cap(corners[lower].distance, corners[upper].distance))
                                              out.push_back({corner_key(point_of(cells[i]), lower), axis});
                                          });
                                        }
                                      });
  }

  /// The crossing of the edge from a to b, as a fraction of the edge. Kept away from both ends, so that no
  /// cap triangle has zero area.
  static double crossing(const GridReading& a, const GridReading& b) {
    const double share = needs_cap(a.distance, b.distance)
                             ? (DistanceTuning::Caps::inside_winding - a.winding) / (b.winding - a.winding)
                             : std::abs(a.distance) / (std::abs(a.distance) + std::abs(b.distance));
    return std::clamp(share, DistanceTuning::Caps::min_share, 1 - DistanceTuning::Caps::min_share);
  }

  Vec3 net_point(MortonKey cell) const {
    const std::array<GridReading, 8> corners = corners_of(cell);
    const GridPoint p = point_of(cell);
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for_each_edge([&](int lower, int upper, int axis) {
      const GridReading &a = corners[lower], &b = corners[upper];
      if ((a.distance < 0) == (b.distance < 0)) return;
      Vec3 place(lower & 1, lower >> 1 & 1, lower >> 2);
      place[axis] = crossing(a, b);
      sum += place;
      ++count;
    });
    return Vec3(p[0], p[1], p[2]) + sum / count;
  }

  TriangleMesh surface_net() const {
    std::vector<MortonKey> cells(cells_.begin(), cells_.end());
    parallel_sort(cells);
    TriangleMesh caps;
    caps.points.resize(cells.size());
    parallel_for(0, cells.size(), DistanceGrains::cap_cells, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) caps.points[i] = net_point(cells[i]);
    });
    caps.triangles.resize(2 * edges_.size());
    parallel_for(0, edges_.size(), DistanceGrains::cap_cells, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::array<Index, 4> q;
        const auto around = cells_around(edges_[i]);
        for (int k = 0; k < 4; ++k)
          q[k] = static_cast<Index>(std::lower_bound(cells.begin(), cells.end(), around[k]) - cells.begin());
        if (readings_.at(edges_[i].lower).distance >= 0) std::swap(q[1], q[3]);
        const auto diagonal = [&](int a, int b) {
          return (caps.points[q[a]] - caps.points[q[b]]).squaredNorm();
        };
        const int first = diagonal(0, 2) <= diagonal(1, 3) ? 0 : 1;
        caps.triangles[2 * i] = {q[first], q[first + 1], q[first + 2]};
        caps.triangles[2 * i + 1] = {q[first + 2], q[(first + 3) % 4], q[first]};
      }
    });
    return caps;
  }

  const std::function<GridReading(int, int, int)>& read_;
  Progress* progress_;
  // Only for lookups: their iteration order is unspecified.
  std::unordered_map<MortonKey, GridReading> readings_;
  std::unordered_set<MortonKey> cells_;
  std::vector<GridEdge> edges_;
};

}  // namespace

TriangleMesh cap_holes(const std::vector<GridEdge>& seeds,
                       const std::function<GridReading(int, int, int)>& read, Progress* progress) {
  return CapFinder(read, progress).find(seeds);
}

}  // namespace tetwright
