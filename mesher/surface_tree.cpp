#include "mesher/surface_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/parallel.h"
#include "common/point_triangle.h"
#include "common/portable_math.h"

namespace tetwright {

namespace {

/// Of 4, 8 and 12 the fastest by a little, in benchmarks/mesher/surface_tree_benchmark.cpp.
constexpr std::size_t leaf_size = 8;

/// The series is used from this many radii of a node on. 2 leaves errors up to 0.006, 3 up to 0.001 in twice
/// the time (surfaces of 200,000 triangles, points near them).
constexpr double far_radii = 2;

/// Ranges of more triangles are split by one thread, smaller ones in parallel.
constexpr std::size_t parallel_below = 1 << 14;

/// Sum of angles in (-pi, pi) as a product of complex numbers, which needs one arc tangent in all.
class AngleSum {
 public:
  /// Adds the angle of (re, im); nothing for im = 0, whatever re is.
  void add(double re, double im) {
    if (im == 0) return;
    const double shrink = 1 / (std::fabs(re) + std::fabs(im));
    re *= shrink, im *= shrink;
    const double next_re = re_ * re - im_ * im, next_im = re_ * im + im_ * re;
    // Two angles above 0 whose sum is below 0 went past pi; one of exactly -pi is kept as pi.
    if (im_ >= 0 && im > 0 && next_im < 0) ++turns_;
    if (im_ < 0 && im < 0 && next_im >= 0) --turns_;
    re_ = next_re, im_ = next_im;
    // Each factor shrinks the product by sqrt(1/2) at most.
    if (++factors_ % 1024 == 0) {
      const double grow = 1 / (std::fabs(re_) + std::fabs(im_));
      re_ *= grow, im_ *= grow;
    }
  }
  /// In units of a whole turn.
  double turns() const {
    const double angle = portable_atan2_upper(std::fabs(im_), re_);
    return static_cast<double>(turns_) + (im_ < 0 ? -angle : angle) / (2 * std::numbers::pi);
  }

 private:
  double re_ = 1, im_ = 0;
  std::int64_t turns_ = 0;
  std::uint32_t factors_ = 0;
};

/// Adds half the solid angle under which p sees a triangle, positive from behind (van Oosterom & Strackee
/// 1983, eq. 8).
void add_half_solid_angle(const Vec3& ta, const Vec3& tb, const Vec3& tc, const Vec3& p, AngleSum& sum) {
  const Vec3 a = ta - p, b = tb - p, c = tc - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  sum.add(la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb, a.dot(b.cross(c)));
}

/// Homogeneous polynomials by their coefficients: x, y, z; xx, xy, xz, yy, yz, zz;
/// xxx, xxy, xxz, xyy, xyz, xzz, yyy, yyz, yzz, zzz.
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

/// Moments of the normals of triangles about a centre: with n the normal and d the place of a surface
/// element, the integrals of n, (n . x)(d . x) and (n . x)(d . x)^2.
struct Moments {
  Vec3 normal = Vec3::Zero();
  Quadratic quadratic{};
  Cubic cubic{};

  /// A triangle with the corners a, b, c as seen from the centre.
  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = 0.5 * (b - a).cross(c - a), sum = a + b + c;
    normal += n;
    add(quadratic, product(n, sum), 1.0 / 3);
    // The integral of d d over a triangle of area 1: (a a + b b + c c + sum sum) / 12.
    Quadratic square = product(sum, sum);
    for (const Vec3& corner : {a, b, c}) add(square, product(corner, corner));
    add(cubic, product(n, square), 1.0 / 12);
  }

  /// Moments about another centre, `shift` from this one.
  void add_moments(const Moments& m, const Vec3& shift) {
    normal += m.normal;
    add(quadratic, m.quadratic);
    add(quadratic, product(m.normal, shift));
    add(cubic, m.cubic);
    add(cubic, product(shift, m.quadratic), 2);
    add(cubic, product(m.normal, product(shift, shift)));
  }
};

/// The harmonic part, the only one that the derivatives of 1 / r see.
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

/// Leaves of a node of so many triangles.
std::uint32_t leaves_for(std::size_t triangles) {
  return static_cast<std::uint32_t>((triangles + leaf_size - 1) / leaf_size);
}

}  // namespace

double SurfaceTree::Box::squared_distance(const Vec3& p) const {
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

SurfaceTree::SurfaceTree(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  const std::size_t n = triangles.size();
  if (n == 0) return;
  // The longest side becomes about 1: products of up to nine lengths must neither overflow nor vanish.
  Vec3 low = points[triangles[0][0]], high = low;
  for (const Triangle& t : triangles)
    for (Index v : t) low = low.cwiseMin(points[v]), high = high.cwiseMax(points[v]);
  const double half_side = (0.5 * high - 0.5 * low).maxCoeff();
  if (half_side > 0) scale_ = std::ldexp(1.0, std::clamp(-std::ilogb(half_side), -1000, 1000));

  std::vector<std::array<Vec3, 3>> corners(n);
  std::vector<Vec3> middles(n);  // times 3
  for (std::size_t t = 0; t < n; ++t) {
    for (std::size_t k = 0; k < 3; ++k) corners[t][k] = scale_ * points[triangles[t][k]];
    middles[t] = corners[t][0] + corners[t][1] + corners[t][2];
  }

  // Halves at the median of the longest side, in whole leaves, so that the places of all nodes are known.
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index{0});
  nodes_.resize(2 * leaves_for(n) - 1);
  boxes_.resize(nodes_.size());
  struct Range {
    std::uint32_t node, begin, end;
  };
  const auto split = [&](const Range& range, std::vector<Range>& parts) {
    const auto& [node, begin, end] = range;
    const std::uint32_t leaves = leaves_for(end - begin);
    nodes_[node].next = node + 2 * leaves - 1;
    nodes_[node].begin = begin;
    nodes_[node].end = end;
    Box& box = boxes_[node];
    box.low = box.high = corners[order[begin]][0];
    for (std::uint32_t i = begin; i < end; ++i)
      for (const Vec3& c : corners[order[i]]) box.low = box.low.cwiseMin(c), box.high = box.high.cwiseMax(c);
    const auto at = [&](std::uint32_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    if (leaves == 1) {
      std::sort(at(begin), at(end));
      return;
    }
    Eigen::Index axis;
    (box.high - box.low).maxCoeff(&axis);
    const std::uint32_t middle = begin + leaves / 2 * static_cast<std::uint32_t>(leaf_size);
    std::nth_element(at(begin), at(middle), at(end), [&](Index a, Index b) {
      return middles[a][axis] != middles[b][axis] ? middles[a][axis] < middles[b][axis] : a < b;
    });
    parts.push_back({node + 2 * (leaves / 2), middle, end});
    parts.push_back({node + 1, begin, middle});
  };
  std::vector<Range> open{{0, 0, static_cast<std::uint32_t>(n)}}, small;
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    if (range.end - range.begin < parallel_below)
      small.push_back(range);
    else
      split(range, open);
  }
  parallel_for(0, small.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      for (std::vector<Range> stack{small[k]}; !stack.empty();) {
        const Range range = stack.back();
        stack.pop_back();
        split(range, stack);
      }
  });
  triangles_.resize(n);
  for (std::size_t i = 0; i < n; ++i) triangles_[i] = corners[order[i]];
  make_series();
}

void SurfaceTree::make_series() {
  std::vector<Moments> moments(nodes_.size());
  parallel_for(0, nodes_.size(), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      Node& node = nodes_[i];
      const Vec3 origin = boxes_[i].low;  // sums of differences: nothing is lost far from the origin
      Vec3 sum = Vec3::Zero();
      double area = 0;
      for (std::uint32_t t = node.begin; t < node.end; ++t) {
        const auto& [a, b, c] = triangles_[t];
        const double weight = (b - a).cross(c - a).norm();
        sum += weight * ((a - origin) + (b - origin) + (c - origin));
        area += weight;
      }
      node.centre = area > 0 ? Vec3(origin + sum / (3 * area)) : origin;
      double radius_squared = 0;
      for (std::uint32_t t = node.begin; t < node.end; ++t)
        for (const Vec3& c : triangles_[t])
          radius_squared = std::max(radius_squared, (c - node.centre).squaredNorm());
      node.far_squared = far_radii * far_radii * radius_squared;
      if (node.end - node.begin > leaf_size) continue;
      for (std::uint32_t t = node.begin; t < node.end; ++t) {
        const auto& [a, b, c] = triangles_[t];
        moments[i].add_triangle(a - node.centre, b - node.centre, c - node.centre);
      }
    }
  });
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    if (node.end - node.begin > leaf_size)
      for (const std::size_t child : {i + 1, static_cast<std::size_t>(nodes_[i + 1].next)})
        moments[i].add_moments(moments[child], nodes_[child].centre - node.centre);
    node.normal = moments[i].normal;
    node.quadratic = traceless(moments[i].quadratic);
    node.cubic = traceless(moments[i].cubic);
  }
}

double SurfaceTree::winding_number(const Vec3& p) const {
  const Vec3 from = scale_ * p;
  double far = 0;  // times 4 pi
  AngleSum near;
  for (std::size_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    const Vec3 r = node.centre - from;
    const double r2 = r.squaredNorm();
    if (r2 > node.far_squared) {
      // The kernel r / |r|^3 and its derivatives.
      const double r2_inverse = 1 / r2;
      far += r2_inverse * std::sqrt(r2_inverse) *
             (node.normal.dot(r) +
              r2_inverse * (-3 * value(node.quadratic, r) + 7.5 * r2_inverse * value(node.cubic, r)));
    } else if (node.end - node.begin > leaf_size) {
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

double SurfaceTree::distance(const Vec3& p, double at_most) const {
  if (nodes_.empty() || !(at_most > 0)) return at_most;
  const Vec3 from = scale_ * p;
  const double limit = (scale_ * at_most) * (scale_ * at_most);
  double best = limit;
  struct Entry {
    std::uint32_t node;
    double squared_distance;
  };
  std::array<Entry, 64> stack;  // the tree is at most 32 high
  std::size_t size = 0;
  stack[size++] = {0, boxes_[0].squared_distance(from)};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.squared_distance >= best) continue;
    const Node& node = nodes_[entry.node];
    if (node.end - node.begin <= leaf_size) {
      for (std::uint32_t t = node.begin; t < node.end; ++t)
        best = std::min(best, squared_distance(from, triangles_[t][0], triangles_[t][1], triangles_[t][2]));
      continue;
    }
    Entry near{entry.node + 1, boxes_[entry.node + 1].squared_distance(from)};
    const std::uint32_t second = nodes_[near.node].next;
    Entry far{second, boxes_[second].squared_distance(from)};
    if (far.squared_distance < near.squared_distance) std::swap(near, far);
    stack[size++] = far;
    stack[size++] = near;
  }
  return best < limit ? std::sqrt(best) / scale_ : at_most;
}

double winding_number(std::span<const Vec3> points, std::span<const Triangle> triangles, const Vec3& p) {
  AngleSum sum;
  for (const auto& [a, b, c] : triangles) add_half_solid_angle(points[a], points[b], points[c], p, sum);
  return sum.turns();
}

}  // namespace tetwright
