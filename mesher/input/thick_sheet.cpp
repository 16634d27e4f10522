// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/thick_sheet.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/features/edge_uses.h"
#include "common/geometry/self_intersection.h"
#include "common/mesh/disjoint_sets.h"
#include "common/message_text.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

using OpenTuning = InputTuning::OpenSurfaces;

Vec3 centre_of(const std::vector<Vec3>& points, const Triangle& t) {
  return (points[t[0]] + points[t[1]] + points[t[2]]) / 3;
}

/// The back of open components.
class ShellBack {
 public:
  ShellBack(const OrientedSurface& s, const std::string& file, double thickness)
      : s_(s), thickness_(thickness), number_(3 * s.triangles.size(), no_index) {
    find_points(file);
    find_offsets();
    for (int round = 0; round < OpenTuning::max_rounds && follow_neighbours(); ++round) {
    }
  }

  std::size_t size() const { return front_.size(); }
  /// The number of the point behind a corner of a triangle of an open component.
  Index number(std::size_t triangle, std::size_t corner) const { return number_[3 * triangle + corner]; }
  Vec3 position(Index number) const { return s_.points[front_[number]] + thickness_ * offset_[number]; }

 private:
  bool is_own(std::size_t t) const { return s_.closed[s_.component[t]] == 0; }
  /// Whether rounding determines the normal of a triangle.
  bool is_flat(std::size_t t) const {
    const auto& [a, b, c] = s_.triangles[t];
    const Vec3 u = s_.points[b] - s_.points[a], v = s_.points[c] - s_.points[a];
    const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
    return u.cross(v).norm() <= OpenTuning::min_height * longest;
  }

  /// One point behind each fan of triangles around a point of the front.
  void find_points(const std::string& file) {
    DisjointSets corners(static_cast<Index>(number_.size()));
    const auto corner_of = [&](Index t, Index p) {
      const Triangle& own = s_.triangles[t];
      return static_cast<Index>(3 * t + (own[0] == p ? 0 : own[1] == p ? 1 : 2));
    };
    const std::vector<EdgeUse> uses = edge_uses(s_.triangles, {});
    for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
      while (j < uses.size() && uses[j].key == uses[i].key) ++j;
      if (!is_own(uses[i].triangle)) continue;
      const std::array<Index, 2> ends = ends_of(uses[i].key);
      if (j - i > 2)
        throw InputError(file, 0,
                         "--thicken needs a surface with one or two triangles at each edge, and there are " +
                             std::to_string(j - i) + " at " + place_text(s_.points[ends[0]]) +
                             "; give the sheets that meet there as separate files");
      if (j - i == 2)
        for (const Index p : ends)
          corners.unite(corner_of(uses[i].triangle, p), corner_of(uses[i + 1].triangle, p));
    }
    std::vector<Index> of_root(number_.size(), no_index);
    for (std::size_t t = 0; t < s_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3 && is_own(t); ++k) {
        Index& own = of_root[corners.root(static_cast<Index>(3 * t + k))];
        if (own == no_index) {
          own = static_cast<Index>(front_.size());
          front_.push_back(s_.triangles[t][k]);
        }
        number_[3 * t + k] = own;
      }
  }

  /// Sets the offsets so that the planes behind the triangles, weighted by their angles, are met as well as
  /// possible, within the space of those normals that differ by more than noise.
  void find_offsets() {
    std::vector<Eigen::Matrix3d> planes(size(), Eigen::Matrix3d::Zero());
    std::vector<Vec3> sums(size(), Vec3::Zero());
    for (std::size_t t = 0; t < s_.triangles.size(); ++t) {
      if (!is_own(t) || is_flat(t)) continue;
      const Vec3 normal = area_vector(s_.points, s_.triangles[t]).normalized();
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& at = s_.points[s_.triangles[t][k]];
        const Vec3 u = (s_.points[s_.triangles[t][(k + 1) % 3]] - at).normalized(),
                   v = (s_.points[s_.triangles[t][(k + 2) % 3]] - at).normalized();
        const double angle = std::acos(std::clamp(u.dot(v), -1.0, 1.0));
        planes[number(t, k)] += angle * normal * normal.transpose();
        sums[number(t, k)] += angle * normal;
      }
    }
    offset_.assign(size(), Vec3::Zero());
    for (std::size_t p = 0; p < size(); ++p) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(planes[p]);
      const double largest = axes.eigenvalues()[2];
      for (int a = 0; a < 3; ++a)
        if (const double own = axes.eigenvalues()[a]; own > OpenTuning::min_turn * largest)
          offset_[p] -= axes.eigenvectors().col(a).dot(sums[p]) / own * axes.eigenvectors().col(a);
      if (const double length = offset_[p].norm(); length > OpenTuning::max_mitre)
        offset_[p] *= OpenTuning::max_mitre / length;
    }
  }

  /// Points behind triangles that turned over get the mean offset of those around them.
  /// \return false if none turned over
  bool follow_neighbours() {
    std::vector<char> is_bad(size(), 0);
    bool any = false;
    for (std::size_t t = 0; t < s_.triangles.size(); ++t) {
      if (!is_own(t) || is_flat(t)) continue;
      const Vec3 a = position(number(t, 0)), b = position(number(t, 1)), c = position(number(t, 2));
      if ((b - a).cross(c - a).dot(area_vector(s_.points, s_.triangles[t])) > 0) continue;
      any = true;
      for (std::size_t k = 0; k < 3; ++k) is_bad[number(t, k)] = 1;
    }
    if (!any) return false;
    std::vector<Vec3> sums(size(), Vec3::Zero());
    std::vector<double> counts(size(), 0);
    for (std::size_t t = 0; t < s_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3 && is_own(t); ++k) {
        if (!is_bad[number(t, k)]) continue;
        for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3})
          sums[number(t, k)] += offset_[number(t, other)];
        counts[number(t, k)] += 2;
      }
    for (std::size_t p = 0; p < size(); ++p)
      if (is_bad[p]) offset_[p] = sums[p] / counts[p];
    return true;
  }

  const OrientedSurface& s_;
  double thickness_;
  std::vector<Index> number_;  ///< by corner of the triangles; no_index for closed components
  std::vector<Index> front_;   ///< the point of the surface
  std::vector<Vec3> offset_;   ///< from there, in thicknesses
};

}  // namespace

Diagnostic thicken(OrientedSurface& s, const std::string& file, double thickness) {
  const ShellBack back(s, file, thickness);
  s.name_open("front");
  const auto first = static_cast<Index>(s.points.size());
  const std::size_t count = s.triangles.size();
  std::vector<Triangle> behind(count);
  for (std::size_t t = 0; t < count; ++t)
    for (std::size_t k = 0; k < 3; ++k) behind[t][k] = first + back.number(t, k);
  const std::vector<HoleRim> rims = find_rims(s.points, s.triangles);
  for (Index p = 0; p < back.size(); ++p) s.points.push_back(back.position(p));
  const std::uint32_t back_group = s.group("back"), rim_group = s.group("rim");
  double area = 0;
  Vec3 place = Vec3::Zero();
  for (std::size_t t = 0; t < count; ++t) {
    if (s.closed[s.component[t]]) continue;
    if (area == 0) place = s.points[s.triangles[t][0]];
    area += area_vector(s.points, s.triangles[t]).norm();
    s.add({behind[t][0], behind[t][2], behind[t][1]}, s.component[t], back_group);
  }
  for (const HoleRim& rim : rims)
    for (std::size_t e = 0; e < rim.edges.size(); ++e) {
      const Index t = rim.at_triangle[e];
      const auto below = [&](Index p) {
        const Triangle& own = s.triangles[t];
        return behind[t][own[0] == p ? 0 : own[1] == p ? 1 : 2];
      };
      const auto& [a, b] = rim.edges[e];
      s.add({a, b, below(b)}, s.component[t], rim_group);
      s.add({a, below(b), below(a)}, s.component[t], rim_group);
    }
  std::size_t crossings = 0;
  Vec3 crossing = Vec3::Zero();
  for (const auto& [a, b] : self_intersections(s.points, s.triangles))
    if (b >= count && crossings++ == 0) crossing = centre_of(s.points, s.triangles[b]);
  if (crossings > 0)
    throw InputError(file, 0,
                     "the shell of --thicken " + short_number(thickness) + " crosses itself at " +
                         place_text(crossing) + " (" + std::to_string(crossings) +
                         " pairs of triangles); use a smaller thickness, or smooth the surface there");
  return {.code = DiagnosticCode::sheet_thickened,
          .what = "an open surface with an area of " + short_number(area),
          .done = "made the front of a shell " + short_number(thickness) +
                  " thick that lies behind it, as --thicken requests",
          .places = {place}};
}

}  // namespace tetwright
