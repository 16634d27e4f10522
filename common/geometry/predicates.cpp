// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/predicates.h"

#include <algorithm>
#include <vector>

namespace tetwright {

namespace {

/// Maximum relative error of the rounded orient3d, as a factor on the sum of its absolute terms (Shewchuk
/// 1997, section 4.3: (7 + 56 eps) eps with eps = 2^-53).
constexpr double orient3d_bound = (7 + 56 * 0x1p-53) * 0x1p-53;
/// Counterpart for orient2d: (3 + 16 eps) eps.
constexpr double orient2d_bound = (3 + 16 * 0x1p-53) * 0x1p-53;

/// An exact number as a sum of nonoverlapping doubles, smallest first (Shewchuk 1997, section 2).
using Expansion = std::vector<double>;

struct TwoParts {
  double high, low;
};

TwoParts two_sum(double a, double b) {
  const double x = a + b;
  const double bv = x - a;
  const double av = x - bv;
  return {x, (a - av) + (b - bv)};
}

/// Dekker's product. std::fma is far slower without hardware support.
TwoParts two_product(double a, double b) {
  constexpr double splitter = 0x1p27 + 1;
  const auto split = [](double v) {
    const double c = splitter * v;
    const double high = c - (c - v);
    return TwoParts{high, v - high};
  };
  const double x = a * b;
  const TwoParts p = split(a), q = split(b);
  const double error = ((x - p.high * q.high) - p.low * q.high) - p.high * q.low;
  return {x, p.low * q.low - error};
}

/// Adds one double (Shewchuk's Grow-Expansion) and drops zeros.
void grow(Expansion& e, double b) {
  double q = b;
  std::size_t out = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    const TwoParts s = two_sum(q, e[i]);
    q = s.high;
    if (s.low != 0) e[out++] = s.low;
  }
  e.resize(out);
  if (q != 0) e.push_back(q);
}

Expansion difference(double a, double b) {
  const TwoParts s = two_sum(a, -b);
  Expansion e;
  if (s.low != 0) e.push_back(s.low);
  if (s.high != 0) e.push_back(s.high);
  return e;
}

Expansion product(const Expansion& a, const Expansion& b) {
  Expansion out;
  for (double x : a)
    for (double y : b) {
      const TwoParts p = two_product(x, y);
      grow(out, p.low);
      grow(out, p.high);
    }
  return out;
}

Expansion minus(Expansion a, const Expansion& b) {
  for (double x : b) grow(a, -x);
  return a;
}

Expansion plus(Expansion a, const Expansion& b) {
  for (double x : b) grow(a, x);
  return a;
}

int sign(const Expansion& e) { return e.empty() ? 0 : e.back() > 0 ? 1 : -1; }

/// Exponent of the power of two that scales the largest coordinate to about 2^100. Products then do not
/// overflow, and underflow only for absurd ranges of coordinates.
int safe_exponent(std::initializer_list<const Vec3*> points) {
  double largest = 0;
  for (const Vec3* p : points) largest = std::max(largest, p->cwiseAbs().maxCoeff());
  return largest > 0 ? 100 - std::ilogb(largest) : 0;
}

/// Scales by 2^exponent, which may exceed the largest double.
Vec3 scaled(const Vec3& p, int exponent) {
  return {std::ldexp(p.x(), exponent), std::ldexp(p.y(), exponent), std::ldexp(p.z(), exponent)};
}

int orient3d_exact(const Vec3& a0, const Vec3& b0, const Vec3& c0, const Vec3& d0) {
  // Flat along an axis: common in boxes and lattices, and needs no arithmetic.
  for (int k = 0; k < 3; ++k)
    if (a0[k] == b0[k] && a0[k] == c0[k] && a0[k] == d0[k]) return 0;
  const int s = safe_exponent({&a0, &b0, &c0, &d0});
  const Vec3 a = scaled(a0, s), b = scaled(b0, s), c = scaled(c0, s), d = scaled(d0, s);
  const Expansion bx = difference(b.x(), a.x()), by = difference(b.y(), a.y()), bz = difference(b.z(), a.z());
  const Expansion cx = difference(c.x(), a.x()), cy = difference(c.y(), a.y()), cz = difference(c.z(), a.z());
  const Expansion dx = difference(d.x(), a.x()), dy = difference(d.y(), a.y()), dz = difference(d.z(), a.z());
  const Expansion x = product(bx, minus(product(cy, dz), product(cz, dy)));
  const Expansion y = product(by, minus(product(cz, dx), product(cx, dz)));
  const Expansion z = product(bz, minus(product(cx, dy), product(cy, dx)));
  return sign(plus(plus(x, y), z));
}

int orient2d_exact(const Vec3& a0, const Vec3& b0, const Vec3& c0, int u, int v) {
  if ((a0[u] == b0[u] && a0[u] == c0[u]) || (a0[v] == b0[v] && a0[v] == c0[v])) return 0;
  const int s = safe_exponent({&a0, &b0, &c0});
  const Vec3 a = scaled(a0, s), b = scaled(b0, s), c = scaled(c0, s);
  return sign(minus(product(difference(b[u], a[u]), difference(c[v], a[v])),
                    product(difference(b[v], a[v]), difference(c[u], a[u]))));
}

}  // namespace

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double bx = b.x() - a.x(), by = b.y() - a.y(), bz = b.z() - a.z();
  const double cx = c.x() - a.x(), cy = c.y() - a.y(), cz = c.z() - a.z();
  const double dx = d.x() - a.x(), dy = d.y() - a.y(), dz = d.z() - a.z();
  const double cydz = cy * dz, czdy = cz * dy, czdx = cz * dx, cxdz = cx * dz, cxdy = cx * dy, cydx = cy * dx;
  const double det = bx * (cydz - czdy) + by * (czdx - cxdz) + bz * (cxdy - cydx);
  const double permanent = std::fabs(bx) * (std::fabs(cydz) + std::fabs(czdy)) +
                           std::fabs(by) * (std::fabs(czdx) + std::fabs(cxdz)) +
                           std::fabs(bz) * (std::fabs(cxdy) + std::fabs(cydx));
  const double bound = orient3d_bound * permanent;
  // The filter holds only within these limits: below, products may have lost bits to underflow; above, they
  // may have overflowed (infinity or NaN).
  if (permanent > 0x1p-900 && permanent < 0x1p1000) {
    if (det > bound) return 1;
    if (det < -bound) return -1;
  }
  return orient3d_exact(a, b, c, d);
}

int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v) {
  const double left = (b[u] - a[u]) * (c[v] - a[v]);
  const double right = (b[v] - a[v]) * (c[u] - a[u]);
  const double det = left - right;
  const double size = std::fabs(left) + std::fabs(right);
  if (size > 0x1p-900 && size < 0x1p1000) {
    if (det > orient2d_bound * size) return 1;
    if (det < -orient2d_bound * size) return -1;
  }
  return orient2d_exact(a, b, c, u, v);
}

}  // namespace tetwright
