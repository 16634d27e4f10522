// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tetwright {

/// Elementary functions computed with only + - * / and sqrt, so that they give the same bits on every machine
/// and with every compiler (results of libm differ in the last digit). Relative error below 4e-15 on the
/// stated ranges.

/// Arc tangent of any finite value or infinity, radians.
double portable_atan(double x);
/// Arc tangent of y / x for y >= 0 and any x, in [0, pi]; 0 for (0, 0).
double portable_atan2_upper(double y, double x);
/// Cube root of any finite value.
double portable_cbrt(double x);
/// 1 / cbrt(x) of a finite normal x > 0, in a fifth of the time of the cube root.
double portable_inverse_cbrt(double x);
/// Natural logarithm of a finite normal x > 0.
double portable_log(double x);
/// Cosine and sine of a finite angle in degrees, exact for multiples of 90.
struct CosineSine {
  double cosine, sine;
};
CosineSine portable_cosine_sine(double degrees);

}  // namespace tetwright
