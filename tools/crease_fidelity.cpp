#include "tools/crease_fidelity.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/geometry/projection_tree.h"

namespace tetwright {

namespace {

constexpr double max_crease_share = 0.005, max_corner_share = 0.001;
constexpr double places_to_diagonal = 2000;

}  // namespace

bool CreaseFidelity::same() const { return max_distance <= max_crease_share * diagonal && lost_corners == 0; }

CreaseFidelity compare_creases(const CreaseCurves& expected, const TetMesh& mesh) {
  CreaseFidelity result;
  Box3 box;
  std::vector<ProjectionTree::Item> points;
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) {
      box.add(mesh.points[p]);
      points.push_back({{p, p, p}, {}});
    }
  if (points.empty()) return result;
  result.diagonal = (box.high - box.low).norm();
  // A crease may run along a curve where three regions meet.
  std::vector<Vec3> ends;
  std::vector<ProjectionTree::Item> segments;
  for (const CreaseCurves& found : {mesh_creases(mesh), mesh_junctions(mesh)}) {
    const auto first = static_cast<Index>(ends.size());
    ends.insert(ends.end(), found.points.begin(), found.points.end());
    for (const auto& [a, b] : found.segments) segments.push_back({{first + a, first + b, first + b}, {}});
  }
  const ProjectionTree creases(std::move(ends), std::move(segments));
  // Nothing is farther from all creases than this where there are none.
  const double farthest = result.diagonal;
  std::vector<double> distances;
  for (const auto& [a, b] : expected.segments) {
    const Vec3 &p = expected.points[a], &q = expected.points[b];
    const double length = (q - p).norm();
    result.length += length;
    const auto steps =
        std::max(1, static_cast<int>(std::ceil(length / result.diagonal * places_to_diagonal)));
    for (int k = 0; k <= steps; ++k) {
      const Vec3 at = p + (q - p) * (static_cast<double>(k) / steps);
      const auto on = creases.nearest(at, {}, farthest);
      distances.push_back(on ? (*on - at).norm() : farthest);
      if (distances.back() > result.max_distance) {
        result.max_distance = distances.back();
        result.place = at;
      }
    }
  }
  if (!distances.empty()) {
    const auto at =
        distances.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(distances.size() - 1));
    std::nth_element(distances.begin(), at, distances.end());
    result.p99_distance = *at;
  }
  result.corners = expected.corners.size();
  const ProjectionTree boundary(mesh.points, std::move(points));
  for (const Vec3& corner : expected.corners) {
    const auto on = boundary.nearest(corner, {}, farthest);
    const double distance = on ? (*on - corner).norm() : farthest;
    result.max_corner_distance = std::max(result.max_corner_distance, distance);
    if (distance <= max_corner_share * result.diagonal) continue;
    if (result.lost_corners++ == 0) result.lost_corner = corner;
  }
  return result;
}

}  // namespace tetwright
