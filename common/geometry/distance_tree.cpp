// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/distance_tree.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/point_triangle.h"

namespace tetwright {

namespace {

/// Squared sine of a triangle's angle at its first corner below which its plane is not used. At 1e-8 rounding
/// turns the normal by up to 1e-11.
constexpr double thin_squared = 1e-8;
/// Squared normals below this may have lost digits to underflow.
constexpr double min_squared = 1e-280;
/// Error of a height above a triangle's plane, as a share of the distance along the axes from its first
/// corner.
constexpr double height_error = 1e-10;

}  // namespace

double unit_scale(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  if (triangles.empty()) return 1;
  Vec3 low = points[triangles[0][0]], high = low;
  for (const Triangle& t : triangles)
    for (Index v : t) low = low.cwiseMin(points[v]), high = high.cwiseMax(points[v]);
  const double half_side = (0.5 * high - 0.5 * low).maxCoeff();
  return half_side > 0 ? std::ldexp(1.0, std::clamp(-std::ilogb(half_side), -1000, 1000)) : 1;
}

DistanceTree::DistanceTree(std::span<const Vec3> points, std::span<const Triangle> triangles)
    : scale_(unit_scale(points, triangles)), triangles_(triangles.size()), normals_(triangles.size()) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) triangles_[t][k] = scale_ * points[triangles[t][k]];
    const Vec3 ab = triangles_[t][1] - triangles_[t][0], ac = triangles_[t][2] - triangles_[t][0];
    const Vec3 normal = ab.cross(ac);
    const double squared = normal.squaredNorm();
    normals_[t] = squared > min_squared && squared > thin_squared * ab.squaredNorm() * ac.squaredNorm()
                      ? Vec3(normal / std::sqrt(squared))
                      : Vec3(Vec3::Zero());
  }
  tree_ = ReferenceTree(triangles_);
}

double DistanceTree::distance(const Vec3& p, double at_most) const {
  if (!(at_most > 0)) return at_most;
  const Vec3 from = scale_ * p;
  const double limit = (scale_ * at_most) * (scale_ * at_most);
  const double best = tree_.nearest(from, limit, [&](std::size_t t, double so_far) {
    const auto& [a, b, c] = triangles_[t];
    const Vec3 away = from - a;
    const double height = std::abs(normals_[t].dot(away)) - height_error * away.lpNorm<1>();
    if (height > 0 && height * height > so_far) return so_far;
    return std::min(so_far, squared_distance(from, a, b, c));
  });
  return best < limit ? std::sqrt(best) / scale_ : at_most;
}

}  // namespace tetwright
