// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/expected_time.h"

#include <algorithm>
#include <cmath>

#include "common/message_text.h"

namespace tetwright {

namespace {

/// CPU time with one thread, seconds: meshing and simplification of a dense tet, the last iterations and
/// improvement for a wanted tet, and reading, smoothing and thickness of a voxel. Fitted to seven volumes
/// with 0.5 to 23 million dense tets, on which the sum is within a factor of 0.6 to 1.7.
constexpr double per_dense_tet = 8e-6, per_target_tet = 45e-6, per_voxel = 0.15e-6;
/// Fraction of the time that more threads do not shorten: a volume of 41 labels took 44 s with one thread, 17
/// with four and 12 with sixteen.
constexpr double serial_share = 0.2;

/// Rounds to two significant digits.
double rounded(double value) {
  if (!(value > 0)) return 0;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::round(value / unit) * unit;
}

std::string duration_text(double seconds) {
  constexpr double minute = 60, hour = 3600;
  if (seconds < 2 * minute) return short_number(rounded(std::max(seconds, 1.0))) + " s";
  if (seconds < 2 * hour) return short_number(rounded(seconds / minute)) + " minutes";
  return short_number(rounded(seconds / hour)) + " hours";
}

std::string count_text(double count) {
  constexpr double million = 1e6;
  return count < million ? short_number(rounded(count)) : short_number(rounded(count / million)) + " million";
}

}  // namespace

double expected_seconds(const ExpectedWork& work, unsigned threads) {
  return (per_dense_tet * work.dense_tets + per_target_tet * work.target_tets + per_voxel * work.voxels) *
         (serial_share + (1 - serial_share) / threads);
}

std::string expected_time_line(const ExpectedWork& work, unsigned threads) {
  return "about " + count_text(work.dense_tets) + " dense tets, which take about " +
         duration_text(expected_seconds(work, threads)) + " with " + std::to_string(threads) +
         (threads == 1 ? " thread" : " threads");
}

}  // namespace tetwright
