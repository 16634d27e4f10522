// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "common/geometry/distance_tree.h"
#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/level_sets/level_set.h"
#include "mesher/tuning/distance_tuning.h"

namespace tetwright {

namespace {

/// Grid points lowest ... lowest + side - 1 along each axis; `side` is a power of two.
struct GridBox {
  LeafOrigin lowest;
  int side;
  double distance;  ///< of the middle from the surface, or an upper bound of it; finest cells
  Vec3 middle() const { return Vec3(lowest[0], lowest[1], lowest[2]) + Vec3::Constant(0.5 * (side - 1)); }
  /// Distance from the middle to the farthest grid point.
  double reach() const { return 0.5 * std::sqrt(3.0) * (side - 1); }
};

/// Finds the grid points around the surface at a depth. Distances are 1-Lipschitz, so a box whose middle is
/// too far from that depth contains no such point.
class DepthFinder {
 public:
  DepthFinder(const DistanceTree& surface, const LevelSet& boundary, double depth)
      : surface_(surface), boundary_(boundary), depth_(depth) {}

  /// The boxes of `side` grid points that may contain part of the band; memory and time grow with them.
  std::vector<GridBox> boxes(const std::array<int, 3>& cells, int side, Progress* progress) const {
    GridBox all{{0, 0, 0}, side, 0};
    while (all.side <= *std::max_element(cells.begin(), cells.end())) all.side *= 2;
    all.distance = surface_.distance(all.middle(), 4 * all.side);
    std::vector<GridBox> found{all};
    while (!found.empty() && found.front().side > side) {
      if (progress) progress->throw_if_stopped();
      found = parallel_collect<GridBox>(0, found.size(), DistanceGrains::depth_boxes,
                                        [&](std::size_t begin, std::size_t end, std::vector<GridBox>& out) {
                                          LevelSetSampler sampler(boundary_);
                                          for (std::size_t i = begin; i < end; ++i)
                                            for_each_part(found[i], sampler,
                                                          [&](const GridBox& b) { out.push_back(b); });
                                        });
    }
    return found;
  }

  /// Writes the distances of a box's grid points from the surface at the depth into a leaf.
  void fill(const GridBox& box, LevelSetSampler& sampler, const GridLeaf<float>& leaf) const {
    if (box.side > 1) {
      for_each_part(box, sampler, [&](const GridBox& part) { fill(part, sampler, leaf); });
      return;
    }
    const auto& [x, y, z] = box.lowest;
    const double value = depth_ + (sampler.at_node(x, y, z) < 0 ? -box.distance : box.distance);
    if (!outside_band(value)) {
      const double size = std::max(std::abs(value), tolerance::smallest_distance);
      leaf.activate(leaf.number(x, y, z), static_cast<float>(std::copysign(size, value)));
    }
  }

 private:
  /// Calls `use(octant)` for each octant of a box that may contain part of the band.
  template <class Use>
  void for_each_part(const GridBox& box, LevelSetSampler& sampler, Use&& use) const {
    for (int k = 0; k < 8; ++k) {
      const int side = box.side / 2;
      GridBox part{box.lowest, side, 0};
      for (int a = 0; a < 3; ++a) part.lowest[a] += (k >> a & 1) * side;
      const double farthest = depth_ + level_set_band + part.reach() + tolerance::box_distance;
      const double known = box.distance + (part.middle() - box.middle()).norm() + tolerance::box_distance;
      part.distance = surface_.distance(part.middle(), std::min(farthest, known));
      if (std::abs(part.distance - depth_) >= level_set_band + part.reach()) continue;
      if (part.distance > part.reach() && depth_ + part.distance >= level_set_band + part.reach()) {
        // Lies completely on one side, and contains no part of the band if that side is the outside.
        const auto& [x, y, z] = part.lowest;
        if (sampler.at_node(x, y, z) > 0) continue;
      }
      use(part);
    }
  }

  const DistanceTree& surface_;
  const LevelSet& boundary_;
  double depth_;
};

}  // namespace

std::shared_ptr<const LevelSet> LevelSet::at_depth(const RepairedSurface& surface, double depth,
                                                   const GridFrame& frame, Progress* progress) {
  return at_depth(surface, *of_surface(surface, frame, progress), depth, frame, progress);
}

std::shared_ptr<const LevelSet> LevelSet::at_depth(const RepairedSurface& surface, const LevelSet& boundary,
                                                   double depth, const GridFrame& frame, Progress* progress) {
  TriangleMesh all = *boundary.caps_;
  const auto shift = static_cast<Index>(all.points.size());
  for (const Vec3& p : surface.points) all.points.push_back(frame.to_grid(p));
  for (const auto& [a, b, c] : surface.triangles) all.triangles.push_back({a + shift, b + shift, c + shift});
  const DistanceTree tree(all.points, all.triangles);

  const DepthFinder finder(tree, boundary, depth);
  const std::vector<GridBox> boxes = finder.boxes(frame.cells, leaf_side, progress);
  DistanceGrid grid(level_set_band);
  std::vector<GridLeaf<float>> leaves;
  leaves.reserve(boxes.size());
  for (const GridBox& box : boxes) leaves.push_back(grid.touch_leaf(box.lowest));
  parallel_for(0, boxes.size(), DistanceGrains::depth_leaves, [&](std::size_t begin, std::size_t end) {
    if (progress) progress->throw_if_stopped();
    LevelSetSampler sampler(boundary);
    for (std::size_t i = begin; i < end; ++i) finder.fill(boxes[i], sampler, leaves[i]);
  });
  grid.prune_inactive();
  grid.fill_outside_band();
  return std::shared_ptr<const LevelSet>(new LevelSet(std::move(grid), {}, frame.cells));
}

}  // namespace tetwright
