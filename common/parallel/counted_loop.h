// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>

#include "tetwright/loop_times.h"

namespace tetwright {

/// Adds its lifetime to the LoopTimes of the calling thread as that of a loop; loops inside are not counted.
/// Does nothing unless the thread counts (CountLoops).
class CountedLoop {
 public:
  /// Number of parts of work that another library divides among any number of threads.
  static constexpr std::size_t divided_by_library = std::numeric_limits<std::size_t>::max();

  /// \param parts number of parts that different cores can do, at least 1. A loop of one part is not counted,
  ///   but loops inside are.
  explicit CountedLoop(std::size_t parts);
  ~CountedLoop();
  CountedLoop(const CountedLoop&) = delete;
  CountedLoop& operator=(const CountedLoop&) = delete;

 private:
  CountLoops* count_;  ///< null: not counted
  std::size_t parts_;
  double start_ = 0;  ///< processor time of the thread, seconds
};

}  // namespace tetwright
