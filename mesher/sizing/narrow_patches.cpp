// SPDX-License-Identifier: Apache-2.0
#include "mesher/sizing/narrow_patches.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/geometry/projection_tree.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/distance_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

struct Split {
  int depth;  ///< of the cell
  MortonKey key;
  bool operator==(const Split&) const = default;
  bool operator<(const Split& o) const { return depth != o.depth ? depth < o.depth : key < o.key; }
};

/// Points on creases where patches are narrow, in voxels.
std::vector<RefinementRegion> narrow_places(const RepairedSurface& surface, const SurfacePatches& patches,
                                            const GridFrame& frame, int max_depth) {
  const SurfaceCreases creases = find_creases(surface.points, surface.triangles, patches.patches);
  std::vector<Vec3> points;
  points.reserve(surface.points.size());
  for (const Vec3& p : surface.points) points.push_back(frame.to_grid(p));
  std::vector<ProjectionTree::Item> segments, corners;
  for (const SurfaceCreases::Segment& s : creases.segments)
    segments.push_back({{s.ends[0], s.ends[1], s.ends[1]}, {s.patches[0], s.patches[1], 0}});
  for (const Index c : creases.corners) corners.push_back({{c, c, c}, {}});
  const ProjectionTree segment_tree(points, std::move(segments)), corner_tree(points, std::move(corners));
  return parallel_collect<RefinementRegion>(
      0, creases.segments.size(), DistanceGrains::crease_segments,
      [&](std::size_t begin, std::size_t end, std::vector<RefinementRegion>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const SurfaceCreases::Segment& segment = creases.segments[i];
          const std::array<std::uint16_t, 2>& own = segment.patches;
          const Vec3 &a = points[segment.ends[0]], &b = points[segment.ends[1]];
          const auto places =
              static_cast<int>(std::ceil((b - a).norm() / DistanceTuning::NarrowPatches::spacing));
          for (int k = 0; k <= places; ++k) {
            const Vec3 at = a + (b - a) * (static_cast<double>(k) / std::max(places, 1));
            const auto other = segment_tree.nearest_of(
                at, DistanceTuning::NarrowPatches::cells_to_width, [&](const ProjectionTree::Item& item) {
                  const std::uint32_t p = item.kind[0], q = item.kind[1];
                  if (p == own[0] && q == own[1]) return false;
                  return p == own[0] || p == own[1] || q == own[0] || q == own[1];
                });
            if (!other) continue;
            const double width = (other->point - at).norm();
            if (corner_tree.nearest_of(at, width / DistanceTuning::NarrowPatches::corner_share,
                                       [](const auto&) { return true; }))
              continue;
            // Creases that touch there form a corner as well.
            if (!(width > 0)) continue;
            out.push_back(
                {at, std::min(max_depth, static_cast<int>(std::ceil(std::log2(
                                             DistanceTuning::NarrowPatches::cells_to_width / width))))});
          }
        }
      });
}

/// Halves the cells at and around the given points (voxels), reducing the depth until at most `max_tets` are
/// added.
NarrowPatches halve_cells(const std::vector<RefinementRegion>& places, int max_depth, double max_tets) {
  for (; max_depth > 0; --max_depth) {
    std::vector<Split> splits;
    for (const RefinementRegion& n : places)
      for (int depth = 0; depth < std::min(n.halvings, max_depth); ++depth) {
        const Vec3 cell = n.place * std::ldexp(1, depth);
        const auto along = [&](int axis, int step) {
          return std::max(0, static_cast<int>(std::floor(cell[axis])) + step);
        };
        for (int k = 0; k < 27; ++k)
          splits.push_back(
              {depth, morton_encode(along(0, k % 3 - 1), along(1, k / 3 % 3 - 1), along(2, k / 9 - 1))});
      }
    std::sort(splits.begin(), splits.end());
    splits.erase(std::unique(splits.begin(), splits.end()), splits.end());
    if (splits.empty()) return {};
    if (DistanceTuning::NarrowPatches::tets_of_split * static_cast<double>(splits.size()) > max_tets)
      continue;
    NarrowPatches narrow;
    RefinementRegions& finer = narrow.finer;
    finer.refinement = splits.back().depth + 1;
    finer.cells.resize(static_cast<std::size_t>(finer.refinement) + 2);
    for (const Split& s : splits) {
      finer.cells[static_cast<std::size_t>(finer.refinement - s.depth)].push_back(s.key);
      // Halving a voxel-sized cell requires its parent of two voxels to be split.
      if (s.depth > 0) continue;
      finer.cells.back().push_back(s.key >> 3);
      narrow.voxels.push_back(s.key);
    }
    std::vector<MortonKey>& larger = finer.cells.back();
    larger.erase(std::unique(larger.begin(), larger.end()), larger.end());
    return narrow;
  }
  return {};
}

}  // namespace

NarrowPatches find_narrow_patches(const RepairedSurface& surface, const SurfacePatches& patches,
                                  const GridFrame& frame, int max_depth, double max_tets) {
  if (max_depth <= 0 || !patches.any()) return {};
  return halve_cells(narrow_places(surface, patches, frame, max_depth), max_depth, max_tets);
}

NarrowPatches cells_around(const std::vector<RefinementRegion>& asked, const GridFrame& frame, int max_depth,
                           double max_tets) {
  std::vector<RefinementRegion> places;
  places.reserve(asked.size());
  for (const RefinementRegion& p : asked) places.push_back({frame.to_grid(p.place), p.halvings});
  return halve_cells(places, max_depth, max_tets);
}

}  // namespace tetwright
