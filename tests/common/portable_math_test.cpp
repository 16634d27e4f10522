// SPDX-License-Identifier: Apache-2.0
#include "common/portable_math.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/random.h"

namespace tetwright::portable_math_test {
namespace {

/// A value of random sign, with an exponent between `low` and `high`.
double spread(Random& random, int low, int high) {
  const double mantissa = 1 + random.uniform();
  const int exponent = low + static_cast<int>(random.below(static_cast<std::uint32_t>(high - low)));
  return std::ldexp(random.below(2) ? mantissa : -mantissa, exponent);
}

TEST(PortableMath, AtanAgreesWithLibm) {
  Random random(1);
  for (int i = 0; i < 100000; ++i) {
    const double x = spread(random, -40, 40);
    EXPECT_NEAR(portable_atan(x), std::atan(x), 4e-15 * std::fabs(std::atan(x))) << x;
  }
  EXPECT_EQ(portable_atan(0), 0);
  EXPECT_DOUBLE_EQ(portable_atan(std::numeric_limits<double>::infinity()), std::atan(1.0) * 2);
}

TEST(PortableMath, Atan2CoversTheUpperHalfPlane) {
  Random random(2);
  for (int i = 0; i < 10000; ++i) {
    const double y = std::fabs(spread(random, -20, 20)), x = spread(random, -20, 20);
    EXPECT_NEAR(portable_atan2_upper(y, x), std::atan2(y, x), 4e-15 * std::atan2(y, x));
  }
  EXPECT_DOUBLE_EQ(portable_atan2_upper(0, -1), std::acos(-1.0));
  EXPECT_DOUBLE_EQ(portable_atan2_upper(1, 0), std::acos(0.0));
  EXPECT_EQ(portable_atan2_upper(0, 1), 0);
}

TEST(PortableMath, CbrtAgreesWithLibm) {
  Random random(3);
  for (int i = 0; i < 100000; ++i) {
    const double x = spread(random, -1022, 1023);
    EXPECT_NEAR(portable_cbrt(x), std::cbrt(x), 4e-15 * std::fabs(std::cbrt(x))) << x;
  }
  EXPECT_EQ(portable_cbrt(0), 0);
  EXPECT_EQ(portable_cbrt(27), 3);
  const double tiny = 1e-320;
  EXPECT_NEAR(portable_cbrt(tiny), std::cbrt(tiny), 1e-14 * std::cbrt(tiny));
}

TEST(PortableMath, InverseCbrtAgreesWithLibm) {
  Random random(5);
  for (int i = 0; i < 100000; ++i) {
    const double x = std::fabs(spread(random, -1022, 1023));
    EXPECT_NEAR(portable_inverse_cbrt(x), 1 / std::cbrt(x), 4e-15 / std::cbrt(x)) << x;
  }
  EXPECT_EQ(portable_inverse_cbrt(1), 1);
  EXPECT_DOUBLE_EQ(portable_inverse_cbrt(8), 0.5);
}

TEST(PortableMath, LogAgreesWithLibm) {
  Random random(4);
  for (int i = 0; i < 100000; ++i) {
    const double x = std::fabs(spread(random, -1000, 1000));
    EXPECT_NEAR(portable_log(x), std::log(x), 4e-15 * std::fabs(std::log(x)) + 1e-16) << x;
  }
  EXPECT_EQ(portable_log(1), 0);
}

TEST(PortableMath, CosineAndSineAgreeWithLibm) {
  Random random(6);
  for (int i = 0; i < 100000; ++i) {
    const double degrees = spread(random, -30, 9);
    const auto [cosine, sine] = portable_cosine_sine(degrees);
    const double radians = std::remainder(degrees, 360) * std::numbers::pi / 180;
    EXPECT_NEAR(cosine, std::cos(radians), 4e-15) << degrees;
    EXPECT_NEAR(sine, std::sin(radians), 4e-15) << degrees;
  }
  for (const auto& [degrees, cosine, sine] : {std::array{0.0, 1.0, 0.0},
                                              {90, 0, 1},
                                              {180, -1, 0},
                                              {270, 0, -1},
                                              {-90, 0, -1},
                                              {360, 1, 0},
                                              {-630, 0, 1}}) {
    EXPECT_EQ(portable_cosine_sine(degrees).cosine, cosine) << degrees;
    EXPECT_EQ(portable_cosine_sine(degrees).sine, sine) << degrees;
  }
}

}  // namespace
}  // namespace tetwright::portable_math_test
