// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/triangle_places.h"

#include <algorithm>

#include "common/geometry/point_triangle.h"
#include "mesher/tuning/complex_tuning.h"

namespace tetwright {

TrianglePlaces::TrianglePlaces(const std::vector<Vec3>& points, std::span<const Triangle> triangles) {
  constexpr std::size_t leaf_size = ComplexTuning::Cells::leaf_size;
  std::vector<Vec3> middles;
  for (const auto& [a, b, c] : triangles) {
    corners_.push_back({points[a], points[b], points[c]});
    boxes_.emplace_back();
    for (const Vec3& p : corners_.back()) boxes_.back().add(p);
    middles.push_back(boxes_.back().low + boxes_.back().high);
  }
  order_ = median_order(boxes_, middles, leaf_size);
  tree_ = BoxTree(order_.size(), leaf_size, [&](std::size_t i) { return boxes_[order_[i]]; });
}

std::optional<TrianglePlaces::Place> TrianglePlaces::nearest(const Vec3& p, double max_distance) const {
  std::optional<Place> found;
  double least = max_distance * max_distance;
  tree_.nearest(p, least, tree_.all(), [&](std::size_t i, double) {
    const auto& [a, b, c] = corners_[order_[i]];
    const Vec3 q = closest_point(p, a, b, c);
    const double squared = (q - p).squaredNorm();
    if (squared < least || (squared == least && (!found || order_[i] < found->triangle))) {
      least = squared;
      found = Place{order_[i], q};
    }
    return least;
  });
  return found;
}

std::vector<Index> TrianglePlaces::in_box(Box3 box, double margin) const {
  box.low -= Vec3::Constant(margin);
  box.high += Vec3::Constant(margin);
  std::vector<Index> out;
  tree_.for_each_in([&](const Box3& own) { return own.intersects(box); },
                    [&](std::size_t i) {
                      if (boxes_[order_[i]].intersects(box)) out.push_back(order_[i]);
                    });
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace tetwright
