// SPDX-License-Identifier: Apache-2.0
#include "tetwright/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/geometry/projection_tree.h"

namespace tetwright {

namespace {

constexpr double max_crease_share = 0.005, max_corner_share = 0.001;
constexpr double places_to_diagonal = 2000;
/// Allowed gap between the largest sampled distance and its bound: a fraction of the distance, or of the
/// diagonal.
constexpr double bound_share = 0.01, bound_diagonals = 1e-9;

/// Upper bound on the distance of the points between p and q from the items. At most about `accuracy` above
/// the maximum of `known` and the largest distance. The distance from a single item is convex along the
/// segment.
double bound_between(const Vec3& p, const Vec3& q, const ProjectionTree& items, double known,
                     double accuracy) {
  double bound = 0;
  std::vector<std::array<Vec3, 2>> open{{p, q}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    const Vec3 middle = (a + b) / 2;
    const auto on = items.nearest_of(middle, std::numeric_limits<double>::infinity(),
                                     [](const ProjectionTree::Item&) { return true; });
    if (!on) return std::numeric_limits<double>::infinity();
    const double upper =
        std::max((items.closest_on(on->item, a) - a).norm(), (items.closest_on(on->item, b) - b).norm());
    if (upper <= std::max(known, bound) + accuracy || (b - a).norm() <= accuracy) {
      bound = std::max(bound, upper);
      continue;
    }
    open.push_back({a, middle});
    open.push_back({middle, b});
  }
  return bound;
}

ProjectionTree segment_tree(const std::vector<CreaseCurves>& all) {
  std::vector<ProjectionTree::Item> items;
  std::vector<Vec3> ends;
  for (const CreaseCurves& curves : all) {
    const auto first = static_cast<Index>(ends.size());
    ends.insert(ends.end(), curves.points.begin(), curves.points.end());
    for (const auto& [a, b] : curves.segments) items.push_back({{first + a, first + b, first + b}, {}});
  }
  return {std::move(ends), std::move(items)};
}

std::vector<Vec3> interface_points(const TetMesh& mesh) {
  std::vector<char> used(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) used[p] = 1;
  std::vector<Vec3> points;
  for (std::size_t p = 0; p < used.size(); ++p)
    if (used[p]) points.push_back(mesh.points[p]);
  return points;
}

double diagonal_of(const std::vector<Vec3>& points) {
  Box3 box;
  for (const Vec3& p : points) box.add(p);
  return (box.high - box.low).norm();
}

/// Calls visit(sample) for samples from p to q.
template <class Visit>
void for_each_sample(const Vec3& p, const Vec3& q, double diagonal, const Visit& visit) {
  const double length = (q - p).norm();
  const auto steps = std::max(1, static_cast<int>(std::ceil(length / diagonal * places_to_diagonal)));
  for (int k = 0; k <= steps; ++k) visit(p + (q - p) * (static_cast<double>(k) / steps));
}

}  // namespace

bool CreaseComparison::same() const {
  return max_distance <= max_crease_share * diagonal && lost_corners == 0;
}

CreaseComparison compare_creases(const CreaseCurves& expected, const std::vector<CreaseCurves>& found,
                                 std::span<const Vec3> points, double diagonal) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  CreaseComparison result;
  result.diagonal = diagonal;
  const ProjectionTree creases = segment_tree(found);
  std::vector<double> distances;
  for (const auto& [a, b] : expected.segments) {
    const Vec3 &p = expected.points[a], &q = expected.points[b];
    result.length += (q - p).norm();
    for_each_sample(p, q, diagonal, [&](const Vec3& at) {
      const auto on = creases.nearest(at, {}, infinity);
      distances.push_back(on ? (*on - at).norm() : infinity);
      if (distances.back() > result.max_distance) {
        result.max_distance = distances.back();
        result.place = at;
      }
    });
  }
  const double accuracy = std::max(bound_share * result.max_distance, bound_diagonals * result.diagonal);
  const double known = result.max_distance;
  if (std::isfinite(known))
    for (const auto& [a, b] : expected.segments)
      result.max_distance =
          std::max(result.max_distance,
                   bound_between(expected.points[a], expected.points[b], creases, known, accuracy));
  if (!distances.empty()) {
    const auto at =
        distances.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(distances.size() - 1));
    std::nth_element(distances.begin(), at, distances.end());
    result.p99_distance = *at;
  }
  result.corners = expected.corners.size();
  std::vector<ProjectionTree::Item> items;
  for (Index p = 0; p < points.size(); ++p) items.push_back({{p, p, p}, {}});
  const ProjectionTree near_corners({points.begin(), points.end()}, std::move(items));
  for (const Vec3& corner : expected.corners) {
    const auto on = near_corners.nearest(corner, {}, infinity);
    const double distance = on ? (*on - corner).norm() : infinity;
    if (distance > result.max_corner_distance) {
      result.max_corner_distance = distance;
      result.corner_place = corner;
    }
    if (distance <= max_corner_share * result.diagonal) continue;
    if (result.lost_corners++ == 0) result.lost_corner = corner;
  }
  return result;
}

CreaseComparison compare_creases(const CreaseCurves& expected, const TetMesh& mesh) {
  const std::vector<Vec3> points = interface_points(mesh);
  if (points.empty()) return {};
  // A crease may run along a curve where three regions meet.
  CreaseComparison result =
      compare_creases(expected, {mesh_creases(mesh), mesh_junctions(mesh)}, points, diagonal_of(points));
  for (double* distance : {&result.max_distance, &result.p99_distance})
    if (!std::isfinite(*distance)) *distance = result.diagonal;
  return result;
}

void measure_chains(std::vector<FeatureReport>& features, const TetMesh& mesh) {
  const ProjectionTree creases = segment_tree({mesh_creases(mesh), mesh_junctions(mesh)});
  if (creases.items().empty()) return;
  const double diagonal = diagonal_of(interface_points(mesh));
  for (FeatureReport& feature : features)
    for (CreaseChain& chain : feature.found.chains.longest) {
      double farthest = 0;
      for (std::size_t i = 0; i + 1 < chain.line.size(); ++i)
        for_each_sample(chain.line[i], chain.line[i + 1], diagonal, [&](const Vec3& at) {
          const auto on = creases.nearest(at, {}, std::numeric_limits<double>::infinity());
          farthest = std::max(farthest, (*on - at).norm());
        });
      if (!chain.line.empty()) chain.distance = farthest;
    }
}

}  // namespace tetwright
