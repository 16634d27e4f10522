// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/point_triangle.h"

#include <algorithm>

#include "common/tolerances.h"

namespace tetwright {

namespace {

/// Squared sine of a triangle's angle below which products of its edges are too inaccurate for weights: at
/// 1e-8, rounding of 1e-16 is a relative error of 1e-8.
constexpr double needle_squared = 1e-8;

Vec3 closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0;
  return a + t * ab;
}

}  // namespace

Vec3 closest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  // Barycentric coordinates of the projection onto the plane.
  const double d00 = ab.dot(ab), d01 = ab.dot(ac), d11 = ac.dot(ac), d20 = ap.dot(ab), d21 = ap.dot(ac);
  const double denominator = d00 * d11 - d01 * d01;
  const bool needle = denominator <= needle_squared * d00 * d11;
  if (!needle) {
    const double v = (d11 * d20 - d01 * d21) / denominator, w = (d00 * d21 - d01 * d20) / denominator;
    if (v >= 0 && w >= 0 && v + w <= 1) return a + v * ab + w * ac;
  }
  Vec3 best = closest_on_segment(p, a, b);
  for (const Vec3& q : {closest_on_segment(p, b, c), closest_on_segment(p, c, a)})
    if ((p - q).squaredNorm() < (p - best).squaredNorm()) best = q;
  if (!needle) return best;
  // The weights above would be mostly rounding error; these are as accurate as a cross product.
  const std::array<double, 3> w = weights_in_triangle(p, a, b, c);
  const Vec3 within = w[0] * a + w[1] * b + w[2] * c;
  return (p - within).squaredNorm() < (p - best).squaredNorm() ? within : best;
}

double squared_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return (p - closest_point(p, a, b, c)).squaredNorm();
}

std::array<double, 3> weights_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::array<Vec3, 3> corners{a, b, c};
  std::array<double, 3> w{1, 0, 0};
  const Vec3 normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (area > tolerance::flat_squared * (b - a).squaredNorm() * (c - a).squaredNorm()) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      w[i] = std::max(0.0, normal.dot((corners[(i + 1) % 3] - p).cross(corners[(i + 2) % 3] - p)));
      sum += w[i];
    }
    if (sum > 0) {
      for (double& x : w) x /= sum;
      return w;
    }
    w = {1, 0, 0};
  }
  int from = 0;
  double longest = 0;
  for (int i = 0; i < 3; ++i)
    if (const double length = (corners[(i + 1) % 3] - corners[i]).squaredNorm(); length > longest) {
      longest = length;
      from = i;
    }
  if (longest == 0) return w;
  const int to = (from + 1) % 3;
  const double t = std::clamp((p - corners[from]).dot(corners[to] - corners[from]) / longest, 0.0, 1.0);
  w = {0, 0, 0};
  w[from] = 1 - t;
  w[to] = t;
  return w;
}

}  // namespace tetwright
