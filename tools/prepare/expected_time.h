// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tetwright {

/// Sizes from which the time follows.
struct ExpectedWork {
  double dense_tets = 0;   ///< predicted
  double target_tets = 0;  ///< 0: unknown
  double voxels = 0;       ///< of the volume
};

/// Predicted time from the segmented volume to the simulation mesh, seconds: within a factor of two on the
/// volumes of benchmarks/README.md, on processors like those of its measurements.
///
/// \param threads number of threads that run at the same time, at least 1
double expected_seconds(const ExpectedWork& work, unsigned threads);

/// Tells the user before the work begins what it will take: dense tets, time and threads.
std::string expected_time_line(const ExpectedWork& work, unsigned threads);

}  // namespace tetwright
