// SPDX-License-Identifier: Apache-2.0
#include "common/portable_math.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace tetwright {

namespace {

constexpr double pi = std::numbers::pi;

/// Series of atan for |x| <= tan(pi/16): after 13 terms the error is below 0.2^27 / 27 < 1e-19.
double atan_small(double x) {
  const double s = x * x;
  double sum = 0;
  for (int k = 12; k >= 0; --k) sum = 1.0 / (2 * k + 1) - s * sum;
  return x * sum;
}

/// x = mantissa * 2^exponent with mantissa in [1, 2), x normal and > 0.
struct Parts {
  double mantissa;
  int exponent;
};
Parts split(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const auto mantissa = (bits & 0x000fffffffffffffu) | 0x3ff0000000000000u;
  return {std::bit_cast<double>(mantissa), static_cast<int>(bits >> 52) - 1023};
}

}  // namespace

double portable_atan(double x) {
  const double a = std::fabs(x);
  double r;
  // Argument reduction: atan(a) = pi/2 - atan(1/a), then atan(a) = c + atan((a - t) / (1 + a t)) with t =
  // tan(c).
  constexpr double tan_eighth = 0.41421356237309503;     // tan(pi/8)
  constexpr double tan_sixteenth = 0.19891236737965800;  // tan(pi/16)
  const bool inverted = a > 1;
  const double b = inverted ? 1 / a : a;
  if (b <= tan_sixteenth) {
    r = atan_small(b);
  } else if (b <= 0.66817863791929891) {  // tan(3 pi/16)
    r = pi / 8 + atan_small((b - tan_eighth) / (1 + b * tan_eighth));
  } else {
    r = pi / 4 + atan_small((b - 1) / (1 + b));
  }
  if (inverted) r = pi / 2 - r;
  return x < 0 ? -r : r;
}

double portable_atan2_upper(double y, double x) {
  if (y == 0) return x < 0 ? pi : 0;
  if (x == 0) return pi / 2;
  const double r = portable_atan(y / x);
  return x < 0 ? r + pi : r;
}

double portable_cbrt(double x) {
  if (x == 0) return x;
  double a = std::fabs(x);
  double scale = 1;
  if (a < 0x1p-1000) {  // a subnormal's exponent field is 0
    a *= 0x1p300;
    scale = 0x1p-100;
  }
  const Parts p = split(a);
  // exponent = 3 q + r with r in 0..2. Compute the cube root of mantissa * 2^r, which is in [1, 2), by
  // Newton's method from a linear guess.
  const int q = (p.exponent + 1200) / 3 - 400;
  const int r = p.exponent - 3 * q;
  const double m = p.mantissa * static_cast<double>(1 << r);  // [1, 8)
  double y = 1 + (m - 1) * (1.0 / 7) + (m < 3 ? 0.1 : 0.15);
  for (int i = 0; i < 5; ++i) y -= (y - m / (y * y)) * (1.0 / 3);
  return std::copysign(std::ldexp(y, q) * scale, x);
}

double portable_inverse_cbrt(double x) {
  const Parts p = split(x);
  const int q = (p.exponent + 1200) / 3 - 400, r = p.exponent - 3 * q;      // exponent = 3 q + r, r in 0..2
  constexpr double roots[3] = {1, 0.7937005259840998, 0.6299605249474366};  // 2^(-r/3)
  // A quadratic guess, within 0.0021, and steps of Newton's method without a division, which leave twice the
  // square of the error.
  const double m = p.mantissa;
  double y = 1.38350592 + m * (-0.47684206 + m * 0.09126117);
  for (int i = 0; i < 3; ++i) y += y * (1 - m * y * y * y) * (1.0 / 3);
  return y * roots[r] * std::bit_cast<double>(static_cast<std::uint64_t>(1023 - q) << 52);
}

double portable_log(double x) {
  Parts p = split(x);
  if (p.mantissa > std::numbers::sqrt2) {
    p.mantissa *= 0.5;
    ++p.exponent;
  }
  // log(m) = 2 atanh(s), s = (m - 1) / (m + 1), |s| <= 0.172: after 12 terms the error is below 1e-18.
  const double s = (p.mantissa - 1) / (p.mantissa + 1);
  const double s2 = s * s;
  double sum = 0;
  for (int k = 11; k >= 0; --k) sum = 1.0 / (2 * k + 1) + s2 * sum;
  return 2 * s * sum + p.exponent * std::numbers::ln2;
}

CosineSine portable_cosine_sine(double degrees) {
  int quarters = 0;
  const double rest = std::remquo(degrees, 90.0, &quarters);  // exact, at most 45
  // Taylor series for |x| <= pi/4: the first terms left out are below 3e-18 and 1e-19.
  const double x = rest * (pi / 180), s = x * x;
  double cosine = 0, sine = 0;
  for (int k = 8; k >= 1; --k) {
    cosine = (1 - cosine) * s / ((2 * k - 1) * (2 * k));
    sine = (1 - sine) * s / ((2 * k) * (2 * k + 1));
  }
  cosine = 1 - cosine;
  sine = x * (1 - sine);
  switch (static_cast<unsigned>(quarters) % 4) {
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    case 3:
      return {sine, -cosine};
    default:
      return {cosine, sine};
  }
}

}  // namespace tetwright
