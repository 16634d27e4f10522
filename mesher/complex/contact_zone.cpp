// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/contact_zone.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/morton.h"
#include "common/geometry/point_triangle.h"
#include "common/geometry/triangle_distance.h"
#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/tuning/complex_tuning.h"

namespace tetwright {

namespace {

using Zone = ComplexTuning::Zone;

/// Number of a voxel within its leaf of 8 x 8 x 8.
std::size_t in_leaf(const std::array<int, 3>& v) {
  return static_cast<std::size_t>((v[0] & 7) << 6 | (v[1] & 7) << 3 | (v[2] & 7));
}

std::uint64_t leaf_of(const std::array<int, 3>& v) {
  return morton_encode({v[0] >> 3, v[1] >> 3, v[2] >> 3});
}

}  // namespace

ContactZone::ContactZone(const LabelledComplex& complex, const GridFrame& voxels) {
  std::vector<Vec3> points;
  points.reserve(complex.points.size());
  for (const Vec3& p : complex.points) points.push_back(voxels.to_grid(p));
  std::vector<Face> faces;
  std::vector<Box3> boxes;
  std::vector<Vec3> middles;
  for (const LabelledComplex::Face& f : complex.faces) {
    const Vec3 &a = points[f.ids[0]], &b = points[f.ids[1]], &c = points[f.ids[2]];
    const Vec3 normal = (b - a).cross(c - a);
    if (!(normal.norm() > 0)) continue;
    faces.push_back({{a, b, c}, normal.normalized(), f.behind, f.front});
    boxes.emplace_back();
    for (const Vec3& p : {a, b, c}) boxes.back().add(p);
    middles.push_back(a + b + c);
  }
  const std::vector<Index> order = median_order(boxes, middles, Zone::leaf_size);
  tree_ = BoxTree(order.size(), Zone::leaf_size, [&](std::size_t i) { return boxes[order[i]]; });
  faces_.reserve(order.size());
  for (const Index i : order) faces_.push_back(faces[i]);

  std::vector<std::array<Vec3, 3>> sources;
  for (Index f = 0; f < complex.faces.size(); ++f)
    if (const Triangle& t = complex.faces[f].ids; complex.is_contact(f))
      sources.push_back({points[t[0]], points[t[1]], points[t[2]]});
  for (const auto& [a, b] : complex.junctions()) sources.push_back({points[a], points[b], points[b]});
  std::vector<std::uint64_t> keys = parallel_collect<std::uint64_t>(
      0, sources.size(), ComplexGrains::divided,
      [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& out) {
        for (std::size_t i = begin; i < end; ++i) add_voxels(sources[i], voxels.cells, out);
      });
  parallel_sort_unique(keys);
  for (const std::uint64_t key : keys) {
    const std::array<int, 3> v = morton_decode(key);
    leaves_[leaf_of(v)].set(in_leaf(v));
  }
}

void ContactZone::add_voxels(const std::array<Vec3, 3>& triangle, const std::array<int, 3>& cells,
                             std::vector<std::uint64_t>& keys) const {
  Box3 box;
  for (const Vec3& p : triangle) box.add(p);
  std::array<int, 3> low, high;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    low[k] = std::max(0, static_cast<int>(std::floor(box.low[a] - Zone::reach)));
    high[k] = std::min(cells[k], static_cast<int>(std::floor(box.high[a] + Zone::reach)));
  }
  const TriangleDistance distance(triangle[0], triangle[1], triangle[2]);
  constexpr double limit = (Zone::reach + half_cube_diagonal) * (Zone::reach + half_cube_diagonal);
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x)
        if (distance.squared(Vec3(x + 0.5, y + 0.5, z + 0.5), limit) < limit)
          keys.push_back(morton_encode({x, y, z}));
}

bool ContactZone::contains(const Vec3& point) const {
  std::array<int, 3> v;
  for (int a = 0; a < 3; ++a)
    v[static_cast<std::size_t>(a)] = std::max(0, static_cast<int>(std::floor(point[a])));
  const auto leaf = leaves_.find(leaf_of(v));
  return leaf != leaves_.end() && leaf->second.test(in_leaf(v));
}

ContactZone::Nearest ContactZone::nearest(const Vec3& point) const {
  std::size_t nearest = faces_.size();
  double squared_distance = HUGE_VAL, alignment = 0, side = 0;
  tree_.nearest(point, squared_distance, tree_.all(), [&](std::size_t i, double best) {
    const Face& f = faces_[i];
    const Vec3 away = point - closest_point(point, f.corners[0], f.corners[1], f.corners[2]);
    const double squared = away.squaredNorm();
    if (squared > squared_distance * (1 + Zone::tie)) return best;
    const double along = f.normal.dot(away);
    // Among equally near triangles the one that faces the point most directly knows its side.
    if (nearest < faces_.size() && squared >= squared_distance * (1 - Zone::tie)) {
      const double aligned = std::abs(along);
      if (aligned < alignment || (aligned == alignment && i > nearest)) return best;
    }
    nearest = i;
    squared_distance = std::min(squared_distance, squared);
    alignment = std::abs(along);
    side = along;
    return squared_distance * (1 + Zone::tie);
  });
  const Face& f = faces_[nearest];
  const bool in_front = side > 0;
  return {in_front ? f.front : f.behind, in_front ? f.behind : f.front,
          std::max(std::sqrt(squared_distance), tolerance::smallest_distance)};
}

std::optional<ContactZone::Distance> ContactZone::distance(const Vec3& point, RegionIndex region) const {
  const Face* nearest = nullptr;
  Vec3 away = Vec3::Zero();
  const double limit = Zone::reach * Zone::reach;
  tree_.nearest(point, limit, tree_.all(), [&](std::size_t i, double best) {
    const Face& f = faces_[i];
    if (f.behind != region && f.front != region) return best;
    const Vec3 d = point - closest_point(point, f.corners[0], f.corners[1], f.corners[2]);
    const double squared = d.squaredNorm();
    if (squared >= best) return best;
    nearest = &f;
    away = d;
    return squared;
  });
  if (!nearest) return {};
  const double value = away.norm();
  if (value > tolerance::smallest_distance) return Distance{value, away / value};
  return Distance{tolerance::smallest_distance,
                  nearest->front == region ? Vec3(-nearest->normal) : nearest->normal};
}

}  // namespace tetwright
