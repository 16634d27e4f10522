// SPDX-License-Identifier: Apache-2.0
#include "tools/compare/input_limited.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

/// A point farther than this from a crease or corner, as a fraction of the diagonal, is not on it.
constexpr double on_crease_share = 1e-3;
constexpr int bisection_steps = 60;

using EdgeOfMaterial = std::pair<std::array<Index, 2>, MaterialTag>;
using PointOfMaterial = std::pair<Index, MaterialTag>;

std::array<Vec3, 4> corners_of(const TetMesh& mesh, const Tet& t) {
  return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]};
}

std::array<Index, 2> edge_of(const Tet& t, std::size_t e) {
  const auto [low, high] = std::minmax(t[tet_edges[e][0]], t[tet_edges[e][1]]);
  return {low, high};
}

/// Maximum of the smallest solid angle over all tets that have an edge of length 1 on such a wedge.
double best_solid_angle(double wedge) {
  // The farther the opposite edge, the larger the angles at this edge and the smaller those at the opposite
  // edge.
  double low = 0, high = 100, best = 0;
  for (int step = 0; step < bisection_steps; ++step) {
    const double far = (low + high) / 2, y = far * std::cos(wedge / 2), z = far * std::sin(wedge / 2);
    const std::array<double, 4> angles =
        solid_angles({Vec3(-0.5, 0, 0), Vec3(0.5, 0, 0), Vec3(0, y, -z), Vec3(0, y, z)});
    best = std::max(best, std::min(angles[0], angles[2]));
    (angles[0] < angles[2] ? low : high) = far;
  }
  return best;
}

/// Finds points on creases and at corners.
class InputCreases {
 public:
  InputCreases(const CreaseCurves& creases, const TetMesh& mesh) {
    std::vector<ProjectionTree::Item> segments, corners;
    for (const auto& [a, b] : creases.segments) segments.push_back({{a, b, b}, {}});
    for (Index c = 0; c < creases.corners.size(); ++c) corners.push_back({{c, c, c}, {}});
    segments_ = ProjectionTree(creases.points, std::move(segments));
    corners_ = ProjectionTree(creases.corners, std::move(corners));
    Box3 box;
    for (const Vec3& p : mesh.points) box.add(p);
    reach_ = on_crease_share * (box.high - box.low).norm();
  }
  bool has_edge(const Vec3& a, const Vec3& b) const {
    return on_crease(a) && on_crease(b) && on_crease((a + b) / 2);
  }
  bool has_corner(const Vec3& p) const { return corners_.nearest(p, {}, reach_).has_value(); }

 private:
  bool on_crease(const Vec3& p) const { return segments_.nearest(p, {}, reach_).has_value(); }

  ProjectionTree segments_, corners_;
  double reach_ = 0;
};

}  // namespace

double narrowest_wedge(double solid_angle) {
  double low = 0, high = std::acos(1.0 / 3);  // dihedral angle of the regular tet
  for (int step = 0; step < bisection_steps; ++step) {
    const double wedge = (low + high) / 2;
    (best_solid_angle(wedge) < solid_angle ? low : high) = wedge;
  }
  return high;
}

std::size_t input_limited_tets(const TetMesh& mesh, const CreaseCurves& creases, double threshold) {
  if (creases.segments.empty()) return 0;
  const InputCreases input(creases, mesh);
  // Angles for each material: radians at edges, steradians at points.
  std::map<EdgeOfMaterial, double> wedges;
  std::map<PointOfMaterial, double> cones;
  std::vector<Index> bad;
  for (Index i = 0; i < mesh.tets.size(); ++i) {
    const Tet& t = mesh.tets[i];
    const std::array<Vec3, 4> p = corners_of(mesh, t);
    if (min_solid_angle(p[0], p[1], p[2], p[3]) >= threshold) continue;
    bad.push_back(i);
    for (std::size_t e = 0; e < tet_edges.size(); ++e)
      if (input.has_edge(p[tet_edges[e][0]], p[tet_edges[e][1]]))
        wedges[{edge_of(t, e), mesh.materials[i]}] = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (input.has_corner(p[k])) cones[{t[k], mesh.materials[i]}] = 0;
  }
  if (wedges.empty() && cones.empty()) return 0;
  std::vector<std::uint8_t> is_near(mesh.points.size(), 0);
  for (const auto& [edge, wedge] : wedges)
    for (const Index p : edge.first) is_near[p] = 1;
  for (const auto& [point, cone] : cones) is_near[point.first] = 1;
  for (Index i = 0; i < mesh.tets.size(); ++i) {
    const Tet& t = mesh.tets[i];
    if (std::none_of(t.begin(), t.end(), [&](Index p) { return is_near[p] != 0; })) continue;
    const std::array<Vec3, 4> p = corners_of(mesh, t);
    const std::array<double, 6> dihedral = dihedral_angles(p);
    for (std::size_t e = 0; e < tet_edges.size(); ++e)
      if (const auto wedge = wedges.find({edge_of(t, e), mesh.materials[i]}); wedge != wedges.end())
        wedge->second += dihedral[e] * std::numbers::pi / 180;
    const std::array<double, 4> solid = solid_angles(p);
    for (std::size_t k = 0; k < 4; ++k)
      if (const auto cone = cones.find({t[k], mesh.materials[i]}); cone != cones.end())
        cone->second += solid[k];
  }
  const double narrowest = narrowest_wedge(threshold);
  return static_cast<std::size_t>(std::count_if(bad.begin(), bad.end(), [&](Index i) {
    const Tet& t = mesh.tets[i];
    for (std::size_t e = 0; e < tet_edges.size(); ++e)
      if (const auto wedge = wedges.find({edge_of(t, e), mesh.materials[i]});
          wedge != wedges.end() && wedge->second < narrowest)
        return true;
    return std::any_of(t.begin(), t.end(), [&](Index p) {
      const auto cone = cones.find({p, mesh.materials[i]});
      return cone != cones.end() && cone->second < threshold;
    });
  }));
}

}  // namespace tetwright
