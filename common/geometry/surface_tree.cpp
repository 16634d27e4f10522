// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/surface_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/distance_tree.h"
#include "common/portable_math.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Slightly faster than 4 and 12 in benchmarks/mesher/surface_tree_benchmark.cpp.
constexpr std::size_t triangles_in_leaf = 8;

/// Distance in node radii beyond which the series is used. At 2 the error is up to 0.006, at 3 up to 0.001 in
/// twice the time (surfaces of 200,000 triangles, points near them).
constexpr double far_radii = 2;

/// Sum of angles in (-pi, pi) as a product of complex numbers, which needs a single arc tangent.
class AngleSum {
 public:
  /// Adds the angle of (re, im); adds nothing if im = 0, for any re.
  void add(double re, double im) {
    if (im == 0) return;
    const double shrink = 1 / (std::fabs(re) + std::fabs(im));
    re *= shrink, im *= shrink;
    const double next_re = re_ * re - im_ * im, next_im = re_ * im + im_ * re;
    // If two positive angles have a negative sum, it wrapped around pi; an angle of exactly -pi is kept as
    // pi.
    if (im_ >= 0 && im > 0 && next_im < 0) ++turns_;
    if (im_ < 0 && im < 0 && next_im >= 0) --turns_;
    re_ = next_re, im_ = next_im;
    // A factor shrinks the product to no less than sqrt(1/2) of its size.
    if (++factors_ % 1024 == 0) {
      const double grow = 1 / (std::fabs(re_) + std::fabs(im_));
      re_ *= grow, im_ *= grow;
    }
  }
  /// Sum of the angles, in full turns.
  double turns() const {
    const double angle = portable_atan2_upper(std::fabs(im_), re_);
    return static_cast<double>(turns_) + (im_ < 0 ? -angle : angle) / (2 * std::numbers::pi);
  }

 private:
  double re_ = 1, im_ = 0;
  std::int64_t turns_ = 0;
  std::uint32_t factors_ = 0;
};

/// Adds half the solid angle that a triangle subtends at p, positive if p is behind it (van Oosterom &
/// Strackee 1983, eq. 8).
void add_half_solid_angle(const Vec3& ta, const Vec3& tb, const Vec3& tc, const Vec3& p, AngleSum& sum) {
  const Vec3 a = ta - p, b = tb - p, c = tc - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  sum.add(la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb, a.dot(b.cross(c)));
}

/// Coefficients of homogeneous polynomials: x, y, z; xx, xy, xz, yy, yz, zz; xxx, xxy, xxz, xyy, xyz, xzz,
/// yyy, yyz, yzz, zzz.
using Quadratic = std::array<double, 6>;
using Cubic = std::array<double, 10>;

Quadratic product(const Vec3& u, const Vec3& v) {
  return {u[0] * v[0], u[0] * v[1] + u[1] * v[0], u[0] * v[2] + u[2] * v[0],
          u[1] * v[1], u[1] * v[2] + u[2] * v[1], u[2] * v[2]};
}

Cubic product(const Vec3& u, const Quadratic& q) {
  return {u[0] * q[0],
          u[0] * q[1] + u[1] * q[0],
          u[0] * q[2] + u[2] * q[0],
          u[0] * q[3] + u[1] * q[1],
          u[0] * q[4] + u[1] * q[2] + u[2] * q[1],
          u[0] * q[5] + u[2] * q[2],
          u[1] * q[3],
          u[1] * q[4] + u[2] * q[3],
          u[1] * q[5] + u[2] * q[4],
          u[2] * q[5]};
}

template <std::size_t N>
void add(std::array<double, N>& sum, const std::array<double, N>& term, double factor = 1) {
  for (std::size_t i = 0; i < N; ++i) sum[i] += factor * term[i];
}

/// Moments of the normals of triangles about a centre: with n the normal and d the position of a surface
/// element, the integrals of n, (n . x)(d . x) and (n . x)(d . x)^2.
struct Moments {
  Vec3 normal = Vec3::Zero();
  Quadratic quadratic{};
  Cubic cubic{};

  /// Adds a triangle with the corners a, b, c relative to the centre.
  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = 0.5 * (b - a).cross(c - a), sum = a + b + c;
    normal += n;
    add(quadratic, product(n, sum), 1.0 / 3);
    // The integral of d d over a triangle of area 1: (a a + b b + c c + sum sum) / 12.
    Quadratic square = product(sum, sum);
    for (const Vec3& corner : {a, b, c}) add(square, product(corner, corner));
    add(cubic, product(n, square), 1.0 / 12);
  }

  /// Adds moments about another centre, which is at `shift` from this one.
  void add_moments(const Moments& m, const Vec3& shift) {
    normal += m.normal;
    add(quadratic, m.quadratic);
    add(quadratic, product(m.normal, shift));
    add(cubic, m.cubic);
    add(cubic, product(shift, m.quadratic), 2);
    add(cubic, product(m.normal, product(shift, shift)));
  }
};

/// Harmonic part of a polynomial: derivatives of 1 / r depend on no other.
Quadratic traceless(Quadratic q) {
  const double third = (q[0] + q[3] + q[5]) / 3;
  q[0] -= third, q[3] -= third, q[5] -= third;
  return q;
}

Cubic traceless(Cubic c) {
  // The Laplacian of r^2 (u . x) is 10 (u . x).
  const Vec3 u(6 * c[0] + 2 * c[3] + 2 * c[5], 2 * c[1] + 6 * c[6] + 2 * c[8],
               2 * c[2] + 2 * c[7] + 6 * c[9]);
  add(c, product(u, Quadratic{1, 0, 0, 1, 0, 1}), -0.1);
  return c;
}

double value(const Quadratic& q, const Vec3& v) {
  const double x = v.x(), y = v.y(), z = v.z();
  return x * (q[0] * x + q[1] * y + q[2] * z) + y * (q[3] * y + q[4] * z) + q[5] * z * z;
}

double value(const Cubic& c, const Vec3& v) {
  const double x = v.x(), y = v.y(), z = v.z();
  return x * (x * (c[0] * x + c[1] * y + c[2] * z) + y * (c[3] * y + c[4] * z) + c[5] * z * z) +
         y * (y * (c[6] * y + c[7] * z) + c[8] * z * z) + c[9] * z * z * z;
}

}  // namespace

SurfaceTree::SurfaceTree(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  const std::size_t n = triangles.size();
  if (n == 0) return;
  scale_ = unit_scale(points, triangles);
  std::vector<std::array<Vec3, 3>> corners(n);
  std::vector<Vec3> middles(n);  // times 3
  for (std::size_t t = 0; t < n; ++t) {
    for (std::size_t k = 0; k < 3; ++k) corners[t][k] = scale_ * points[triangles[t][k]];
    middles[t] = corners[t][0] + corners[t][1] + corners[t][2];
  }

  std::vector<Box3> boxes(n);
  for (std::size_t t = 0; t < n; ++t)
    for (const Vec3& c : corners[t]) boxes[t].add(c);
  const std::vector<Index> order = median_order(boxes, middles, triangles_in_leaf);
  tree_ = BoxTree(n, triangles_in_leaf, [&](std::size_t i) { return boxes[order[i]]; });
  triangles_.resize(n);
  for (std::size_t i = 0; i < n; ++i) triangles_[i] = corners[order[i]];
  make_series();
}

void SurfaceTree::make_series() {
  const std::span<const BoxTree::Node> nodes = tree_.nodes();
  series_.resize(nodes.size());
  std::vector<Moments> moments(nodes.size());
  parallel_for(0, nodes.size(), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const BoxTree::Node& node = nodes[i];
      Series& series = series_[i];
      const Vec3 origin = node.box.low;  // differences keep their digits even far from the origin
      Vec3 sum = Vec3::Zero();
      double area = 0;
      for (std::uint32_t t = node.begin; t < node.end; ++t) {
        const auto& [a, b, c] = triangles_[t];
        const double weight = (b - a).cross(c - a).norm();
        sum += weight * ((a - origin) + (b - origin) + (c - origin));
        area += weight;
      }
      series.centre = area > 0 ? Vec3(origin + sum / (3 * area)) : origin;
      double radius_squared = 0;
      for (std::uint32_t t = node.begin; t < node.end; ++t)
        for (const Vec3& c : triangles_[t])
          radius_squared = std::max(radius_squared, (c - series.centre).squaredNorm());
      series.far_squared = far_radii * far_radii * radius_squared;
      if (!tree_.is_leaf(node)) continue;
      for (std::uint32_t t = node.begin; t < node.end; ++t) {
        const auto& [a, b, c] = triangles_[t];
        moments[i].add_triangle(a - series.centre, b - series.centre, c - series.centre);
      }
    }
  });
  for (std::size_t i = nodes.size(); i-- > 0;) {
    Series& series = series_[i];
    if (!tree_.is_leaf(nodes[i]))
      for (const std::size_t child : {i + 1, static_cast<std::size_t>(nodes[i + 1].next)})
        moments[i].add_moments(moments[child], series_[child].centre - series.centre);
    series.normal = moments[i].normal;
    series.quadratic = traceless(moments[i].quadratic);
    series.cubic = traceless(moments[i].cubic);
  }
}

double SurfaceTree::winding_number(const Vec3& p) const {
  const std::span<const BoxTree::Node> nodes = tree_.nodes();
  const Vec3 from = scale_ * p;
  double far = 0;  // times 4 pi
  AngleSum near;
  for (std::size_t i = 0; i < nodes.size();) {
    const BoxTree::Node& node = nodes[i];
    const Series& series = series_[i];
    const Vec3 r = series.centre - from;
    const double r2 = r.squaredNorm();
    if (r2 > series.far_squared) {
      // The kernel r / |r|^3 and its derivatives.
      const double r2_inverse = 1 / r2;
      far += r2_inverse * std::sqrt(r2_inverse) *
             (series.normal.dot(r) +
              r2_inverse * (-3 * value(series.quadratic, r) + 7.5 * r2_inverse * value(series.cubic, r)));
    } else if (!tree_.is_leaf(node)) {
      ++i;
      continue;
    } else {
      for (std::uint32_t t = node.begin; t < node.end; ++t)
        add_half_solid_angle(triangles_[t][0], triangles_[t][1], triangles_[t][2], from, near);
    }
    i = node.next;
  }
  return far / (4 * std::numbers::pi) + near.turns();
}

double winding_number(std::span<const Vec3> points, std::span<const Triangle> triangles, const Vec3& p) {
  AngleSum sum;
  for (const auto& [a, b, c] : triangles) add_half_solid_angle(points[a], points[b], points[c], p, sum);
  return sum.turns();
}

}  // namespace tetwright
